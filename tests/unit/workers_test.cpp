/* Loops complete with any number of helpers, and what they compute does not depend on it. */
#include <atomic>
#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

#include "cpu/workers.h"
#include "support/hooks.h"

namespace loam {
namespace {

/* Many loops of many sizes in one session; every chunk must run exactly once. */
void expect_every_chunk_once(Workers &workers, int loops) {
  workers.session([&] {
    for (int loop = 0; loop < loops; ++loop) {
      const int chunks = loop % 37;
      std::vector<std::atomic<int>> runs(std::size_t(chunks) + 1);
      workers.loop(chunks, [&](int chunk) { ++runs[std::size_t(chunk)]; });
      for (int chunk = 0; chunk < chunks; ++chunk) ASSERT_EQ(runs[std::size_t(chunk)].load(), 1) << loop;
      ASSERT_EQ(runs[std::size_t(chunks)].load(), 0);
    }
  });
}

TEST(Workers, LoopsCompleteWithTheInternalThreads) {
  for (const unsigned threads : {1u, 2u, 5u, 16u}) {
    Workers workers(threads, {});
    EXPECT_EQ(workers.thread_count(), threads);
    expect_every_chunk_once(workers, 2000);
  }
  EXPECT_GE(Workers(0, {}).thread_count(), 1u);
}

TEST(Workers, LoopsCompleteOnSixteenThreadsOfTheHost) {
  hooks::ThreadJobs jobs;
  Workers workers(16, jobs.hooks());
  for (int session = 0; session < 5; ++session) expect_every_chunk_once(workers, 500);
  EXPECT_EQ(jobs.enqueued, 75u);
  EXPECT_EQ(jobs.finished, 75u);
}

TEST(Workers, LoopsCompleteWithoutAnyHelp) {
  hooks::LateJobs late;
  Workers alone(16, late.hooks());
  expect_every_chunk_once(alone, 500);
  EXPECT_EQ(late.finished, 15u);
}

TEST(Workers, ATaskRunAtOnceReturnsAtOnce) {
  hooks::InlineJobs at_once;
  Workers workers(3, at_once.hooks());
  expect_every_chunk_once(workers, 500);
  EXPECT_EQ(at_once.finished, 2u);
}

TEST(Workers, ManyChunks) {
  Workers workers(4, {});
  std::atomic<std::int64_t> sum{0};
  workers.session([&] { workers.loop(200000, [&](int chunk) { sum += chunk; }); });
  EXPECT_EQ(sum.load(), 199999LL * 200000 / 2);
}

TEST(Workers, LoopsOutsideASessionRunOnTheCaller) {
  Workers workers(8, {});
  const auto caller = std::this_thread::get_id();
  int runs = 0;
  workers.loop(100, [&](int) { runs += std::this_thread::get_id() == caller ? 1 : 1000; });
  EXPECT_EQ(runs, 100);
}

TEST(Workers, ExceptionsOfTheBodyPassAndTheWorkersStayUsable) {
  hooks::ThreadJobs threads;
  hooks::LateJobs late;
  for (const loam_job_system &jobs : {loam_job_system{}, threads.hooks(), late.hooks()}) {
    for (const unsigned count : {1u, 4u}) {
      Workers workers(count, jobs);
      const auto fail = [&] {
        workers.session([&] {
          workers.loop(10, [](int) {});
          throw std::runtime_error("from the body");
        });
      };
      EXPECT_THROW(fail(), std::runtime_error);
      expect_every_chunk_once(workers, 50);
    }
  }
  EXPECT_EQ(threads.enqueued, threads.finished);
  EXPECT_EQ(late.enqueued, late.finished);
}

} // namespace
} // namespace loam
