// Threads of the CPU backend: a session of workers that share out loops.
//
// A step opens a session: helpers are asked for, from oneTBB or from the host's job system, and stay with the step until it ends. Inside it a loop
// is one atomic word that the helpers watch:
//
//     generation (24 bits) | chunks of the loop (20 bits) | next chunk to take (20 bits)
//
// The caller publishes a loop by a new generation, everybody takes chunks by compare-and-swap until none is left, and the caller waits for the chunks
// that others have taken. So a loop costs a fraction of a microsecond, it completes with any number of helpers, none included, and nobody ever waits
// for a helper that has not come. Between loops helpers spin briefly, then block.
//
// Which thread runs a chunk is open; kernels write results that do not depend on it.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <type_traits>

#include <loam/base.h>

namespace loam {

class Workers {
public:
  // `thread_count` 0: as many as the machine has.
  Workers(unsigned thread_count, const loam_job_system &job_system);
  Workers(const Workers &) = delete;
  Workers &operator=(const Workers &) = delete;

  unsigned thread_count() const { return thread_count_; }

  // Runs body() with helpers at hand for the loops inside it. Exceptions of body() pass through.
  template <class Body> void session(Body &&body) {
    run_session([](void *b) { (*static_cast<std::remove_reference_t<Body> *>(b))(); }, &body);
  }

  // function(chunk) for 0 <= chunk < chunks, at most max_chunks. The function must not throw.
  template <class Function> void loop(int chunks, Function &&function) {
    run_loop(
        chunks, [](void *f, int chunk) { (*static_cast<std::remove_reference_t<Function> *>(f))(chunk); }, &function);
  }

  static constexpr int max_chunks = (1 << 20) - 1;

  // Inside a loop: which of the session's threads is running, from 0 to thread_count - 1. For scratch memory, never for results.
  static unsigned current() { return current_; }

private:
  using ChunkFunction = void (*)(void *data, int chunk);
  void run_session(void (*body)(void *), void *data);
  void run_loop(int chunks, ChunkFunction function, void *data);
  void help();
  bool take_chunk(std::uint64_t seen);

  unsigned thread_count_;
  loam_job_system job_system_;

  alignas(64) std::atomic<std::uint64_t> word_{0};
  std::atomic<ChunkFunction> function_{nullptr};
  std::atomic<void *> data_{nullptr};
  std::atomic<bool> open_{false};
  std::atomic<std::thread::id> caller_; // of the session
  alignas(64) std::atomic<int> done_{0};
  std::atomic<unsigned> joined_{1}; // threads of the session so far
  static thread_local unsigned current_;
};

} // namespace loam
