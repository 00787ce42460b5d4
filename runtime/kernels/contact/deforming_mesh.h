// A mesh whose vertices move: in each substep its triangles are placed where they are at the start and at the end of it, and the boxes of its hierarchy
// refitted around both. The tree stays as it was made.
#pragma once

#include "kernels/contact/triangle_mesh.h"

namespace loam {

// Straight ways over a step.
struct VertexWays {
  const Row *from, *to;

  LOAM_FN Vec3<float> at(std::uint32_t vertex, float share) const {
    const Vec3<float> a = xyz(from[vertex]), b = xyz(to[vertex]);
    return share >= 1.0f ? b : a + share * (b - a);
  }
};

LOAM_FN Vec3<double> widened(Vec3<float> v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
// Along the normal.
LOAM_FN Vec3<double> twice_area_of(const Vec3<float> (&v)[3]) {
  const Vec3<double> a = widened(v[0]);
  return cross(widened(v[1]) - a, widened(v[2]) - a);
}

// A triangle that has collapsed to a line or a point is opened by a hair, beside its longest edge, so that it has a direction.
LOAM_FN void open_if_collapsed(Vec3<float> (&corners)[3]) {
  int far = 0; // from the longest edge
  float longest = -1.0f, size = 0.0f;
  for (int k = 0; k < 3; ++k) {
    const Vec3<float> v = corners[k], edge = corners[(k + 2) % 3] - corners[(k + 1) % 3];
    size = maximum(size, maximum(absolute(v.x), maximum(absolute(v.y), absolute(v.z))));
    const float squared = dot(edge, edge);
    far = squared > longest ? k : far;
    longest = maximum(longest, squared);
  }
  const Vec3<float> edge = corners[(far + 2) % 3] - corners[(far + 1) % 3];
  const Vec3<double> twice_area = twice_area_of(corners);
  const double bound = 1e-6 * static_cast<double>(longest), hair = 2e-6 * static_cast<double>(size);
  if (dot(twice_area, twice_area) > bound * bound && static_cast<double>(longest) > hair * hair) return;
  const float length_of_edge = square_root(longest), away = 2e-6f * length_of_edge + 1e-6f * size + 1e-20f;
  const float x = absolute(edge.x), y = absolute(edge.y), z = absolute(edge.z);
  Vec3<float> across = x <= y && x <= z ? Vec3<float>{0.0f, edge.z, 0.0f - edge.y}
                       : y <= z         ? Vec3<float>{0.0f - edge.z, 0.0f, edge.x}
                                        : Vec3<float>{edge.y, 0.0f - edge.x, 0.0f};
  if (!(length_of_edge > 8.0f * away)) { // a point
    corners[(far + 2) % 3] = corners[(far + 1) % 3] + Vec3<float>{8.0f * away, 0.0f, 0.0f};
    across = {0.0f, 1.0f, 0.0f};
  }
  corners[far] = corners[far] + (away / length(across)) * across;
}

// The triangles of a packet, at a share of the step. Normals are worked out in double precision, as in BvhTriangle.
struct PlaceTriangles {
  VertexWays ways;
  const std::uint32_t *vertices; // three a triangle
  float share;
  TrianglePacket *packets; // `first` and `count` are theirs already

  LOAM_FN void operator()(int i) const {
    TrianglePacket &packet = packets[i];
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(TrianglePacket::width); ++k) {
      const std::uint32_t *t = vertices + 3 * static_cast<std::size_t>(packet.first + (k < packet.count ? k : 0));
      Vec3<float> corners[3] = {ways.at(t[0], share), ways.at(t[1], share), ways.at(t[2], share)};
      open_if_collapsed(corners);
      set(packet.a, k, corners[0]);
      set(packet.b, k, corners[1]);
      set(packet.c, k, corners[2]);
      set(packet.normal, k, normal_of(corners));
    }
  }

private:
  LOAM_FN static void set(float (&lanes)[3][TrianglePacket::width], std::uint32_t k, Vec3<float> v) {
    lanes[0][k] = v.x;
    lanes[1][k] = v.y;
    lanes[2][k] = v.z;
  }
  LOAM_FN static Vec3<float> normal_of(const Vec3<float> (&v)[3]) {
    const Vec3<double> twice_area = twice_area_of(v);
    const double scale = 1.0 / square_root(dot(twice_area, twice_area));
    return {static_cast<float>(scale * twice_area.x), static_cast<float>(scale * twice_area.y),
            static_cast<float>(scale * twice_area.z)};
  }
};

// The far vertices that say where the surface goes on, see BvhFeatures.
struct PlaceRing {
  VertexWays ways;
  const std::uint32_t *vertices;
  float share;
  Vec3<float> *ring;
  LOAM_FN void operator()(int i) const { ring[i] = ways.at(vertices[i], share); }
};

// The boxes of nodes whose children that are nodes have theirs.
struct RefitNodes {
  BvhNode *nodes;
  const TrianglePacket *packets, *end_packets;
  const std::uint32_t *order; // of nodes

  LOAM_FN void operator()(int i) const {
    BvhNode &node = nodes[order[i]];
    for (int k = 0; k < BvhNode::width; ++k) {
      if (!(node.half[0][k] >= 0.0f)) continue; // no child
      const std::uint32_t entry = node.child[k];
      for (int axis = 0; axis < 3; ++axis) {
        Range range = {1e30f, -1e30f};
        if ((entry & BvhNode::leaf) != 0) {
          include(packets[entry & ~BvhNode::leaf], axis, range);
          include(end_packets[entry & ~BvhNode::leaf], axis, range);
        } else {
          include(nodes[entry], axis, range);
        }
        const float centre = 0.5f * range.lower + 0.5f * range.upper;
        const float half = maximum(range.upper - centre, centre - range.lower);
        node.centre[axis][k] = centre;
        node.half[axis][k] = half + 2.4e-7f * (half + absolute(centre)); // whatever is rounded
      }
    }
  }

private:
  struct Range {
    float lower, upper;
  };
  LOAM_FN static void include(const TrianglePacket &packet, int axis, Range &range) {
    for (int k = 0; k < TrianglePacket::width; ++k) {
      const float a = packet.a[axis][k], b = packet.b[axis][k], c = packet.c[axis][k];
      range.lower = minimum(range.lower, minimum(a, minimum(b, c)));
      range.upper = maximum(range.upper, maximum(a, maximum(b, c)));
    }
  }
  LOAM_FN static void include(const BvhNode &node, int axis, Range &range) {
    for (int k = 0; k < BvhNode::width; ++k) {
      if (!(node.half[0][k] >= 0.0f)) continue;
      range.lower = minimum(range.lower, node.centre[axis][k] - node.half[axis][k]);
      range.upper = maximum(range.upper, node.centre[axis][k] + node.half[axis][k]);
    }
  }
};

// The longest way of a vertex in the step, and the greatest distance from the origin on it.
struct MeasureWays {
  struct Value {
    float way, extent;
  };
  VertexWays ways;
  LOAM_FN static Value identity() { return {0.0f, 0.0f}; }
  LOAM_FN Value operator()(int i) const {
    const Vec3<float> from = xyz(ways.from[i]), to = xyz(ways.to[i]);
    return {length(to - from), maximum(length(from), length(to))};
  }
  LOAM_FN static Value combine(Value a, Value b) { return {maximum(a.way, b.way), maximum(a.extent, b.extent)}; }
};

// Where a step ends early.
struct StopVertices {
  Row *from;
  const Row *to;
  float share;
  LOAM_FN void operator()(int i) const {
    const Vec3<float> v = VertexWays{from, to}.at(static_cast<std::uint32_t>(i), share);
    from[i] = {v.x, v.y, v.z, 0.0f};
  }
};

} // namespace loam
