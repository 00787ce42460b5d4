/* Scenes of granular matter, and what is measured in them. */
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "support/scenes.h"

namespace loam::test {

constexpr double degree = std::numbers::pi / 180;

/* The coordinate along `axis` (0 x, 1 y, 2 z; 3 the distance from the y axis) that a share of the particles does not exceed. */
inline double quantile(const std::vector<float> &positions, std::size_t axis, double share) {
  std::vector<double> values;
  for (std::size_t i = 0; i < positions.size(); i += 3)
    values.push_back(axis < 3 ? double(positions[i + axis]) : std::hypot(double(positions[i]), double(positions[i + 2])));
  const std::size_t rank = std::min(values.size() - 1, std::size_t(share * double(values.size())));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(rank), values.end());
  return values[rank];
}

} // namespace loam::test
