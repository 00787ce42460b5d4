#include "scene/collider_shape.h"

#include <algorithm>
#include <cmath>
#include <new>

#include "scene/checks.h"

namespace loam {
namespace {

constexpr double greatest_length = 1e8; // as of a mesh's coordinates

Vec3<double> widen(Vec3<float> v) { return {double(v.x), double(v.y), double(v.z)}; }

// ---------------------------------------------------------------------------------------------------------- hulls ---

constexpr std::uint32_t most_hull_triangles = 1024;

ConvexHull make_hull(const loam_mesh &source, loam_collider_report &report) {
  if (source.triangle_count > most_hull_triangles)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("mesh.triangle_count is %u; a convex hull has at most %u",
                                                    source.triangle_count, most_hull_triangles));
  const TriangleMesh mesh = make_triangle_mesh(source, "mesh");
  report = mesh.report;
  if (mesh.report.closed == 0)
    throw Error(LOAM_ERROR_INVALID_MESH,
                format("mesh is not the surface of a convex hull: it has %s", mesh.first_flaw.c_str()));

  double size = 0, six_volumes = 0;
  const auto vertex = [&](std::size_t corner) { return mesh.vertices[mesh.indices[corner]]; };
  for (std::size_t c = 0; c < mesh.indices.size(); ++c) {
    const Vec3<double> from_first = widen(vertex(c)) - widen(vertex(0));
    size = std::max({size, std::abs(from_first.x), std::abs(from_first.y), std::abs(from_first.z)});
  }
  ConvexHull hull;
  for (std::size_t c = 0; c < mesh.indices.size(); c += 3) {
    const Vec3<double> a = widen(vertex(c)), ab = widen(vertex(c + 1)) - a, ac = widen(vertex(c + 2)) - a;
    const Vec3<double> twice_area = cross(ab, ac), normal = (1 / length(twice_area)) * twice_area;
    six_volumes += dot(a - widen(vertex(0)), twice_area);
    double offset = dot(normal, a);
    for (std::size_t other = 0; other < mesh.indices.size(); ++other) {
      const double height = dot(normal, widen(vertex(other)) - a);
      if (height > 1e-3 * size)
        throw Error(LOAM_ERROR_INVALID_MESH,
                    format("mesh is not convex, or its triangles face inward: vertex %u is %g m in front of triangle %zu",
                           mesh.indices[other], height, c / 3));
      offset = std::max(offset, dot(normal, widen(vertex(other))));
    }
    hull.faces.push_back(
        {vertex(c), vertex(c + 1), vertex(c + 2), {float(normal.x), float(normal.y), float(normal.z)}, float(offset)});
  }
  if (!(six_volumes > 1e-12 * size * size * size))
    throw Error(LOAM_ERROR_INVALID_MESH, "mesh is flat: a convex hull must have a volume");
  return hull;
}

// ---------------------------------------------------------------------------------------------------------- grids ---

constexpr double greatest_slope = 2; // distances change by 1 at most; so much is forgiven

// The greatest length of the gradient within a cell, from the slopes along its edges. Throws Error if one of those is no distance's.
double steepest_cell(const loam_distance_grid &grid) {
  const std::size_t step[3] = {1, grid.size[0], std::size_t(grid.size[0]) * grid.size[1]};
  double steepest = 0;
  for (std::size_t z = 0; z + 1 < grid.size[2]; ++z)
    for (std::size_t y = 0; y + 1 < grid.size[1]; ++y)
      for (std::size_t x = 0; x + 1 < grid.size[0]; ++x) {
        const float *cell = grid.values + x * step[0] + y * step[1] + z * step[2];
        double squared = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          double most = 0;
          for (std::size_t k = 0; k < 4; ++k) {
            const float *from = cell + (k & 1) * step[(axis + 1) % 3] + (k >> 1) * step[(axis + 2) % 3];
            most = std::max(most, std::abs(double(from[step[axis]]) - double(*from)));
          }
          if (most > greatest_slope * double(grid.spacing))
            throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                        format("grid.values change by %g from point to point near %zu, %zu, %zu, over a spacing of %g: "
                               "distances would change by that at most",
                               most, x, y, z, double(grid.spacing)));
          squared += most * most;
        }
        steepest = std::max(steepest, squared);
      }
  return std::sqrt(steepest) / double(grid.spacing);
}

DistanceGrid make_grid(const loam_distance_grid &grid) {
  check_pointer(grid.values, "grid.values");
  check_vector("grid.origin", grid.origin, greatest_length);
  check_range("grid.spacing", double(grid.spacing), 1e-6, 1e6);
  check_reserved("grid.reserved", grid.reserved);
  std::uint64_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    check_range(format("grid.size[%d]", axis).c_str(), grid.size[axis], 2, 65536);
    count *= grid.size[axis];
  }
  if (count > std::uint64_t(1) << 28)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("grid.size is %u x %u x %u: more than 2^28 values", grid.size[0], grid.size[1], grid.size[2]));
  float least = grid.values[0];
  for (std::uint64_t i = 0; i < count; ++i) {
    const float value = grid.values[i];
    if (!(std::abs(double(value)) <= greatest_length))
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("grid.values[%llu] is %g; it must be finite and at most %g in size",
                                                      static_cast<unsigned long long>(i), double(value), greatest_length));
    least = std::min(least, value);
  }
  if (least > 0)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("grid.values are %g or more: nothing is solid", double(least)));
  DistanceGrid result;
  result.values.assign(grid.values, grid.values + count);
  result.shape = {nullptr,
                  {int(grid.size[0]), int(grid.size[1]), int(grid.size[2])},
                  {grid.origin[0], grid.origin[1], grid.origin[2]},
                  grid.spacing,
                  float(0.99999 / std::max(1.0, steepest_cell(grid)))};
  return result;
}

ColliderShape make_shape(const loam_collider_def &def, loam_collider_report &report) {
  switch (def.kind) {
  case LOAM_COLLIDER_PLANE:
    return PlaneShape{};
  case LOAM_COLLIDER_MESH: {
    const TriangleMesh mesh = make_triangle_mesh(def.mesh, "mesh");
    report = mesh.report;
    return build_bounding_volume_hierarchy(mesh, def.deforms == 1);
  }
  case LOAM_COLLIDER_SPHERE:
    check_above("radius", double(def.radius), 0, greatest_length);
    return SphereShape{def.radius};
  case LOAM_COLLIDER_CAPSULE:
    check_above("radius", double(def.radius), 0, greatest_length);
    check_range("half_height", double(def.half_height), 0, greatest_length);
    return CapsuleShape{def.radius, def.half_height};
  case LOAM_COLLIDER_BOX:
    for (int axis = 0; axis < 3; ++axis)
      check_above(format("half_extents[%d]", axis).c_str(), double(def.half_extents[axis]), 0, greatest_length);
    return BoxShape{{def.half_extents[0], def.half_extents[1], def.half_extents[2]}};
  case LOAM_COLLIDER_HULL:
    return make_hull(def.mesh, report);
  default:
    return make_grid(def.grid);
  }
}

} // namespace

ColliderShape make_collider_shape(const loam_collider_def &def, loam_collider_report &report) {
  check_choice("kind", def.kind, LOAM_COLLIDER_GRID);
  try {
    return make_shape(def, report);
  } catch (const std::bad_alloc &) {
    throw Error(LOAM_ERROR_OUT_OF_MEMORY, "no memory for the collider's shape");
  }
}

} // namespace loam
