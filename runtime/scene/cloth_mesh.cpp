#include "scene/cloth_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "scene/checks.h"
#include "solver/cloth_backend.h"

namespace loam {
namespace {

constexpr std::uint32_t most_triangles = 1u << 24;
constexpr double greatest_coordinate = 1e4; // m: areas and their inverses stay within float

void check_arrays(const loam_mesh &mesh) {
  check_pointer(mesh.positions, "mesh.positions");
  check_pointer(mesh.indices, "mesh.indices");
  check_range("mesh.triangle_count", mesh.triangle_count, 1, most_triangles);
  check_range("mesh.vertex_count", mesh.vertex_count, 3, most_triangles);
  for (std::size_t i = 0; i < std::size_t(mesh.vertex_count) * 3; ++i)
    if (!(std::fabs(double(mesh.positions[i])) <= greatest_coordinate))
      throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                  format("mesh.positions[%zu] (vertex %zu) is %g, must be finite and within +-%g", i, i / 3,
                         double(mesh.positions[i]), greatest_coordinate));
  for (std::size_t i = 0; i < std::size_t(mesh.triangle_count) * 3; ++i)
    if (mesh.indices[i] >= mesh.vertex_count)
      throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                  format("mesh.indices[%zu] (triangle %zu) is %u, must be under vertex_count, %u", i, i / 3, mesh.indices[i],
                         mesh.vertex_count));
}

void check_cloth_vertices(const ClothMesh &mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const int i : mesh.triangles) used[at(i)] = true;
  if (const auto unused = std::find(used.begin(), used.end(), false); unused != used.end())
    throw Error(LOAM_ERROR_INVALID_MESH,
                format("mesh vertex %td belongs to no triangle; leave unused vertices out", unused - used.begin()));
  std::vector<int> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](int i, int j) {
    const Vec3<float> &a = mesh.vertices[at(i)], &b = mesh.vertices[at(j)];
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    if (a.z != b.z) return a.z < b.z;
    return i < j;
  };
  std::sort(order.begin(), order.end(), before);
  for (std::size_t k = 1; k < order.size(); ++k) {
    const Vec3<float> &a = mesh.vertices[at(order[k - 1])], &b = mesh.vertices[at(order[k])];
    if (a.x == b.x && a.y == b.y && a.z == b.z)
      throw Error(LOAM_ERROR_INVALID_MESH,
                  format("mesh vertices %d and %d are in one place, (%g, %g, %g); the cloth would be open there: weld them",
                         order[k - 1], order[k], double(a.x), double(a.y), double(a.z)));
  }
}

Vec3<double> edge(const ClothMesh &mesh, int from, int to) {
  const Vec3<float> &a = mesh.vertices[at(from)], &b = mesh.vertices[at(to)];
  return {double(b.x) - double(a.x), double(b.y) - double(a.y), double(b.z) - double(a.z)};
}

void measure_areas(ClothMesh &mesh) {
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
    const int *v = mesh.triangles.data() + 3 * t;
    const Vec3<double> ab = edge(mesh, v[0], v[1]), ac = edge(mesh, v[0], v[2]), bc = ac - ab;
    const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)}), twice = length(cross(ab, ac));
    // A height under a ten-thousandth of the longest edge makes strains of rounding errors.
    if (!(twice > 1e-4 * longest) || !(twice > 2e-14))
      throw Error(LOAM_ERROR_INVALID_MESH,
                  format("mesh triangle %zu (vertices %d, %d, %d) has no area: %g m^2", t, v[0], v[1], v[2], 0.5 * twice));
    mesh.areas.push_back(static_cast<float>(0.5 * twice));
  }
}

struct Use { // of an edge by a triangle
  int low, high, triangle, corner;
  bool reversed;
};

void find_edges(ClothMesh &mesh) {
  std::vector<Use> uses;
  uses.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const int from = mesh.triangles[i], to = mesh.triangles[i % 3 == 2 ? i - 2 : i + 1];
    uses.push_back({std::min(from, to), std::max(from, to), static_cast<int>(i / 3), static_cast<int>(i % 3), from > to});
  }
  std::sort(uses.begin(), uses.end(), [](const Use &a, const Use &b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });
  const auto opposite = [&](const Use &use) { return mesh.triangles[at(3 * use.triangle + (use.corner + 2) % 3)]; };
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) ++end;
    const Use &first = uses[begin];
    if (end - begin > 2)
      throw Error(LOAM_ERROR_INVALID_MESH,
                  format("mesh edge %d-%d belongs to %zu triangles (%d, %d, %d%s); cloth has at most two at an edge",
                         first.low, first.high, end - begin, first.triangle, uses[begin + 1].triangle,
                         uses[begin + 2].triangle, end - begin > 3 ? ", ..." : ""));
    float area = 0;
    for (std::size_t k = begin; k < end; ++k) area += mesh.areas[at(uses[k].triangle)];
    mesh.edges.push_back({first.low, first.high, first.triangle, area});
    if (end - begin < 2) continue;
    const Use &second = uses[begin + 1];
    if (first.reversed == second.reversed)
      throw Error(LOAM_ERROR_INVALID_MESH, format("mesh triangles %d and %d disagree on the orientation of edge %d-%d",
                                                  first.triangle, second.triangle, first.low, first.high));
    const int from = first.reversed ? first.high : first.low, to = first.reversed ? first.low : first.high;
    mesh.hinges.push_back({{from, to, opposite(first), opposite(second)}, {first.triangle, second.triangle}});
  }
}

} // namespace

ClothMesh make_cloth_mesh(const loam_mesh &mesh) {
  check_arrays(mesh);
  ClothMesh result;
  for (std::uint32_t i = 0; i < mesh.vertex_count; ++i) {
    const float *x = mesh.positions + 3 * std::size_t(i);
    result.vertices.push_back({x[0], x[1], x[2]});
  }
  result.triangles.assign(mesh.indices, mesh.indices + 3 * std::size_t(mesh.triangle_count));
  check_cloth_vertices(result);
  measure_areas(result);
  find_edges(result);
  return result;
}

} // namespace loam
