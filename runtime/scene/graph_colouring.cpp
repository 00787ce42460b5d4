#include "scene/graph_colouring.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

namespace loam {

Colours colour_constraints(const std::vector<int> &indices, const std::vector<int> &starts, int vertex_count) {
  constexpr int per_round = 64; // colours of a round: a word a vertex says which of them it has met
  Colours colours;
  colours.starts.push_back(0);
  std::vector<int> left(starts.size() - 1), next;
  std::iota(left.begin(), left.end(), 0);
  std::vector<std::uint64_t> taken(static_cast<std::size_t>(vertex_count));
  while (!left.empty()) {
    std::fill(taken.begin(), taken.end(), 0);
    std::vector<std::vector<int>> members(per_round);
    next.clear();
    for (const int i : left) {
      const int *vertices = indices.data() + starts[static_cast<std::size_t>(i)];
      const int size = starts[static_cast<std::size_t>(i) + 1] - starts[static_cast<std::size_t>(i)];
      std::uint64_t met = 0;
      for (int k = 0; k < size; ++k) met |= taken[static_cast<std::size_t>(vertices[k])];
      const int colour = std::countr_one(met);
      if (colour == per_round) {
        next.push_back(i);
        continue;
      }
      for (int k = 0; k < size; ++k) taken[static_cast<std::size_t>(vertices[k])] |= std::uint64_t(1) << colour;
      members[static_cast<std::size_t>(colour)].push_back(i);
    }
    for (const std::vector<int> &colour : members) {
      if (colour.empty()) break;
      colours.order.insert(colours.order.end(), colour.begin(), colour.end());
      colours.starts.push_back(static_cast<int>(colours.order.size()));
    }
    left.swap(next);
  }
  return colours;
}

} // namespace loam
