// Colours for constraints that share vertices: no two of a colour have a vertex in common.
#pragma once

#include <vector>

namespace loam {

struct Colours {
  std::vector<int> order;  // constraints, colour by colour, and in their own order within a colour
  std::vector<int> starts; // of each colour in `order`; one more entry than colours
};

// Constraint i has the vertices indices[starts[i]] up to indices[starts[i + 1] - 1], each under `vertex_count`. Greedy, in order: few colours, and the same always.
Colours colour_constraints(const std::vector<int> &indices, const std::vector<int> &starts, int vertex_count);

} // namespace loam
