#include "scene/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <numeric>

#include "scene/error.h"

namespace loam {
namespace {

constexpr std::uint32_t max_triangles = 1u << 28; // indices, features and tree entries stay within 32 bits
constexpr float max_coordinate = 1e8f;            // the fourth power of an edge stays within float

void check(const loam_mesh &mesh, const char *field) {
  if (mesh.positions == nullptr) throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s.positions is null", field));
  if (mesh.indices == nullptr) throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s.indices is null", field));
  if (mesh.triangle_count > max_triangles) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("%s.triangle_count is %u, must be at most %u", field, mesh.triangle_count, max_triangles));
  }
  check_vertices(mesh.positions, mesh.vertex_count, format("%s.positions", field).c_str());
  for (std::size_t i = 0; i < std::size_t(mesh.triangle_count) * 3; ++i) {
    if (mesh.indices[i] >= mesh.vertex_count) {
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s.indices[%zu] (triangle %zu) is %u, must be under vertex_count, %u",
                                                      field, i, i / 3, mesh.indices[i], mesh.vertex_count));
    }
  }
}

// For each vertex the first one at the same place. Meshes that repeat a vertex for its normal or texture are not open because of it.
std::vector<std::uint32_t> weld(const std::vector<Vec3<float>> &vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const Vec3<float> &a = vertices[i], &b = vertices[j];
    if (a.x != b.x) return a.x < b.x;
    if (a.y != b.y) return a.y < b.y;
    if (a.z != b.z) return a.z < b.z;
    return i < j;
  };
  std::sort(order.begin(), order.end(), before);
  std::vector<std::uint32_t> first(vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::uint32_t i = order[k];
    first[i] = i;
    if (k == 0) continue;
    const std::uint32_t previous = order[k - 1];
    const Vec3<float> &a = vertices[previous], &b = vertices[i];
    if (a.x == b.x && a.y == b.y && a.z == b.z) first[i] = first[previous];
  }
  return first;
}

// A height under a millionth of the longest edge is within the rounding of the vertices: the triangle has no direction.
bool has_area(Vec3<float> a, Vec3<float> b, Vec3<float> c) {
  const Vec3<double> ab{double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z};
  const Vec3<double> ac{double(c.x) - a.x, double(c.y) - a.y, double(c.z) - a.z};
  const Vec3<double> bc = ac - ab;
  const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
  return length(cross(ab, ac)) > 1e-6 * longest;
}

struct Edge {
  std::uint32_t low, high; // welded vertices
  std::uint32_t use;       // of the triangles' edges, the how-manieth
  bool reversed;           // runs from high to low in its triangle
};

// Counts edges and keeps the names of the first few.
struct FlawList {
  std::uint32_t count = 0;
  std::string names;

  void add(const Edge &edge) {
    constexpr std::uint32_t named = 3;
    if (count < named) names += format("%s%u-%u", count > 0 ? ", " : "", edge.low, edge.high);
    if (count == named) names += ", ...";
    ++count;
  }
  std::string text(const char *kind) const {
    return count == 0 ? "" : format("%u %s edges (between vertices %s)", count, kind, names.c_str());
  }
};

// Counts open and non-manifold edges over `corners` (three welded vertices a triangle).
void inspect_edges(const std::vector<std::uint32_t> &corners, TriangleMesh &mesh) {
  std::vector<Edge> edges;
  edges.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t from = corners[i], to = corners[i % 3 == 2 ? i - 2 : i + 1];
    edges.push_back({std::min(from, to), std::max(from, to), std::uint32_t(i), from > to});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge &a, const Edge &b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.use < b.use;
  });
  FlawList open, non_manifold;
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin;
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    const std::size_t uses = end - begin;
    if (uses == 1) {
      open.add(edges[begin]);
    } else if (uses > 2 || edges[begin].reversed == edges[begin + 1].reversed) {
      non_manifold.add(edges[begin]);
    }
    begin = end;
  }
  mesh.report.open_edges = open.count;
  mesh.report.non_manifold_edges = non_manifold.count;
  mesh.report.closed = open.count == 0 && non_manifold.count == 0 ? 1u : 0u;
  mesh.first_flaw = open.text("open");
  if (open.count > 0 && non_manifold.count > 0) mesh.first_flaw += " and ";
  mesh.first_flaw += non_manifold.text("non-manifold");
}

TriangleMesh clean(const loam_mesh &source, const char *field) {
  TriangleMesh mesh;
  mesh.report.struct_size = sizeof mesh.report;
  mesh.vertices.resize(source.vertex_count);
  if (source.vertex_count > 0) {
    std::memcpy(static_cast<void *>(mesh.vertices.data()), source.positions, source.vertex_count * sizeof(Vec3<float>));
  }
  const std::vector<std::uint32_t> welded = weld(mesh.vertices);

  // A triangle without area still joins its neighbours (it fills a T-junction): it counts for the edges, not for the surface.
  std::vector<std::uint32_t> corners;
  corners.reserve(std::size_t(source.triangle_count) * 3);
  mesh.indices.reserve(std::size_t(source.triangle_count) * 3);
  for (std::size_t t = 0; t < source.triangle_count; ++t) {
    const std::uint32_t *index = source.indices + 3 * t;
    const std::array<std::uint32_t, 3> corner = {welded[index[0]], welded[index[1]], welded[index[2]]};
    const bool distinct = corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0];
    if (distinct) corners.insert(corners.end(), corner.begin(), corner.end());
    if (distinct && has_area(mesh.vertices[index[0]], mesh.vertices[index[1]], mesh.vertices[index[2]])) {
      mesh.indices.insert(mesh.indices.end(), index, index + 3);
      ++mesh.report.triangles;
    } else {
      ++mesh.report.degenerate_triangles;
    }
  }
  if (mesh.report.triangles == 0) {
    throw Error(LOAM_ERROR_INVALID_MESH,
                format("%s has no usable triangle: of %u, %u are degenerate (no area, or a repeated vertex)", field,
                       source.triangle_count, mesh.report.degenerate_triangles));
  }
  inspect_edges(corners, mesh);
  return mesh;
}

} // namespace

void check_vertices(const float *positions, std::uint32_t vertex_count, const char *field) {
  for (std::size_t i = 0; i < std::size_t(vertex_count) * 3; ++i) {
    const float value = positions[i];
    if (!(std::fabs(value) <= max_coordinate)) {
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s[%zu] (vertex %zu) is %g, must be finite and within +-%g", field, i,
                                                      i / 3, double(value), double(max_coordinate)));
    }
  }
}

TriangleMesh make_triangle_mesh(const loam_mesh &mesh, const char *field) {
  check(mesh, field);
  try {
    return clean(mesh, field);
  } catch (const std::bad_alloc &) {
    throw Error(LOAM_ERROR_OUT_OF_MEMORY,
                format("no memory for %s with %u vertices and %u triangles", field, mesh.vertex_count, mesh.triangle_count));
  }
}

} // namespace loam
