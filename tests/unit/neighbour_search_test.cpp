/* The neighbour lists against all pairs, for every instruction set that this machine has: as they are after they were interleaved. */
#include <algorithm>
#include <gtest/gtest.h>
#include <loam/world.h>
#include <map>
#include <set>

#include "cpu/kernel_table.h"
#include "kernels/inelastic/record.h"
#include "sorted_particles.h"

namespace loam {
namespace {

using test::r;
using test::SortedParticles;

struct Lists {
  std::vector<std::vector<int>> all, close; // of each particle
};

/* `close` below 1.5 r; where they are shared in both lists. */
Lists find_lists(SortedParticles &particles, const KernelTable &kernels, bool shared) {
  const HostAllocator allocator;
  Workers workers(1, {});
  VisitOrder order(allocator, kernels.width, 1);
  order.reserve(particles.x.size(), 1, Record::field_count);
  const CandidateTest test = {4 * r * r, 2.25f * r * r, shared};
  const CellTable &table = particles.table;
  const FindNeighbours stage = {test, particles.neighbour_counts.data(), particles.close_counts.data()};
  test::make_all_lists(
      order, workers, table,
      [&](const int *ids, int count, FoundLists &lists) {
        const CpuCandidates views = {table.x,      table.y,
                                     table.z,      table.keys,
                                     table.starts, {table.grid.size[0], table.grid.size[1], table.grid.size[2]},
                                     &lists,       order.list_starts()};
        kernels.search(stage, views, ids, count);
      },
      kernels.interleave);
  EXPECT_TRUE(order.lists_are_complete());

  Lists lists;
  lists.all.resize(particles.x.size());
  lists.close.resize(particles.x.size());
  const CpuPairs pairs = order.pairs(nullptr);
  for (int batch = 0; batch < order.batch_count(); ++batch)
    for (int lane = 0; lane < kernels.width; ++lane) {
      const int id = pairs.ids[batch * kernels.width + lane];
      const bool active = lane < pairs.active[batch];
      for (int step = 0; step < pairs.steps[batch]; ++step) {
        const int j = pairs.indices[(pairs.offsets[batch] + step) * kernels.width + lane];
        if (!active || step >= particles.neighbour_counts[std::size_t(id)]) {
          EXPECT_EQ(j, id); // behind the end
          continue;
        }
        lists.all[std::size_t(id)].push_back(j);
        if (step < particles.close_counts[std::size_t(id)]) {
          EXPECT_LT(step, pairs.close_steps[batch]);
          lists.close[std::size_t(id)].push_back(j);
        }
      }
    }
  return lists;
}

void expect_right(SortedParticles &particles) {
  const auto expected = particles.neighbours;
  const auto near = [&](std::size_t i, std::size_t j) {
    const float dx = particles.x[j] - particles.x[i], dy = particles.y[j] - particles.y[i],
                dz = particles.z[j] - particles.z[i];
    return dx * dx + (dy * dy + dz * dz) < 2.25f * r * r;
  };
  Lists first;
  for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set)
    for (const bool shared : {false, true}) {
      const KernelTable *kernels = kernel_table(set);
      if (kernels == nullptr) continue;
      SCOPED_TRACE(set);
      const Lists lists = find_lists(particles, *kernels, shared);
      std::size_t close = 0, owned = 0;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        std::vector<int> sorted = lists.all[i];
        std::sort(sorted.begin(), sorted.end());
        ASSERT_EQ(sorted, expected[i]) << i;
        for (const int j : lists.close[i]) EXPECT_TRUE(near(i, std::size_t(j)));
        owned += lists.close[i].size();
        for (const int j : expected[i]) close += near(i, std::size_t(j)) ? 1 : 0;
        if (!shared)
          for (const int j : lists.close[i]) {
            const std::vector<int> &of_other = lists.close[std::size_t(j)];
            EXPECT_EQ(std::count(of_other.begin(), of_other.end(), int(i)), 0); // a pair has one owner
          }
      }
      EXPECT_EQ(owned, shared ? close : close / 2);
      // The order too is every machine's.
      if (shared) continue;
      if (first.all.empty()) first = lists;
      EXPECT_EQ(lists.all, first.all);
    }
}

TEST(NeighbourSearch, FindsWhatAllPairsFind) {
  SortedParticles particles(1500, {1, 3}, 1, 0.2f);
  expect_right(particles);
}

// Lists of over a thousand, which no buffer holds.
TEST(NeighbourSearch, FindsAllInACrowd) {
  SortedParticles particles(1200, {1, 3}, 1, 0.015f);
  ASSERT_GT(*std::max_element(particles.neighbour_counts.begin(), particles.neighbour_counts.end()), 900);
  expect_right(particles);
}

} // namespace
} // namespace loam
