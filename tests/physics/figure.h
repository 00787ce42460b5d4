/* Scenes after the figures of the paper, and what is measured in them. */
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "solid.h"

namespace loam::test {

/* Distances of particles to their nearest, in spacings. */
struct Gaps {
  double mean, deviation, least;
};

inline Gaps gaps(const std::vector<float> &positions, float spacing) {
  std::vector<Vector> points;
  for (std::size_t i = 0; i < positions.size(); i += 3)
    points.push_back(Vector(double(positions[i]), double(positions[i + 1]), double(positions[i + 2])) / double(spacing));
  std::sort(points.begin(), points.end(), [](const Vector &a, const Vector &b) { return a.x() < b.x(); });
  std::vector<double> nearest(points.size(), 3);
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t b = a + 1; b < points.size() && points[b].x() - points[a].x() < 3; ++b) {
      const double distance = (points[b] - points[a]).norm();
      nearest[a] = std::min(nearest[a], distance);
      nearest[b] = std::min(nearest[b], distance);
    }
  Gaps all = {0, 0, 3};
  const double share = 1 / double(nearest.size());
  for (const double distance : nearest) {
    all.mean += share * distance;
    all.least = std::min(all.least, distance);
  }
  for (const double distance : nearest) all.deviation += share * (distance - all.mean) * (distance - all.mean);
  all.deviation = std::sqrt(all.deviation);
  return all;
}

/* The value that `share` of the particles stay under. */
template <class Measure> double quantile(const std::vector<float> &positions, double share, Measure &&measure) {
  std::vector<double> values;
  for (std::size_t i = 0; i < positions.size(); i += 3)
    values.push_back(measure(double(positions[i]), double(positions[i + 1]), double(positions[i + 2])));
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
}

/* Those of the points, in spacings, for which `inside` holds. */
template <class Inside> std::vector<float> cut(const std::vector<float> &points, float spacing, Inside &&inside) {
  std::vector<float> left;
  for (std::size_t i = 0; i < points.size(); i += 3)
    if (inside(points[i] / spacing, points[i + 1] / spacing, points[i + 2] / spacing))
      left.insert(left.end(), {points[i], points[i + 1], points[i + 2]});
  return left;
}

} // namespace loam::test
