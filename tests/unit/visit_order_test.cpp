/* The order of the visits: every particle once, and no two that run at once write the same particle. */
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>
#include <vector>

#include "cpu/visit_order.h"
#include "kernels/inelastic/record.h"
#include "sorted_particles.h"

namespace loam {
namespace {

using test::r;
using test::SortedParticles;

/* With counts alone: the lists themselves do not matter to the order. */
void arrange(VisitOrder &order, Workers &workers, const SortedParticles &particles) {
  const auto find = [&](const int *list, int count, FoundLists &lists) {
    for (int k = 0; k < count; ++k) {
      const int length = particles.neighbour_counts[std::size_t(list[k])];
      lists.needed += length;
      if (lists.used + length <= lists.capacity) lists.used += length;
    }
  };
  test::make_all_lists(order, workers, particles.table, find, [](const CpuInterleaving &, int, int) {});
  EXPECT_TRUE(order.lists_are_complete());
}

/* Which lane of which group visits each particle. */
struct Visits {
  int material = -1, pass = -1, group = -1, lane = -1, times = 0;
};

std::vector<Visits> visits_of(const SortedParticles &particles, VisitOrder &order, int width) {
  std::vector<Visits> visits(particles.x.size());
  std::vector<Row> velocities(particles.x.size() + 10000);
  const CpuPairs pairs = order.pairs(velocities.data());
  for (std::size_t p = 0; p < order.passes().size(); ++p) {
    const VisitOrder::Pass &pass = order.passes()[p];
    for (int group = pass.first_group; group < pass.last_group; ++group)
      for (int batch = order.group_begin(group); batch < order.group_begin(group + 1); ++batch)
        for (int lane = 0; lane < pairs.active[batch]; ++lane) {
          Visits &visit = visits[std::size_t(pairs.ids[batch * width + lane])];
          visit = {pass.material, int(p), group, lane, visit.times + 1};
        }
  }
  return visits;
}

class VisitOrderOf : public testing::TestWithParam<std::tuple<int, int, int>> {};

TEST_P(VisitOrderOf, VisitsEachOnceAndNeverTwoThatShareAParticle) {
  const auto [block_width, materials, width] = GetParam();
  const Colouring colouring = {block_width, block_width == 1 ? 3 : 2};
  const SortedParticles particles(1500, colouring, materials, 0.2f);
  const HostAllocator allocator;
  Workers workers(2, {});
  VisitOrder order(allocator, width, workers.thread_count());
  order.reserve(particles.x.size(), materials, Record::field_count);
  arrange(order, workers, particles);

  const std::vector<Visits> visits = visits_of(particles, order, width);
  for (std::size_t i = 0; i < visits.size(); ++i) {
    EXPECT_EQ(visits[i].times, 1) << i;
    EXPECT_EQ(visits[i].material, materials == 1 ? 0 : int(particles.materials[i])) << i;
  }
  // Lanes in use are the first ones of a batch: none is counted that idles.
  std::int64_t active = 0;
  for (int batch = 0; batch < order.batch_count(); ++batch) active += order.pairs(nullptr).active[batch];
  EXPECT_EQ(active, std::int64_t(visits.size()));
  // Room for every list, and for each its own.
  const CpuPairs pairs = order.pairs(nullptr);
  std::map<int, int> ends; // by where they begin
  for (int batch = 0; batch < order.batch_count(); ++batch) {
    for (int lane = 0; lane < pairs.active[batch]; ++lane)
      EXPECT_GE(pairs.steps[batch], particles.neighbour_counts[std::size_t(pairs.ids[batch * width + lane])]);
    if (pairs.steps[batch] > 0) {
      EXPECT_TRUE(ends.emplace(pairs.offsets[batch], pairs.offsets[batch] + pairs.steps[batch]).second);
    }
  }
  int free = 0;
  for (const auto &[begin, end] : ends) {
    EXPECT_GE(begin, free);
    free = end;
  }
  EXPECT_LE(std::size_t(free) * std::size_t(width) * 4 * sizeof(int), order.list_bytes());
  // A visit writes the particle and its neighbours. Within a pass, two visits of different chains (another group, or another lane) may run at
  // once: they must not write the same particle.
  std::vector<std::set<std::pair<int, std::pair<int, int>>>> writers(visits.size());
  for (std::size_t i = 0; i < visits.size(); ++i) {
    const auto chain = std::make_pair(visits[i].pass, std::make_pair(visits[i].group, visits[i].lane));
    writers[i].insert(chain);
    for (const int j : particles.neighbours[i]) writers[std::size_t(j)].insert(chain);
  }
  for (const auto &of_particle : writers) {
    std::set<int> passes;
    for (const auto &[pass, chain] : of_particle) EXPECT_TRUE(passes.insert(pass).second);
  }
}

INSTANTIATE_TEST_SUITE_P(ColoursMaterialsWidths, VisitOrderOf,
                         testing::Combine(testing::Values(1, 2), testing::Values(1, 3), testing::Values(4, 16)));

/* The particles of each block in the order of their visits. */
std::map<int, std::vector<int>> visits_by_block(const SortedParticles &particles, unsigned threads) {
  constexpr int width = 4;
  const HostAllocator allocator;
  Workers workers(threads, {});
  VisitOrder order(allocator, width, threads);
  order.reserve(particles.x.size(), 1, Record::field_count);
  arrange(order, workers, particles);
  const CpuPairs pairs = order.pairs(nullptr);
  const int w = particles.table.colouring.block_width, *size = particles.table.grid.size;
  std::map<int, std::vector<int>> blocks;
  for (int batch = 0; batch < order.batch_count(); ++batch)
    for (int lane = 0; lane < pairs.active[batch]; ++lane) {
      const int particle = pairs.ids[batch * width + lane], cell = int(particles.keys[std::size_t(particle)]);
      const int x = cell / size[2] / size[1] / w, y = cell / size[2] % size[1] / w, z = cell % size[2] / w;
      blocks[(x * size[1] + y) * size[2] + z].push_back(particle);
    }
  return blocks;
}

TEST(VisitOrder, WithinABlockDoesNotDependOnTheNumberOfThreads) {
  const SortedParticles particles(1500, {2, 2}, 1, 0.2f);
  const auto alone = visits_by_block(particles, 1);
  EXPECT_EQ(alone, visits_by_block(particles, 2));
  EXPECT_EQ(alone, visits_by_block(particles, 7));
}

TEST(VisitOrder, GivesEachThreadItsShareOfEveryPassInOnePlace) {
  const SortedParticles particles(6000, {1, 3}, 1, 0.2f);
  constexpr int width = 4;
  const HostAllocator allocator;
  Workers workers(2, {});
  VisitOrder order(allocator, width, 2);
  order.reserve(particles.x.size(), 1, Record::field_count);
  arrange(order, workers, particles);
  const CpuPairs pairs = order.pairs(nullptr);
  std::vector<int> times(std::size_t(order.passes().back().last_group));
  for (unsigned part = 0; part < 2; ++part)
    for (int i = order.groups_of_part(part); i < order.groups_of_part(part + 1); ++i)
      ++times[std::size_t(order.group_of_part(i))];
  for (const int count : times) EXPECT_EQ(count, 1);
  std::int64_t lanes = 0;
  for (int pass = 0; pass < int(order.passes().size()); ++pass) {
    float least_of_second = 1, most_of_first = 0;
    std::int64_t own[2] = {};
    for (unsigned part = 0; part < 2; ++part)
      for (int group = order.part_begin(pass, part); group < order.part_begin(pass, part + 1); ++group)
        for (int batch = order.group_begin(group); batch < order.group_begin(group + 1); ++batch) {
          own[part] += pairs.active[batch];
          lanes += width;
          for (int lane = 0; lane < pairs.active[batch]; ++lane) {
            const float x = particles.x[std::size_t(pairs.ids[batch * width + lane])];
            if (part == 0) most_of_first = std::max(most_of_first, x);
            if (part == 1) least_of_second = std::min(least_of_second, x);
          }
        }
    const auto share = double(own[0]) / double(order.passes()[std::size_t(pass)].particles);
    EXPECT_GT(share, 0.45) << pass;
    EXPECT_LT(share, 0.55) << pass;
    EXPECT_LT(most_of_first, least_of_second + 2 * r * 1.0001f) << pass; // they may share one layer of cells
  }
  // Lanes are of like length.
  EXPECT_LT(double(lanes) / 6000, 1.1);
}

TEST(VisitOrder, TheColouringThatThePaperGivesWouldConflict) {
  // 8 colours of single cells, 2r apart: the check above must be able to fail.
  const Colouring colouring = {1, 2};
  const SortedParticles particles(1500, colouring, 1, 0.2f);
  std::size_t conflicts = 0;
  for (std::size_t i = 0; i < particles.x.size(); ++i) {
    std::set<std::uint32_t> cells_of_one_colour[8];
    const auto add = [&](std::size_t j) {
      const auto key = int(particles.keys[j]);
      const int n = particles.table.grid.size[2], c = key % n % 2 + key / n % n % 2 * 2 + key / n / n % 2 * 4;
      cells_of_one_colour[c].insert(particles.keys[j]);
    };
    add(i);
    for (const int j : particles.neighbours[i]) add(std::size_t(j));
    conflicts +=
        std::any_of(cells_of_one_colour, cells_of_one_colour + 8, [](const auto &cells) { return cells.size() > 1; });
  }
  EXPECT_GT(conflicts, particles.x.size() / 4);
}

} // namespace
} // namespace loam
