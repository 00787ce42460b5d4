#include "scene/step_thread.h"

#include <utility>

namespace loam {

StepThread::StepThread(std::function<void(float)> step) : step_(std::move(step)), thread_([this] { run(); }) {}

StepThread::~StepThread() {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return state_ == State::idle; });
    state_ = State::leaving;
  }
  changed_.notify_all();
  thread_.join();
}

void StepThread::begin(float seconds) {
  {
    const std::lock_guard lock(mutex_);
    seconds_ = seconds;
    state_ = State::running;
  }
  changed_.notify_all();
}

bool StepThread::is_running() const {
  const std::lock_guard lock(mutex_);
  return state_ == State::running;
}

void StepThread::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return state_ == State::idle; });
  if (std::exception_ptr failure = std::exchange(failure_, nullptr)) std::rethrow_exception(std::move(failure));
}

void StepThread::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return state_ != State::idle; });
    if (state_ == State::leaving) return;
    const float seconds = seconds_;
    lock.unlock();
    std::exception_ptr failure;
    try {
      step_(seconds);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = std::move(failure);
    state_ = State::idle;
    changed_.notify_all();
  }
}

} // namespace loam
