// The tree is that of Karras, "Maximizing parallelism in the construction of BVHs, octrees, and k-d trees" (2012): leaves are the
// triangles in the order of the 30-bit Morton codes of their centres, ties broken by the index; a node covers a range of leaves and splits it
// where the highest differing bit of the codes changes. Karras finds all nodes at once, in parallel; meshes are made once, so here
// they are found from the root down, which lays a parent before its children and a subtree in one piece of memory.

#include "scene/bounding_volume_hierarchy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <new>

#include "scene/error.h"
#include "scene/query_tree.h"

namespace loam {
namespace {

struct Box {
  Vec3<float> lower{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
                    std::numeric_limits<float>::infinity()};
  Vec3<float> upper{-std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
                    -std::numeric_limits<float>::infinity()};

  void include(Vec3<float> lowest, Vec3<float> highest) {
    lower = {std::min(lower.x, lowest.x), std::min(lower.y, lowest.y), std::min(lower.z, lowest.z)};
    upper = {std::max(upper.x, highest.x), std::max(upper.y, highest.y), std::max(upper.z, highest.z)};
  }
  void include(Vec3<float> point) { include(point, point); }
};

// Spreads the lower ten bits of a number to every third bit.
std::uint32_t spread_bits(std::uint32_t v) {
  v = (v * 0x00010001u) & 0xFF0000FFu;
  v = (v * 0x00000101u) & 0x0F00F00Fu;
  v = (v * 0x00000011u) & 0xC30C30C3u;
  v = (v * 0x00000005u) & 0x49249249u;
  return v;
}

std::uint32_t quantised(float value, float lower, float scale) {
  return std::uint32_t(std::clamp((value - lower) * scale, 0.0f, 1023.0f));
}

BvhTriangle triangle_of(const TriangleMesh &mesh, std::size_t t) {
  const Vec3<float> a = mesh.vertices[mesh.indices[3 * t]], b = mesh.vertices[mesh.indices[3 * t + 1]],
                    c = mesh.vertices[mesh.indices[3 * t + 2]];
  const Vec3<double> ab{double(b.x) - a.x, double(b.y) - a.y, double(b.z) - a.z};
  const Vec3<double> ac{double(c.x) - a.x, double(c.y) - a.y, double(c.z) - a.z};
  const Vec3<double> twice_area = cross(ab, ac);
  const Vec3<double> normal = (1.0 / length(twice_area)) * twice_area;
  return {a, b, c, {float(normal.x), float(normal.y), float(normal.z)}};
}

// The triangles in the order of their Morton codes; `keys` receives code and index of each.
std::vector<BvhTriangle> sorted_triangles(const TriangleMesh &mesh, std::vector<std::uint64_t> &keys) {
  const std::size_t count = mesh.indices.size() / 3;
  std::vector<BvhTriangle> unsorted(count);
  Box centres;
  const auto centre = [](const BvhTriangle &t) { return (1.0f / 3.0f) * (t.a + t.b + t.c); };
  for (std::size_t t = 0; t < count; ++t) {
    unsorted[t] = triangle_of(mesh, t);
    centres.include(centre(unsorted[t]));
  }
  // One scale for the three axes: a flat mesh then spends its bits where it extends.
  const Vec3<float> extent = centres.upper - centres.lower;
  const float longest = std::max({extent.x, extent.y, extent.z});
  const float scale = longest > 1e-30f ? 1024.0f / longest : 0.0f;
  keys.resize(count);
  for (std::size_t t = 0; t < count; ++t) {
    const Vec3<float> point = centre(unsorted[t]);
    const std::uint32_t code = spread_bits(quantised(point.x, centres.lower.x, scale)) * 4 +
                               spread_bits(quantised(point.y, centres.lower.y, scale)) * 2 +
                               spread_bits(quantised(point.z, centres.lower.z, scale));
    keys[t] = std::uint64_t(code) << 32 | t;
  }
  std::sort(keys.begin(), keys.end());
  std::vector<BvhTriangle> sorted(count);
  for (std::size_t t = 0; t < count; ++t) sorted[t] = unsorted[keys[t] & 0xFFFFFFFFu];
  return sorted;
}

// The last leaf of the first child of the node over the leaves first..last. Keys are unique.
std::size_t split_of(const std::vector<std::uint64_t> &keys, std::size_t first, std::size_t last) {
  const int bit = 63 - std::countl_zero(keys[first] ^ keys[last]);
  const auto has_bit = [bit](std::uint64_t key) { return (key >> bit & 1u) != 0; };
  std::size_t below = first, above = last; // the bit is clear at `below`, set at `above`
  while (above - below > 1) {
    const std::size_t middle = below + (above - below) / 2;
    (has_bit(keys[middle]) ? above : below) = middle;
  }
  return below;
}

std::vector<BinaryNode> build_binary(const std::vector<std::uint64_t> &keys, const std::vector<BvhTriangle> &triangles) {
  struct Range {
    std::size_t first, last;
    std::uint32_t parent;
    int side;
  };
  const Box empty;
  const BinaryNode blank{{empty.lower, empty.lower}, {empty.upper, empty.upper}, {BinaryNode::leaf, BinaryNode::leaf}};
  std::vector<BinaryNode> nodes;
  if (keys.size() == 1) {
    nodes.push_back(blank);
  } else {
    nodes.reserve(keys.size() - 1);
    std::vector<Range> stack{{0, keys.size() - 1, 0, -1}};
    while (!stack.empty()) {
      const Range range = stack.back();
      stack.pop_back();
      const bool is_leaf = range.first == range.last;
      const std::uint32_t entry = is_leaf ? BinaryNode::leaf | std::uint32_t(range.first) : std::uint32_t(nodes.size());
      if (range.side >= 0) nodes[range.parent].child[range.side] = entry;
      if (is_leaf) continue;
      nodes.push_back(blank);
      const std::size_t split = split_of(keys, range.first, range.last);
      stack.push_back({split + 1, range.last, entry, 1});
      stack.push_back({range.first, split, entry, 0});
    }
  }
  // Children come after their parents, so going backwards each box is known when it is asked for.
  const int children_of_root = keys.size() == 1 ? 1 : 2;
  for (std::size_t n = nodes.size(); n-- > 0;) {
    for (int side = 0; side < (n == 0 ? children_of_root : 2); ++side) {
      const std::uint32_t child = nodes[n].child[side];
      Box box;
      if ((child & BinaryNode::leaf) != 0) {
        const BvhTriangle &t = triangles[child & ~BinaryNode::leaf];
        box.include(t.a);
        box.include(t.b);
        box.include(t.c);
      } else {
        for (int k = 0; k < 2; ++k) box.include(nodes[child].lower[k], nodes[child].upper[k]);
      }
      nodes[n].lower[side] = box.lower;
      nodes[n].upper[side] = box.upper;
    }
  }
  return nodes;
}

// One use of an edge (or, with both ends equal, of a vertex) by a triangle.
struct FeatureUse {
  Vec3<float> ends[2]; // the lesser first
  std::uint32_t triangle;
  std::uint32_t feature;
};

bool less(Vec3<float> a, Vec3<float> b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  return a.z < b.z;
}
bool same(Vec3<float> a, Vec3<float> b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Features are matched by place, not by index, so that repeated vertices do not cut the surface. Answers with a corner (triangle and a, b or c, as one
// number) for each vertex of the ring.
std::vector<std::uint32_t> build_features(BoundingVolumeHierarchy &hierarchy) {
  const std::vector<BvhTriangle> &triangles = hierarchy.triangles;
  std::vector<FeatureUse> uses;
  uses.reserve(triangles.size() * 6);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Vec3<float> v[3] = {triangles[t].a, triangles[t].b, triangles[t].c};
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vec3<float> from = v[k], to = v[(k + 1) % 3];
      uses.push_back(less(from, to) ? FeatureUse{{from, to}, t, k} : FeatureUse{{to, from}, t, k});
      uses.push_back({{from, from}, t, 3 + k});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const FeatureUse &a, const FeatureUse &b) {
    for (int k = 0; k < 2; ++k) {
      if (!same(a.ends[k], b.ends[k])) return less(a.ends[k], b.ends[k]);
    }
    return a.triangle != b.triangle ? a.triangle < b.triangle : a.feature < b.feature;
  });
  // The first triangle of each group owns the feature; the group is found again when that triangle's rings are written.
  const std::size_t none = uses.size();
  std::vector<std::size_t> group(triangles.size() * 6, none);
  const auto same_feature = [&](std::size_t i, std::size_t j) {
    return same(uses[i].ends[0], uses[j].ends[0]) && same(uses[i].ends[1], uses[j].ends[1]);
  };
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i == 0 || !same_feature(i - 1, i)) group[std::size_t(uses[i].triangle) * 6 + uses[i].feature] = i;
  }
  const auto place_of = [&](std::uint32_t corner) {
    const BvhTriangle &t = triangles[corner / 3];
    return corner % 3 == 0 ? t.a : corner % 3 == 1 ? t.b : t.c;
  };
  std::vector<std::uint32_t> ring;
  hierarchy.features.resize(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    BvhFeatures &features = hierarchy.features[t];
    features.owned = 1u << BvhFeatures::inside;
    for (std::uint32_t f = 0; f < 6; ++f) {
      features.first[f] = std::uint32_t(ring.size());
      const std::size_t begin = group[std::size_t(t) * 6 + f];
      if (begin == none) continue;
      features.owned |= 1u << f;
      const std::size_t ring_begin = ring.size();
      for (std::size_t i = begin; i < uses.size() && same_feature(begin, i); ++i) {
        if (uses[i].triangle == t) continue;
        for (std::uint32_t corner = 3 * uses[i].triangle; corner < 3 * uses[i].triangle + 3; ++corner)
          if (!same(place_of(corner), uses[i].ends[0]) && !same(place_of(corner), uses[i].ends[1])) ring.push_back(corner);
      }
      const auto own = ring.begin() + std::ptrdiff_t(ring_begin);
      std::sort(own, ring.end(), [&](std::uint32_t i, std::uint32_t j) {
        return same(place_of(i), place_of(j)) ? i < j : less(place_of(i), place_of(j));
      });
      ring.erase(
          std::unique(own, ring.end(), [&](std::uint32_t i, std::uint32_t j) { return same(place_of(i), place_of(j)); }),
          ring.end());
    }
    features.first[6] = std::uint32_t(ring.size());
  }
  hierarchy.ring.reserve(ring.size());
  for (const std::uint32_t corner : ring) hierarchy.ring.push_back(place_of(corner));
  return ring;
}

// Fills `vertices`. The code and number of each triangle are its key.
void name_vertices(BoundingVolumeHierarchy &hierarchy, const TriangleMesh &mesh, const std::vector<std::uint64_t> &keys,
                   const std::vector<std::uint32_t> &ring) {
  BoundingVolumeHierarchy::Vertices &vertices = hierarchy.vertices;
  vertices.positions = mesh.vertices;
  for (const std::uint64_t key : keys)
    for (std::size_t k = 0; k < 3; ++k) vertices.of_triangles.push_back(mesh.indices[3 * (key & 0xFFFFFFFFu) + k]);
  for (const std::uint32_t corner : ring) vertices.of_ring.push_back(vertices.of_triangles[corner]);

  const std::size_t count = hierarchy.nodes.size();
  std::vector<std::uint32_t> heights(count);
  std::uint32_t highest = 0;
  for (std::size_t n = count; n-- > 0;) { // children come after their parents
    for (const std::uint32_t child : hierarchy.nodes[n].child)
      if ((child & BvhNode::leaf) == 0) heights[n] = std::max(heights[n], heights[child] + 1);
    highest = std::max(highest, heights[n]);
  }
  vertices.levels.push_back(0);
  for (std::uint32_t height = 0; height <= highest; ++height) {
    for (std::uint32_t n = 0; n < count; ++n)
      if (heights[n] == height) vertices.nodes.push_back(n);
    vertices.levels.push_back(std::uint32_t(vertices.nodes.size()));
  }
}

} // namespace

BoundingVolumeHierarchy build_bounding_volume_hierarchy(const TriangleMesh &mesh, bool deforms) {
  try {
    BoundingVolumeHierarchy hierarchy;
    std::vector<std::uint64_t> keys;
    hierarchy.triangles = sorted_triangles(mesh, keys);
    hierarchy.binary = build_binary(keys, hierarchy.triangles);
    build_query_tree(hierarchy);
    const std::vector<std::uint32_t> ring = build_features(hierarchy);
    if (deforms) name_vertices(hierarchy, mesh, keys, ring);
    return hierarchy;
  } catch (const std::bad_alloc &) {
    throw Error(LOAM_ERROR_OUT_OF_MEMORY, format("no memory for the hierarchy of %zu triangles", mesh.indices.size() / 3));
  }
}

} // namespace loam
