#include "distance_field.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "error.h"
#include "inside_test.h"

namespace runner {
namespace {

// Ericson, Real-Time Collision Detection, 5.1.5, in double precision.
double distance_squared(Vector3d p, Vector3d a, Vector3d b, Vector3d c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const auto squared = [](Vector3d v) { return dot(v, v); };
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return squared(ap);
  if (d3 >= 0 && d4 <= d3) return squared(bp);
  if (d6 >= 0 && d5 <= d6) return squared(cp);
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return squared(ap - (d1 / (d1 - d3)) * ab);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return squared(ap - (d2 / (d2 - d6)) * ac);
  if (va <= 0 && d4 >= d3 && d5 >= d6) return squared(bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b));
  const double scale = 1 / (va + vb + vc);
  return squared(ap - (vb * scale) * ab - (vc * scale) * ac);
}

} // namespace

double DistanceField::at(Vector3d point) const {
  std::size_t cell[3];
  double share[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double along = (point[axis] - origin[axis]) / spacing;
    if (!(along >= 0 && along <= size[axis] - 1)) return 1e30;
    cell[axis] = std::min<std::size_t>(static_cast<std::size_t>(along), size[axis] - 2);
    share[axis] = along - static_cast<double>(cell[axis]);
  }
  double sum = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::size_t at = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const std::size_t far = corner >> axis & 1;
      weight *= far != 0 ? share[axis] : 1 - share[axis];
      at = at * size[axis] + cell[axis] + far;
    }
    sum += weight * values[at];
  }
  return sum;
}

DistanceField make_distance_field(const Mesh &mesh, float spacing, float band) {
  if (!is_closed(mesh)) throw Error("the mesh is not closed, so that it has no inside");
  DistanceField field;
  field.spacing = spacing;
  Vector3 low = mesh.vertices[0], high = low;
  for (const Vector3 vertex : mesh.vertices) {
    low = minimum(low, vertex);
    high = maximum(high, vertex);
  }
  const float padding = 2 * spacing;
  double count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    field.origin[axis] = low[axis] - padding;
    const double points = std::ceil((double(high[axis]) - low[axis] + 2 * padding) / spacing) + 1;
    count *= points;
    if (!(count <= 1 << 26)) throw Error(fmt::format("a grid of {} m would have more than 2^26 points", spacing));
    field.size[axis] = static_cast<std::uint32_t>(points);
  }

  std::vector<double> squared(static_cast<std::size_t>(count), double(band) * band);
  const auto place = [&](std::size_t x, std::size_t y, std::size_t z) {
    return Vector3d{double(field.origin.x) + double(spacing) * static_cast<double>(x),
                    double(field.origin.y) + double(spacing) * static_cast<double>(y),
                    double(field.origin.z) + double(spacing) * static_cast<double>(z)};
  };
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vector3 a = mesh.vertices[mesh.indices[i]], b = mesh.vertices[mesh.indices[i + 1]],
                  c = mesh.vertices[mesh.indices[i + 2]];
    const Vector3 least = minimum(a, minimum(b, c)), most = maximum(a, maximum(b, c));
    std::size_t from[3], to[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double first = std::floor((double(least[axis]) - band - field.origin[axis]) / spacing);
      const double last = std::ceil((double(most[axis]) + band - field.origin[axis]) / spacing);
      from[axis] = static_cast<std::size_t>(std::max(0.0, first));
      to[axis] = static_cast<std::size_t>(std::min(double(field.size[axis]) - 1, last));
    }
    for (std::size_t z = from[2]; z <= to[2]; ++z)
      for (std::size_t y = from[1]; y <= to[1]; ++y)
        for (std::size_t x = from[0]; x <= to[0]; ++x) {
          double &best = squared[(z * field.size[1] + y) * field.size[0] + x];
          best = std::min(best, distance_squared(place(x, y, z), to_double(a), to_double(b), to_double(c)));
        }
  }

  const InsideTest test(mesh, {}, {0, 0, 0, 1});
  field.values.resize(squared.size());
  std::size_t i = 0;
  for (std::size_t z = 0; z < field.size[2]; ++z)
    for (std::size_t y = 0; y < field.size[1]; ++y)
      for (std::size_t x = 0; x < field.size[0]; ++x, ++i) {
        const auto distance = static_cast<float>(std::sqrt(squared[i]));
        field.values[i] = test.inside(place(x, y, z)) ? -distance : distance;
      }
  return field;
}

} // namespace runner
