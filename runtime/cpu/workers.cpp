#include "cpu/workers.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <vector>

#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace loam {

namespace {

constexpr int chunk_bits = 20;
constexpr std::uint64_t chunk_mask = (std::uint64_t(1) << chunk_bits) - 1;

std::uint64_t make_word(std::uint64_t generation, std::uint64_t chunks, std::uint64_t next) {
  return (generation << (2 * chunk_bits)) | (chunks << chunk_bits) | next;
}
std::uint64_t generation_of(std::uint64_t word) { return word >> (2 * chunk_bits); }
std::uint64_t chunks_of(std::uint64_t word) { return (word >> chunk_bits) & chunk_mask; }
std::uint64_t next_of(std::uint64_t word) { return word & chunk_mask; }

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

// About 20 microseconds: longer than the serial gaps between two loops of a substep, short enough not to starve a busy machine.
constexpr int spins_before_blocking = 500;

} // namespace

thread_local unsigned Workers::current_ = 0;

Workers::Workers(unsigned thread_count, const loam_job_system &job_system)
    : thread_count_(thread_count), job_system_(job_system) {
  if (thread_count_ == 0) thread_count_ = std::thread::hardware_concurrency();
  if (thread_count_ == 0) thread_count_ = 1;
}

// Takes one chunk of the loop in `seen` and runs it; false if the loop is over. The function and its data are read before the chunk is ours; the
// compare-and-swap succeeds only if the loop was still the same, for a new one is not published before all chunks taken are done.
bool Workers::take_chunk(std::uint64_t seen) {
  while (true) {
    if (next_of(seen) >= chunks_of(seen)) return false;
    const ChunkFunction function = function_.load(std::memory_order_relaxed);
    void *const data = data_.load(std::memory_order_relaxed);
    const std::uint64_t generation = generation_of(seen);
    if (word_.compare_exchange_weak(seen, seen + 1, std::memory_order_acq_rel, std::memory_order_acquire)) {
      function(data, static_cast<int>(next_of(seen)));
      done_.fetch_add(1, std::memory_order_release);
      return true;
    }
    if (generation_of(seen) != generation) return true; // a new loop: look again
  }
}

void Workers::help() {
  // A job system may run the task at once, on the thread that asks for help: that thread has the loops to publish.
  if (std::this_thread::get_id() == caller_.load(std::memory_order_relaxed)) return;
  current_ = joined_.fetch_add(1, std::memory_order_relaxed);
  while (open_.load(std::memory_order_acquire)) {
    const std::uint64_t seen = word_.load(std::memory_order_acquire);
    if (take_chunk(seen)) continue;
    bool changed = false;
    for (int i = 0; i < spins_before_blocking && !changed; ++i) {
      pause();
      const std::uint64_t now = word_.load(std::memory_order_relaxed);
      changed = generation_of(now) != generation_of(seen);
    }
    if (!changed) {
      // The word may have moved on by chunks only; then wait() returns at once and the loop looks again.
      const std::uint64_t now = word_.load(std::memory_order_acquire);
      if (generation_of(now) == generation_of(seen) && open_.load(std::memory_order_acquire)) word_.wait(now);
    }
  }
}

void Workers::run_loop(int chunks, ChunkFunction function, void *data) {
  if (chunks <= 0) return;
  if (chunks == 1 || thread_count_ == 1 || !open_.load(std::memory_order_relaxed)) {
    for (int i = 0; i < chunks; ++i) function(data, i);
    return;
  }
  function_.store(function, std::memory_order_relaxed);
  data_.store(data, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t generation = generation_of(word_.load(std::memory_order_relaxed)) + 1;
  word_.store(make_word(generation, static_cast<std::uint64_t>(chunks), 0), std::memory_order_release);
  word_.notify_all();
  while (take_chunk(word_.load(std::memory_order_acquire))) {
  }
  for (int spins = 0; done_.load(std::memory_order_acquire) != chunks;) {
    if (++spins < 4 * spins_before_blocking)
      pause();
    else
      std::this_thread::yield();
  }
}

void Workers::run_session(void (*body)(void *), void *data) {
  current_ = 0;
  joined_.store(1, std::memory_order_relaxed);
  if (thread_count_ == 1) {
    body(data);
    return;
  }
  caller_.store(std::this_thread::get_id(), std::memory_order_relaxed);
  open_.store(true, std::memory_order_release);
  std::exception_ptr failure;
  const auto run_body = [&] {
    try {
      body(data);
    } catch (...) {
      failure = std::current_exception();
    }
    // A new generation without chunks lets blocked helpers see that the session is over.
    open_.store(false, std::memory_order_release);
    const std::uint64_t generation = generation_of(word_.load(std::memory_order_relaxed)) + 1;
    word_.store(make_word(generation, 0, 0), std::memory_order_release);
    word_.notify_all();
  };
  if (job_system_.enqueue != nullptr) {
    std::vector<void *> tokens(thread_count_ - 1);
    for (void *&token : tokens)
      token = job_system_.enqueue(
          job_system_.user, [](void *self) { static_cast<Workers *>(self)->help(); }, this);
    run_body();
    for (void *token : tokens) job_system_.finish(job_system_.user, token);
  } else {
    // oneTBB has no more threads than the machine, and asked for more it prints a warning.
    const int threads = std::min(static_cast<int>(thread_count_), tbb::info::default_concurrency());
    tbb::task_arena arena(threads);
    arena.execute([&] {
      tbb::task_group helpers;
      for (int i = 1; i < threads; ++i) helpers.run([this] { help(); });
      run_body();
      helpers.wait();
    });
  }
  if (failure) std::rethrow_exception(failure);
}

} // namespace loam
