// What contact queries see of a mesh whose vertices move: triangles and boxes over a substep, and triangles that collapse.
#include <gtest/gtest.h>

#include "cpu/cpu_executor.h"
#include "cpu/kernel_table.h"
#include "kernels/contact/sweep_contacts.h"
#include "solver/collider_motion.h"
#include "solver/deforming_mesh.h"
#include "support/meshes.h"
#include "unit/test_meshes.h"

namespace loam {
namespace {

using test::MeshData;

struct Mesh {
  CpuExecutor executor;
  BoundingVolumeHierarchy hierarchy;
  HostArray<BvhNode> nodes;
  HostArray<TrianglePacket> packets;
  HostArray<Vec3<float>> ring;
  DeformingMesh<CpuExecutor> deforming;

  explicit Mesh(const MeshData &data)
      : executor([] {
          ExecutionSettings settings = {};
          settings.thread_count = 2;
          settings.instruction_set = best_instruction_set();
          return settings;
        }()),
        hierarchy(build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"), true)),
        nodes(executor.array<BvhNode>()), packets(executor.array<TrianglePacket>()), ring(executor.array<Vec3<float>>()),
        deforming(executor, hierarchy) {
    const auto copy_in = [&](auto &array, const auto &values) {
      array.reserve(std::max<std::size_t>(values.size(), 1));
      executor.upload(array.data(), values.data(), values.size());
    };
    copy_in(nodes, hierarchy.nodes);
    copy_in(packets, hierarchy.packets);
    copy_in(ring, hierarchy.ring);
  }
  void place(std::uint32_t index, std::uint32_t substeps) {
    executor.session([&] { deforming.place(index, substeps, {nodes, packets, ring}); });
  }
};

MeshData scaled(MeshData mesh, float by, float noise, std::uint64_t seed) {
  test::Random random{seed};
  for (Vec3<float> &v : mesh.vertices) v = by * v + random.in_box(noise);
  return mesh;
}

// At any moment of a substep a query over the boxes finds whatever triangle is nearest then.
TEST(DeformingMesh, BoxesHoldTheTrianglesAllTheWay) {
  for (const MeshData &data : {test::icosphere_mesh(1, 3), test::floor_mesh(1, 9), test::box_mesh({1, 0.5f, 0.2f})}) {
    Mesh mesh(data);
    const MeshData to = scaled(data, 1.5f, 0.2f, 3);
    mesh.deforming.move(&to.vertices[0].x, false);
    mesh.executor.session([&] { mesh.deforming.begin_step(); });
    ASSERT_TRUE(mesh.deforming.moves());
    test::Random random{9};
    for (std::uint32_t index : {0u, 1u, 2u, 4u}) { // 3 is left out, as when all sleeps
      mesh.place(index, 5);
      const TrianglePacket *ends = mesh.deforming.end_packets();
      ASSERT_NE(ends, nullptr);
      const std::size_t count = mesh.hierarchy.packets.size();
      // Vertices are where their straight ways have them.
      for (std::size_t p = 0; p < count; ++p)
        for (std::uint32_t lane = 0; lane < mesh.packets.data()[p].count; ++lane) {
          const std::size_t corner = 3 * (mesh.packets.data()[p].first + lane);
          const std::uint32_t v = mesh.hierarchy.vertices.of_triangles[corner];
          const Vec3<float> from = data.vertices[v], way = to.vertices[v] - from;
          const Vec3<float> start = lane_of(mesh.packets.data()[p].a, int(lane)), end = lane_of(ends[p].a, int(lane));
          EXPECT_LT(length(start - (from + 0.2f * float(index) * way)), 1e-6f);
          EXPECT_LT(length(end - (from + 0.2f * float(index + 1) * way)), 1e-6f);
          EXPECT_LE(length(end - start), mesh.deforming.motion(5));
        }
      for (int k = 0; k < 100; ++k) {
        const Vec3<float> point = random.in_box(1.5f);
        const float share = random.between(0, 1), radius = random.between(0, 0.3f);
        std::vector<bool> visited(count, false);
        BallQuery query(mesh.nodes.data(), point);
        for (int i = query.next(radius * radius); i >= 0; i = query.next(radius * radius)) visited[std::size_t(i)] = true;
        for (std::size_t p = 0; p < count; ++p)
          for (int lane = 0; lane < TrianglePacket::width; ++lane) {
            const auto at = [&](const float(&start)[3][4], const float(&end)[3][4]) {
              const Vec3<float> from = lane_of(start, lane);
              return from + share * (lane_of(end, lane) - from) - point;
            };
            const TrianglePacket &start = mesh.packets.data()[p];
            const Vec3<float> a = at(start.a, ends[p].a), b = at(start.b, ends[p].b), c = at(start.c, ends[p].c);
            const Vec3<float> area = cross(b - a, c - a);
            const ClosestPoint<float> closest = closest_point_on_triangle(a, b, c, (1 / length(area)) * area);
            EXPECT_TRUE(visited[p] || std::sqrt(closest.distance_squared) > radius - 1e-5f);
          }
      }
    }
    // After the step it is at rest there, and seen as the mesh would be that is made of those vertices.
    mesh.executor.session([&] { mesh.deforming.end_step(1); });
    mesh.executor.session([&] { mesh.deforming.begin_step(); });
    EXPECT_FALSE(mesh.deforming.moves());
    EXPECT_EQ(mesh.deforming.motion(5), 0.0f);
    mesh.place(0, 5);
    EXPECT_EQ(mesh.deforming.end_packets(), nullptr);
    const BoundingVolumeHierarchy fresh = build_bounding_volume_hierarchy(make_triangle_mesh(to.view(), "mesh"));
    for (int k = 0; k < 100; ++k) {
      const Vec3<float> point = random.in_box(2);
      EXPECT_EQ(distance_to_mesh(mesh.nodes.data(), mesh.packets.data(), point, 1e15f),
                distance_to_mesh(fresh.nodes.data(), fresh.packets.data(), point, 1e15f));
    }
    for (std::size_t i = 0; i < mesh.hierarchy.ring.size(); ++i) {
      const Vec3<float> there = mesh.ring.data()[i], expected = to.vertices[mesh.hierarchy.vertices.of_ring[i]];
      EXPECT_EQ(length(there - expected), 0.0f);
    }
  }
}

// Particles in a ball that is crumpled and turned in one substep, without contact planes, as fast as they like: the sweep alone keeps them inside.
TEST(DeformingMesh, NothingGetsThroughTheSweep) {
  const MeshData data = test::icosphere_mesh(1, 2);
  test::Random random{7};
  int escaped = 0, cut = 0;
  for (int round = 0; round < 8; ++round) {
    Mesh mesh(data);
    MeshData to = scaled(data, random.between(0.7f, 1.3f), 0.04f, std::uint64_t(round));
    const float turn = random.between(-0.3f, 0.3f), c = std::cos(turn), s = std::sin(turn);
    for (Vec3<float> &v : to.vertices) v = {c * v.x - s * v.y, s * v.x + c * v.y, 0.8f * v.z};
    mesh.deforming.move(&to.vertices[0].x, false);
    mesh.executor.session([&] { mesh.deforming.begin_step(); });
    mesh.place(0, 1);
    ColliderView collider = {};
    collider.start = {{0.1f, 0, 0}, {0, 0, 0, 1}};
    collider.end = {{0.1f, 0.2f, 0}, {0, 0.6f, 0, 0.8f}};
    collider.shape.kind = LOAM_COLLIDER_MESH;
    collider.shape.mesh = {mesh.nodes.data(), mesh.packets.data(),          mesh.hierarchy.features.data(),
                           mesh.ring.data(),  mesh.deforming.end_packets(), mesh.deforming.motion(1)};
    meshes::Mesh end;
    for (const Vec3<float> &v : to.vertices) end.positions.insert(end.positions.end(), {v.x, v.y, v.z});
    end.indices = data.indices;
    for (int k = 0; k < 250; ++k) {
      const Vec3<float> x = to_world(collider.start, random.between(0, 0.98f) * random.direction());
      const Vec3<float> way = random.between(0, k % 2 == 0 ? 1.5f : 0.1f) * random.direction();
      const Row position = {x.x, x.y, x.z, 1};
      Row velocity = {way.x, way.y, way.z, 1};
      Contact contact = {};
      SweepContactsOf<true>{&contact, &position, &velocity, &collider, 1, 1.0f, 0.01f}(0);
      cut += velocity.x != way.x ? 1 : 0;
      const Vec3<float> there = to_local(collider.end, x + xyz(velocity));
      const double point[3] = {double(there.x), double(there.y), double(there.z)};
      escaped += meshes::winding_number(end, point) < 0.5 ? 1 : 0;
    }
  }
  EXPECT_GT(cut, 500);
  EXPECT_EQ(escaped, 0);
}

// A step that is given up leaves the vertices on their way.
TEST(DeformingMesh, StopsOnItsWay) {
  const MeshData data = test::icosphere_mesh(1, 1), to = scaled(data, 2, 0, 1);
  Mesh mesh(data);
  mesh.deforming.move(&to.vertices[0].x, false);
  mesh.executor.session([&] {
    mesh.deforming.begin_step();
    mesh.deforming.end_step(0.25);
    mesh.deforming.begin_step();
  });
  EXPECT_TRUE(mesh.deforming.moves()); // on to its target in the next
  mesh.place(0, 1);
  EXPECT_NEAR(length(lane_of(mesh.packets.data()[0].a, 0)), 1.25, 1e-5);
  EXPECT_NEAR(length(lane_of(mesh.deforming.end_packets()[0].a, 0)), 2, 1e-5);
  EXPECT_NEAR(mesh.deforming.motion(1), 0.75, 1e-4);
  EXPECT_NEAR(mesh.deforming.extent(), 2, 1e-4);
}

// Lines and points keep their place within a hair, and have a direction.
TEST(DeformingMesh, TrianglesThatCollapseAreOpenedByAHair) {
  test::Random random{5};
  for (int k = 0; k < 1000; ++k) {
    const float size = std::pow(10.0f, random.between(-4, 3));
    const Vec3<float> a = random.in_box(size), way = random.in_box(k % 3 == 0 ? size : 1e-3f * size);
    const Vec3<float> none = {0, 0, 0}, way_here = k % 5 == 0 ? none : way;
    const Vec3<float> before[3] = {a, a + way_here, a + random.between(-1, 2) * way_here};
    Vec3<float> v[3] = {before[0], before[1], before[2]};
    open_if_collapsed(v);
    for (int c = 0; c < 3; ++c) EXPECT_LT(length(v[c] - before[c]), 3e-5f * size);
    const Vec3<double> area = twice_area_of(v);
    EXPECT_GT(std::sqrt(dot(area, area)), 0.0);
    const Vec3<double> normal = (1 / std::sqrt(dot(area, area))) * area;
    const Vec3<float> n = {float(normal.x), float(normal.y), float(normal.z)};
    // Its distance from anywhere is that of the line.
    const Vec3<float> p = a + random.in_box(size);
    const ClosestPoint<float> closest = closest_point_on_triangle(v[0] - p, v[1] - p, v[2] - p, n);
    double expected = 1e30;
    for (int c = 0; c < 3; ++c) {
      const Vec3<float> from = before[c] - p, edge = before[(c + 1) % 3] - before[c];
      const double whole = double(dot(edge, edge));
      const double share = whole > 0 ? std::clamp(-double(dot(from, edge)) / whole, 0.0, 1.0) : 0.0;
      expected = std::min(expected, double(length(from + float(share) * edge)));
    }
    EXPECT_NEAR(std::sqrt(closest.distance_squared), expected, 1e-4 * double(size));
  }
  Vec3<float> whole[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1e-3f, 0}};
  open_if_collapsed(whole);
  EXPECT_EQ(whole[2].y, 1e-3f);
}

TEST(DeformingMesh, AddsToTheMotionOfColliders) {
  ColliderView view = {};
  view.start = view.end = {{0, 0, 0}, {0, 0, 0, 1}};
  ColliderMotion motion;
  motion.include(view, 1, 0.25f);
  EXPECT_EQ(motion.greatest(), 0.25f);
  EXPECT_GE(motion.enough(1), 1.25f);
  view.end.position.x = 1;
  motion.include(view, 1, 0.25f);
  EXPECT_GE(motion.greatest(), 1.25f);
}

} // namespace
} // namespace loam
