/* Host hooks for tests: an allocator that keeps books and can refuse, job systems of several kinds, a log that remembers. */
#pragma once

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <loam/loam.h>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace loam::hooks {

/* Sanitizers make the scenes ten times slower; the presets that build with them set this. */
inline bool short_run() { return std::getenv("LOAM_TEST_SHORT") != nullptr; }

/* With the thread sanitizer, races are looked for and not bits: a run on one thread for comparison has none, and only costs time. */
#ifdef __SANITIZE_THREAD__
constexpr bool only_races = true;
#else
constexpr bool only_races = false;
#endif

class Allocator {
public:
  loam_allocator hooks() { return {this, &allocate, &release}; }

  /* Refuses the nth request from now on (1: the next), and that one only unless `all_after`. 0: none. */
  void refuse(std::uint64_t nth, bool all_after = false) {
    refuse_at_ = nth == 0 ? 0 : requests + nth;
    all_after_ = all_after;
  }

  std::uint64_t requests = 0, refusals = 0, bytes_in_use = 0, bytes_refused = 0;
  std::vector<std::string> mistakes; // of the library
  std::size_t blocks_in_use() const { return blocks_.size(); }

private:
  struct Block {
    std::size_t size, alignment;
  };
  static void *allocate(void *user, std::size_t size, std::size_t alignment) {
    auto &self = *static_cast<Allocator *>(user);
    ++self.requests;
    if (std::this_thread::get_id() != self.owner_) self.mistakes.push_back("allocation on another thread than the caller's");
    if (alignment == 0 || (alignment & (alignment - 1)) != 0 || alignment > 4096)
      self.mistakes.push_back("alignment of " + std::to_string(alignment));
    const bool hit =
        self.refuse_at_ != 0 && (self.all_after_ ? self.requests >= self.refuse_at_ : self.requests == self.refuse_at_);
    if (hit) {
      ++self.refusals;
      self.bytes_refused = size;
      return nullptr;
    }
    void *memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    std::memset(memory, 0xCD, size); // what is read before it is written shows
    self.blocks_[memory] = {size, alignment};
    self.bytes_in_use += size;
    return memory;
  }
  static void release(void *user, void *memory, std::size_t size, std::size_t alignment) {
    auto &self = *static_cast<Allocator *>(user);
    if (std::this_thread::get_id() != self.owner_) self.mistakes.push_back("release on another thread than the caller's");
    const auto block = self.blocks_.find(memory);
    if (block == self.blocks_.end()) {
      self.mistakes.push_back("release of memory that is not in use");
      return;
    }
    if (block->second.size != size || block->second.alignment != alignment)
      self.mistakes.push_back("release of " + std::to_string(size) + " bytes, allocated " +
                              std::to_string(block->second.size));
    self.bytes_in_use -= block->second.size;
    self.blocks_.erase(block);
    std::free(memory);
  }

  std::thread::id owner_ = std::this_thread::get_id();
  std::map<void *, Block> blocks_;
  std::uint64_t refuse_at_ = 0;
  bool all_after_ = false;
};

/* Job systems. Each counts its tasks; all of them must have been finished in the end. */
struct JobSystem {
  std::uint64_t enqueued = 0, finished = 0;
};

/* A thread of its own for each task. */
struct ThreadJobs : JobSystem {
  loam_job_system hooks() {
    return {this,
            [](void *user, void (*task)(void *), void *argument) -> void * {
              ++static_cast<ThreadJobs *>(user)->enqueued;
              return new std::thread(task, argument);
            },
            [](void *user, void *token) {
              ++static_cast<ThreadJobs *>(user)->finished;
              auto *thread = static_cast<std::thread *>(token);
              thread->join();
              delete thread;
            }};
  }
};

/* Runs nothing before it is waited for, and then on the waiting thread. */
struct LateJobs : JobSystem {
  struct Job {
    void (*task)(void *);
    void *argument;
  };
  loam_job_system hooks() {
    return {this,
            [](void *user, void (*task)(void *), void *argument) -> void * {
              ++static_cast<LateJobs *>(user)->enqueued;
              return new Job{task, argument};
            },
            [](void *user, void *token) {
              ++static_cast<LateJobs *>(user)->finished;
              auto *job = static_cast<Job *>(token);
              job->task(job->argument);
              delete job;
            }};
  }
};

/* Runs every task at once, on the thread that asks for it. */
struct InlineJobs : JobSystem {
  loam_job_system hooks() {
    return {this,
            [](void *user, void (*task)(void *), void *argument) -> void * {
              ++static_cast<InlineJobs *>(user)->enqueued;
              task(argument);
              return nullptr;
            },
            [](void *user, void *) { ++static_cast<InlineJobs *>(user)->finished; }};
  }
};

struct Log {
  struct Line {
    std::int32_t level;
    std::string text;
  };
  std::vector<Line> lines;
  loam_log hooks() {
    return {this, [](void *user, std::int32_t level, const char *text) {
              static_cast<Log *>(user)->lines.push_back({level, text});
            }};
  }
};

} // namespace loam::hooks
