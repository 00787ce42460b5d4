/* How many triangles of a mesh, or of two, pass through each other: in double precision, all pairs that are near. */
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace loam::intersections {

using Point = std::array<double, 3>;

/* Six times the volume of a tetrahedron. */
inline double volume(const Point &a, const Point &b, const Point &c, const Point &d) {
  double m[3][3];
  for (std::size_t k = 0; k < 3; ++k) {
    m[0][k] = a[k] - d[k];
    m[1][k] = b[k] - d[k];
    m[2][k] = c[k] - d[k];
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/* Does the segment p q pass through the triangle's inside? Touching does not count. */
inline bool pierces(const Point &p, const Point &q, const Point &a, const Point &b, const Point &c) {
  const double from = volume(a, b, c, p), to = volume(a, b, c, q);
  if (!(from * to < 0)) return false;
  const double u = volume(p, q, a, b), v = volume(p, q, b, c), w = volume(p, q, c, a);
  return (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
}

/* Pairs of triangles without a common vertex that pass through each other. `positions` are x, y, z of each vertex. */
inline std::size_t count(const std::vector<float> &positions, const std::vector<std::uint32_t> &indices) {
  const std::size_t triangles = indices.size() / 3;
  const auto vertex = [&](std::uint32_t i) {
    return Point{double(positions[3 * i]), double(positions[3 * i + 1]), double(positions[3 * i + 2])};
  };
  struct Box {
    Point low, high;
  };
  std::vector<Box> boxes(triangles);
  double cell = 0;
  for (std::size_t t = 0; t < triangles; ++t) {
    Box &box = boxes[t];
    box = {vertex(indices[3 * t]), vertex(indices[3 * t])};
    for (std::size_t k = 1; k < 3; ++k)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], vertex(indices[3 * t + k])[axis]);
        box.high[axis] = std::max(box.high[axis], vertex(indices[3 * t + k])[axis]);
      }
    for (std::size_t axis = 0; axis < 3; ++axis) cell = std::max(cell, box.high[axis] - box.low[axis]);
  }
  // Each triangle is in the cell of its low corner; what overlaps it is there or in a cell beside.
  std::map<std::array<long, 3>, std::vector<std::size_t>> cells;
  const auto cell_of = [&](const Point &x) {
    return std::array<long, 3>{std::lround(std::floor(x[0] / cell)), std::lround(std::floor(x[1] / cell)),
                               std::lround(std::floor(x[2] / cell))};
  };
  for (std::size_t t = 0; t < triangles; ++t) cells[cell_of(boxes[t].low)].push_back(t);
  const auto meet = [&](std::size_t s, std::size_t t) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (boxes[s].low[axis] > boxes[t].high[axis] || boxes[t].low[axis] > boxes[s].high[axis]) return false;
    Point a[3], b[3];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (indices[3 * s + i] == indices[3 * t + j]) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] = vertex(indices[3 * s + i]);
      b[i] = vertex(indices[3 * t + i]);
    }
    for (std::size_t i = 0; i < 3; ++i)
      if (pierces(a[i], a[(i + 1) % 3], b[0], b[1], b[2]) || pierces(b[i], b[(i + 1) % 3], a[0], a[1], a[2])) return true;
    return false;
  };
  std::size_t sum = 0;
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::array<long, 3> own = cell_of(boxes[t].low);
    for (long x = -1; x <= 1; ++x)
      for (long y = -1; y <= 1; ++y)
        for (long z = -1; z <= 1; ++z)
          if (const auto there = cells.find({own[0] + x, own[1] + y, own[2] + z}); there != cells.end())
            for (const std::size_t s : there->second)
              if (s < t && meet(s, t)) ++sum;
  }
  return sum;
}

} // namespace loam::intersections
