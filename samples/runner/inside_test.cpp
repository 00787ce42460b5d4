#include "inside_test.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace runner {
namespace {

constexpr std::uint32_t leaf_triangles = 8;
constexpr int cells_along_longest_axis = 160;

std::uint64_t edge_key(std::uint32_t from, std::uint32_t to) { return std::uint64_t(from) << 32 | to; }

// Positive if the point sees the triangle's back, that is, lies on its inner side.
double solid_angle(Vector3d a, Vector3d b, Vector3d c, Vector3d point) {
  a = a - point;
  b = b - point;
  c = c - point;
  const double la = length(a), lb = length(b), lc = length(c);
  const double numerator = dot(a, cross(b, c));
  const double denominator = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return 2 * std::atan2(numerator, denominator);
}

Vector3d rotate(const std::array<float, 4> &rotation, Vector3d v) {
  const Vector3d axis = {rotation[0], rotation[1], rotation[2]};
  const Vector3d t = 2.0 * cross(axis, v);
  return v + double(rotation[3]) * t + cross(axis, t);
}

} // namespace

bool is_closed(const Mesh &mesh) {
  std::unordered_map<std::uint64_t, int> edges;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    for (std::size_t c = 0; c < 3; ++c) ++edges[edge_key(mesh.indices[i + c], mesh.indices[i + (c + 1) % 3])];
  return std::all_of(edges.begin(), edges.end(), [&](const auto &edge) {
    const auto opposite = edges.find(edge_key(std::uint32_t(edge.first), std::uint32_t(edge.first >> 32)));
    return edge.second == 1 && opposite != edges.end() && opposite->second == 1;
  });
}

double winding_number_of_all_triangles(const Mesh &mesh, Vector3d point) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    sum += solid_angle(to_double(mesh.vertices[mesh.indices[i]]), to_double(mesh.vertices[mesh.indices[i + 1]]),
                       to_double(mesh.vertices[mesh.indices[i + 2]]), point);
  return sum / (4 * std::numbers::pi);
}

InsideTest::InsideTest(const Mesh &mesh, Vector3 position, const std::array<float, 4> &rotation) {
  for (const Vector3 vertex : mesh.vertices) vertices_.push_back(rotate(rotation, to_double(vertex)) + to_double(position));
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    triangles_.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
  build(0, static_cast<std::uint32_t>(triangles_.size()));
  mark_crossed_cells();
}

std::uint32_t InsideTest::build(std::uint32_t first, std::uint32_t count) {
  Node node;
  node.first = first;
  node.count = count;
  node.low = node.high = vertices_[triangles_[first][0]];
  for (std::uint32_t i = first; i < first + count; ++i)
    for (const std::uint32_t corner : triangles_[i]) {
      node.low = minimum(node.low, vertices_[corner]);
      node.high = maximum(node.high, vertices_[corner]);
    }
  add_fan(node);
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back(node);
  if (count <= leaf_triangles) return self;

  const Vector3d extent = node.high - node.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const auto centre = [&](const Triangle &t) {
    return vertices_[t[0]][axis] + vertices_[t[1]][axis] + vertices_[t[2]][axis];
  };
  const auto begin = triangles_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](const Triangle &a, const Triangle &b) { return centre(a) < centre(b); });
  build(first, count / 2);
  nodes_[self].right = build(first + count / 2, count - count / 2);
  return self;
}

void InsideTest::add_fan(Node &node) {
  std::unordered_map<std::uint64_t, int> edges;
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t from = triangles_[i][c], to = triangles_[i][(c + 1) % 3];
      const auto opposite = edges.find(edge_key(to, from));
      if (opposite != edges.end())
        edges.erase(opposite);
      else
        ++edges[edge_key(from, to)];
    }
  node.fan_first = static_cast<std::uint32_t>(fans_.size());
  if (edges.empty()) return;
  std::vector<std::uint64_t> boundary;
  for (const auto &[edge, uses] : edges) boundary.push_back(edge);
  std::sort(boundary.begin(), boundary.end()); // the hash table's order must not decide the rounding
  const auto apex = std::uint32_t(boundary.front() >> 32);
  for (const std::uint64_t edge : boundary) {
    const auto from = std::uint32_t(edge >> 32), to = std::uint32_t(edge);
    if (from != apex && to != apex) fans_.push_back({from, to, apex});
  }
  node.fan_count = static_cast<std::uint32_t>(fans_.size()) - node.fan_first;
}

double InsideTest::solid_angles(const std::vector<Triangle> &triangles, std::uint32_t first, std::uint32_t count,
                                Vector3d point) const {
  double sum = 0;
  for (std::uint32_t i = first; i < first + count; ++i)
    sum += solid_angle(vertices_[triangles[i][0]], vertices_[triangles[i][1]], vertices_[triangles[i][2]], point);
  return sum;
}

double InsideTest::winding_number(Vector3d point) const {
  double sum = 0;
  std::array<std::uint32_t, 64> stack{};
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t index = stack[--size];
    const Node &node = nodes_[index];
    const bool in_box = point.x >= node.low.x && point.x <= node.high.x && point.y >= node.low.y && point.y <= node.high.y &&
                        point.z >= node.low.z && point.z <= node.high.z;
    if (!in_box && node.fan_count < node.count) {
      sum += solid_angles(fans_, node.fan_first, node.fan_count, point);
    } else if (node.right == 0) {
      sum += solid_angles(triangles_, node.first, node.count, point);
    } else {
      stack[size++] = node.right;
      stack[size++] = index + 1;
    }
  }
  return sum / (4 * std::numbers::pi);
}

void InsideTest::mark_crossed_cells() {
  const Vector3d low = nodes_[0].low, extent = nodes_[0].high - low;
  cell_size_ = std::max({extent.x, extent.y, extent.z}) / cells_along_longest_axis;
  if (!(cell_size_ > 0)) return;
  std::size_t total = 1;
  for (int axis = 0; axis < 3; ++axis) {
    cells_[axis] = static_cast<int>(extent[axis] / cell_size_) + 1;
    total *= static_cast<std::size_t>(cells_[axis]);
  }
  cell_states_ = std::vector<std::atomic<std::uint8_t>>(total);
  for (const Triangle &triangle : triangles_) {
    std::array<int, 3> from{}, to{};
    for (int axis = 0; axis < 3; ++axis) {
      double least = vertices_[triangle[0]][axis], most = least;
      for (const std::uint32_t corner : triangle) {
        least = std::min(least, vertices_[corner][axis]);
        most = std::max(most, vertices_[corner][axis]);
      }
      // A thousandth of a cell of slack, so that rounding cannot put a point on the wrong side of a cell's face.
      from[axis] = std::max(0, static_cast<int>((least - low[axis]) / cell_size_ - 1e-3));
      to[axis] = std::min(cells_[axis] - 1, static_cast<int>((most - low[axis]) / cell_size_ + 1e-3));
    }
    for (int z = from[2]; z <= to[2]; ++z)
      for (int y = from[1]; y <= to[1]; ++y)
        for (int x = from[0]; x <= to[0]; ++x)
          cell_states_[(static_cast<std::size_t>(z) * cells_[1] + y) * cells_[0] + x] = crossed;
  }
}

std::int64_t InsideTest::cell_of(Vector3d point) const {
  std::int64_t cell = 0;
  for (int axis = 2; axis >= 0; --axis) {
    const double along = (point[axis] - nodes_[0].low[axis]) / cell_size_;
    if (!(along >= 0 && along < cells_[axis])) return -1;
    cell = cell * cells_[axis] + static_cast<std::int64_t>(along);
  }
  return cell;
}

bool InsideTest::inside(Vector3d point) const {
  const Node &root = nodes_[0];
  for (int axis = 0; axis < 3; ++axis) // written so that a NaN is outside
    if (!(point[axis] >= root.low[axis] && point[axis] <= root.high[axis])) return false;
  const std::int64_t cell = cell_states_.empty() ? -1 : cell_of(point);
  if (cell < 0) return winding_number(point) > 0.5;
  std::atomic<std::uint8_t> &state = cell_states_[static_cast<std::size_t>(cell)];
  const std::uint8_t known = state.load(std::memory_order_relaxed);
  if (known == all_inside || known == all_outside) return known == all_inside;
  const bool result = winding_number(point) > 0.5;
  if (known == unknown) state.store(result ? all_inside : all_outside, std::memory_order_relaxed);
  return result;
}

} // namespace runner
