/* The host's job system: whatever it does with the tasks, the result is the same. And two worlds on two threads at once. */
#include <thread>

#include "small_world.h"
#include "support/hooks.h"

namespace loam {
namespace {

using test::hash_after_steps;

TEST(JobSystem, AnyKindGivesTheSameResult) {
  const std::uint64_t expected = hash_after_steps({}, 1);
  hooks::ThreadJobs threads;
  EXPECT_EQ(hash_after_steps(threads.hooks(), 3), expected);
  EXPECT_GT(threads.enqueued, 0u);
  EXPECT_EQ(threads.enqueued, threads.finished);

  hooks::LateJobs late;
  EXPECT_EQ(hash_after_steps(late.hooks(), 5), expected);
  EXPECT_GT(late.enqueued, 0u);
  EXPECT_EQ(late.enqueued, late.finished);
}

TEST(JobSystem, TasksMayRunAtOnceOnTheCallersThread) {
  hooks::InlineJobs at_once;
  EXPECT_EQ(hash_after_steps(at_once.hooks(), 4), hash_after_steps({}, 1));
  EXPECT_GT(at_once.enqueued, 0u);
  EXPECT_EQ(at_once.enqueued, at_once.finished);
}

TEST(JobSystem, AStepAsksForOneTaskLessThanItHasThreads) {
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 100);
  for (const std::uint32_t threads : {1u, 2u, 7u}) {
    hooks::LateJobs jobs;
    loam_world_def def = scenes::world_def(scene);
    def.thread_count = threads;
    def.job_system = jobs.hooks();
    scenes::World world(def, scene);
    const std::uint64_t before = jobs.enqueued;
    world.step(0.01f);
    EXPECT_LE(jobs.enqueued - before, threads - 1);
    EXPECT_EQ(jobs.enqueued, jobs.finished);
  }
}

TEST(TwoWorlds, RunOnTwoThreadsAtOnce) {
  const std::uint64_t expected = hash_after_steps({}, 2);
  std::uint64_t found[2] = {};
  std::string error[2];
  const auto work = [&](int k) {
    for (int round = 0; round < 2; ++round) {
      found[k] = hash_after_steps({}, 2);
      loam_world_step(nullptr, float(k));
      error[k] = loam_last_error();
    }
  };
  std::thread other(work, 0);
  work(1);
  other.join();
  EXPECT_EQ(found[0], expected);
  EXPECT_EQ(found[1], expected);
  EXPECT_EQ(error[0], error[1]);
}

} // namespace
} // namespace loam
