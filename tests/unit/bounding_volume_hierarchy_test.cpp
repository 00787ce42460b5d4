// The tree against brute force, and the closest point on a triangle against a search in double precision.
#include "scene/bounding_volume_hierarchy.h"

#include <algorithm>
#include <bit>
#include <set>

#include <gtest/gtest.h>

#include "kernels/contact/mesh_query.h"
#include "unit/test_meshes.h"

namespace loam {
namespace {

using test::MeshData;

MeshData random_soup(int triangles, float size, std::uint64_t seed) {
  test::Random random{seed};
  MeshData mesh;
  for (int t = 0; t < triangles; ++t) {
    const auto base = std::uint32_t(mesh.vertices.size());
    const Vec3<float> centre = random.in_box(1);
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(centre + random.in_box(size));
    mesh.triangle(base, base + 1, base + 2);
  }
  return mesh;
}

// Triangles a metre long and down to a hundredth of a millimetre wide.
MeshData slivers(int triangles) {
  test::Random random{11};
  MeshData mesh;
  for (int t = 0; t < triangles; ++t) {
    const auto base = std::uint32_t(mesh.vertices.size());
    const Vec3<float> from = random.in_box(1), along = random.direction();
    mesh.vertices.push_back(from);
    mesh.vertices.push_back(from + along);
    mesh.vertices.push_back(from + random.between(0, 1) * along + (t % 2 == 0 ? 1e-3f : 2e-5f) * random.direction());
    mesh.triangle(base, base + 1, base + 2);
  }
  return mesh;
}

// The distance by ternary search for the closest point (1 - s) (a + t (b - a)) + s c: convex in s and t, slow and plain.
double searched_distance(const BvhTriangle &triangle, Vec3<float> point) {
  const auto widen = [&](Vec3<float> v) {
    return Vec3<double>{double(v.x) - point.x, double(v.y) - point.y, double(v.z) - point.z};
  };
  const Vec3<double> a = widen(triangle.a), b = widen(triangle.b), c = widen(triangle.c);
  const auto along_edge = [&](double s) {
    const Vec3<double> from = a + s * (c - a), way = (1 - s) * (b - a); // a line parallel to ab
    const double whole = dot(way, way);
    const double t = whole > 0 ? std::clamp(-dot(from, way) / whole, 0.0, 1.0) : 0.0;
    return length(from + t * way);
  };
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double third = (high - low) / 3;
    (along_edge(low + third) < along_edge(high - third) ? high : low) =
        along_edge(low + third) < along_edge(high - third) ? high - third : low + third;
  }
  return along_edge(0.5 * (low + high));
}

TEST(ClosestPointOnTriangle, EqualsASearchInDoublePrecision) {
  test::Random random{3};
  int on_feature[7] = {};
  for (const MeshData &data : {random_soup(300, 0.5f, 5), slivers(300)}) {
    const BoundingVolumeHierarchy hierarchy = build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"));
    for (const BvhTriangle &t : hierarchy.triangles) {
      for (int k = 0; k < 10; ++k) {
        const Vec3<float> inside = (1.0f / 3) * (t.a + t.b + t.c);
        const Vec3<float> p = k < 5 ? random.in_box(2) : inside + random.in_box(0.1f);
        const ClosestPoint<float> closest = closest_point_on_triangle(t.a - p, t.b - p, t.c - p, t.normal);
        const double expected = searched_distance(t, p);
        EXPECT_NEAR(std::sqrt(closest.distance_squared), expected, 1e-6 + 1e-6 * expected);
        EXPECT_NEAR(length(closest.point), expected, 1e-6 + 1e-6 * expected);
        ++on_feature[closest.feature];
      }
    }
  }
  for (const int count : on_feature) EXPECT_GT(count, 10);
}

TEST(BoundingVolumeHierarchy, HasEveryTriangleOnceInsideItsBoxes) {
  for (const MeshData &data : {test::box_mesh({1, 1, 1}), test::icosphere_mesh(1, 3), random_soup(1000, 0.1f, 1)}) {
    const TriangleMesh mesh = make_triangle_mesh(data.view(), "mesh");
    const BoundingVolumeHierarchy hierarchy = build_bounding_volume_hierarchy(mesh);
    ASSERT_EQ(hierarchy.triangles.size(), mesh.report.triangles);
    ASSERT_EQ(hierarchy.binary.size(), mesh.report.triangles - 1);
    std::multiset<std::uint32_t> seen;
    for (const BinaryNode &node : hierarchy.binary) {
      for (int side = 0; side < 2; ++side) {
        const std::uint32_t child = node.child[side];
        seen.insert(child);
        const auto inside = [&](Vec3<float> v) {
          const Vec3<float> &lower = node.lower[side], &upper = node.upper[side];
          return lower.x <= v.x && v.x <= upper.x && lower.y <= v.y && v.y <= upper.y && lower.z <= v.z && v.z <= upper.z;
        };
        if ((child & BinaryNode::leaf) != 0) {
          const BvhTriangle &t = hierarchy.triangles[child & ~BinaryNode::leaf];
          EXPECT_TRUE(inside(t.a) && inside(t.b) && inside(t.c));
        } else {
          for (int k = 0; k < 2; ++k)
            EXPECT_TRUE(inside(hierarchy.binary[child].lower[k]) && inside(hierarchy.binary[child].upper[k]));
        }
      }
    }
    EXPECT_EQ(seen.size(), 2 * hierarchy.binary.size());
    for (std::uint32_t t = 0; t < mesh.report.triangles; ++t) EXPECT_EQ(seen.count(BinaryNode::leaf | t), 1u);
    for (std::uint32_t n = 1; n < hierarchy.binary.size(); ++n) EXPECT_EQ(seen.count(n), 1u);
  }
}

// What a box of the query tree has to hold: the children's boxes, or the triangles of a packet. Marks the triangles.
void inspect(const BoundingVolumeHierarchy &hierarchy, std::uint32_t n, std::vector<int> &seen, int depth) {
  ASSERT_LT(depth, 30);
  const BvhNode &node = hierarchy.nodes[n];
  for (int k = 0; k < BvhNode::width; ++k) {
    if (std::isinf(node.half[0][k])) continue; // there is none
    const auto holds = [&](int axis, double lower, double upper) {
      return double(node.centre[axis][k]) - node.half[axis][k] <= lower &&
             upper <= double(node.centre[axis][k]) + node.half[axis][k];
    };
    const std::uint32_t child = node.child[k];
    if ((child & BvhNode::leaf) == 0) {
      EXPECT_GT(child, n);
      inspect(hierarchy, child, seen, depth + 1);
      continue;
    }
    const TrianglePacket &packet = hierarchy.packets[child & ~BvhNode::leaf];
    ASSERT_GE(packet.count, 1u);
    for (std::uint32_t lane = 0; lane < std::uint32_t(TrianglePacket::width); ++lane) {
      const bool repeats = lane >= packet.count;
      const std::uint32_t index = packet.first + (repeats ? 0 : lane);
      seen[index] += repeats ? 0 : 1;
      const BvhTriangle &t = hierarchy.triangles[index];
      const float *of_triangle[4] = {&t.a.x, &t.b.x, &t.c.x, &t.normal.x};
      for (int axis = 0; axis < 3; ++axis) {
        const float of_packet[4] = {packet.a[axis][lane], packet.b[axis][lane], packet.c[axis][lane],
                                    packet.normal[axis][lane]};
        for (int v = 0; v < 4; ++v) EXPECT_EQ(of_packet[v], of_triangle[v][axis]);
        for (int v = 0; v < 3; ++v) EXPECT_TRUE(holds(axis, of_packet[v], of_packet[v]));
      }
    }
  }
}

TEST(BoundingVolumeHierarchy, TheQueryTreeHoldsEveryTriangleOnce) {
  for (const MeshData &data :
       {test::box_mesh({1, 1, 1}), test::icosphere_mesh(1, 3), random_soup(1000, 0.1f, 1), random_soup(1, 1, 2),
        random_soup(3, 1, 2), random_soup(4, 1, 2), random_soup(5, 1, 2), slivers(100)}) {
    const BoundingVolumeHierarchy hierarchy = build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"));
    std::vector<int> seen(hierarchy.triangles.size(), 0);
    inspect(hierarchy, 0, seen, 0);
    for (const int times : seen) EXPECT_EQ(times, 1);
  }
}

TEST(BoundingVolumeHierarchy, WhatAQueryLeavesOutIsNotNearerThanItSays) {
  const BoundingVolumeHierarchy hierarchy =
      build_bounding_volume_hierarchy(make_triangle_mesh(random_soup(2000, 0.05f, 2).view(), "mesh"));
  test::Random random{5};
  double bounds = 0, distances = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3<float> p = random.in_box(1.5f);
    const float distance = distance_to_mesh(hierarchy.nodes.data(), hierarchy.packets.data(), p, 1e15f);
    BallQuery query(hierarchy.nodes.data(), p, 1e30f);
    const float radius = 0.5f * distance;
    float visited = 1e30f;
    for (int i = query.next(radius * radius); i >= 0; i = query.next(radius * radius)) {
      const PacketPoints points = closest_points(hierarchy.packets[std::size_t(i)], p);
      for (const float squared : points.distance_squared) visited = std::min(visited, squared);
    }
    const float bound = std::sqrt(std::min(visited, query.unvisited_squared));
    EXPECT_LE(bound, distance * 1.000001f);
    bounds += bound;
    distances += distance;
  }
  EXPECT_GT(bounds, 0.7 * distances); // and it is worth something
}

TEST(BoundingVolumeHierarchy, DistanceEqualsBruteForce) {
  MeshData stacked; // every triangle at the same place: all codes equal
  for (int i = 0; i < 500; ++i) stacked.append(random_soup(1, 0.5f, 9));
  MeshData one;
  one.append(random_soup(1, 0.5f, 4));
  MeshData in_line; // huge and tiny, far from the origin
  for (int i = 0; i < 200; ++i)
    in_line.append(random_soup(1, i % 10 == 0 ? 3.0f : 0.01f, std::uint64_t(i)), {float(i), 0, 0});
  for (const MeshData &data : {random_soup(2000, 0.05f, 2), slivers(500), stacked, one, in_line, test::floor_mesh(1, 20)}) {
    const BoundingVolumeHierarchy hierarchy = build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"));
    test::Random random{8};
    for (int k = 0; k < 500; ++k) {
      const Vec3<float> p = random.in_box(k % 2 == 0 ? 1.2f : 5.0f);
      float brute = 1e30f;
      for (const BvhTriangle &t : hierarchy.triangles) {
        brute = std::min(brute, closest_point_on_triangle(t.a - p, t.b - p, t.c - p, t.normal).distance_squared);
      }
      const float expected = std::sqrt(brute);
      EXPECT_EQ(distance_to_mesh(hierarchy.nodes.data(), hierarchy.packets.data(), p, 1e15f), expected);
      EXPECT_EQ(distance_to_mesh(hierarchy.nodes.data(), hierarchy.packets.data(), p, 0.3f), std::min(0.3f, expected));
    }
  }
}

TEST(BoundingVolumeHierarchy, BallQueryVisitsFewTriangles) {
  const MeshData data = test::icosphere_mesh(1, 4);
  const BoundingVolumeHierarchy hierarchy = build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"));
  ASSERT_EQ(hierarchy.triangles.size(), 5120u);
  test::Random random{6};
  std::size_t visited = 0; // packets
  for (int k = 0; k < 100; ++k) {
    BallQuery query(hierarchy.nodes.data(), 1.02f * random.direction());
    for (int i = query.next(0.0025f); i >= 0; i = query.next(0.0025f)) ++visited;
  }
  EXPECT_GT(visited, 100 * 1u);
  EXPECT_LT(visited, 100 * 20u);
}

TEST(BoundingVolumeHierarchy, EveryEdgeAndVertexHasOneOwnerWhoKnowsItsRing) {
  const MeshData data = test::icosphere_mesh(1, 2); // 320 triangles, 480 edges, 162 vertices: 12 of valence 5, 150 of 6
  const BoundingVolumeHierarchy hierarchy = build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"));
  int edges = 0, vertices = 0;
  for (const BvhFeatures &features : hierarchy.features) {
    EXPECT_NE(features.owned & 1u << BvhFeatures::inside, 0u);
    for (int f = 0; f < 6; ++f) {
      const std::uint32_t ring = features.first[f + 1] - features.first[f];
      if ((features.owned >> f & 1u) == 0) {
        EXPECT_EQ(ring, 0u);
      } else if (f < 3) {
        ++edges;
        EXPECT_EQ(ring, 1u);
      } else {
        ++vertices;
        EXPECT_TRUE(ring == 5 || ring == 6);
      }
    }
  }
  EXPECT_EQ(edges, 480);
  EXPECT_EQ(vertices, 162);
  EXPECT_EQ(hierarchy.ring.size(), 480u + 12 * 5 + 150 * 6);
}

} // namespace
} // namespace loam
