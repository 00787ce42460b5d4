// The thread of a world's asynchronous steps: it comes with the first of them, and works on one at a time.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace loam {

class StepThread {
public:
  explicit StepThread(std::function<void(float seconds)> step);
  StepThread(const StepThread &) = delete;
  StepThread &operator=(const StepThread &) = delete;
  ~StepThread(); // when the step at hand is over

  // Once the one before was waited for.
  void begin(float seconds);
  bool is_running() const;
  // Throws what the step threw.
  void wait();

private:
  enum class State { idle, running, leaving };
  void run();

  const std::function<void(float)> step_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  State state_ = State::idle;
  float seconds_ = 0;
  std::exception_ptr failure_;
  std::thread thread_;
};

} // namespace loam
