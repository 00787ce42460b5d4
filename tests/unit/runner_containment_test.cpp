// Which side of a collider particles are on, and meshes as distances.
#include <cmath>

#include <gtest/gtest.h>

#include "collider_meshes.h"
#include "containment.h"
#include "inside_test.h"

namespace {

using runner::Vector3;
using runner::Vector3d;

TEST(RunnerColliderMeshes, AreClosedAndFaceOutward) {
  for (const runner::Mesh &mesh : {runner::make_box({1, 2, 3}), runner::make_capsule(1, 0), runner::make_capsule(1, 2)}) {
    ASSERT_TRUE(runner::is_closed(mesh));
    EXPECT_NEAR(runner::winding_number_of_all_triangles(mesh, {0.1, 0.2, 0.3}), 1, 1e-9);
  }
  for (const Vector3 vertex : runner::make_capsule(1, 2).vertices) {
    const float along = std::fmax(-2.0f, std::fmin(2.0f, vertex.y));
    EXPECT_NEAR(std::hypot(vertex.x, vertex.y - along, vertex.z), 1, 1e-6);
  }
}

TEST(RunnerDistanceField, IsTheDistanceWithinItsBand) {
  const runner::Mesh box = runner::make_box({0.1f, 0.2f, 0.3f});
  const runner::DistanceField field = runner::make_distance_field(box, 0.02f, 0.06f);
  const auto exact = [](Vector3d p) {
    const Vector3d q = {std::abs(p.x) - 0.1, std::abs(p.y) - 0.2, std::abs(p.z) - 0.3};
    const double out = std::hypot(std::fmax(q.x, 0), std::fmax(q.y, 0), std::fmax(q.z, 0));
    return out > 0 ? out : std::fmax(q.x, std::fmax(q.y, q.z));
  };
  std::size_t i = 0;
  for (std::uint32_t z = 0; z < field.size[2]; ++z)
    for (std::uint32_t y = 0; y < field.size[1]; ++y)
      for (std::uint32_t x = 0; x < field.size[0]; ++x, ++i) {
        const Vector3d p = {field.origin.x + 0.02 * x, field.origin.y + 0.02 * y, field.origin.z + 0.02 * z};
        EXPECT_NEAR(double(field.values[i]), std::fmax(-0.06, std::fmin(0.06, exact(p))), 1e-6);
      }
  EXPECT_EQ(field.values.size(), i);
  EXPECT_NEAR(field.at({0.013, 0.191, -0.017}), -0.009, 1e-6);
  EXPECT_GT(field.at({0, 5, 0}), 1);
}

runner::Particles at(const std::vector<Vector3> &positions) {
  runner::Particles particles;
  particles.positions = positions;
  for (std::size_t i = 0; i < positions.size(); ++i) particles.ids.push_back(static_cast<std::uint32_t>(i));
  return particles;
}

TEST(RunnerContainment, CountsWhoIsOnTheWrongSide) {
  for (const std::uint32_t kind : {LOAM_COLLIDER_PLANE, LOAM_COLLIDER_MESH, LOAM_COLLIDER_SPHERE, LOAM_COLLIDER_CAPSULE,
                                   LOAM_COLLIDER_BOX, LOAM_COLLIDER_HULL, LOAM_COLLIDER_GRID}) {
    runner::Scene scene;
    scene.meshes.emplace("box", runner::make_box({0.1f, 0.1f, 0.1f}));
    runner::SceneCollider collider;
    collider.kind = kind;
    collider.file = "box";
    collider.radius = 0.1f;
    collider.half_height = 0.01f;
    collider.half_extents = {0.1f, 0.1f, 0.1f};
    collider.field = runner::make_distance_field(scene.meshes.at("box"), 0.02f, 0.1f);
    collider.pose.position.y = 1;
    if (kind != LOAM_COLLIDER_PLANE)
      collider.motions.push_back({.start = 0, .stop = 1, .velocity = {2, 0, 0}, .spin_axis = {0, 1, 0}, .spin = 1});
    scene.colliders.push_back(collider);
    // One that starts inside, one that starts outside, one far away.
    const runner::Containment containment(scene, at({{0, 0.98f, 0}, {0, 1.2f, 0}, {0, 9, 0}}));
    EXPECT_EQ(containment.sides(), 1u);
    EXPECT_EQ(containment.count_outside(at({{2, 0.98f, 0}, {2, 1.2f, 0}, {2, 9, 0}}), 1), 0u) << "kind " << kind;
    // One goes in; and with a mesh it is as wrong that one comes out.
    EXPECT_EQ(containment.count_outside(at({{2, 0.98f, 0}, {2, 0.96f, 0}, {2, 9, 0}}), 1), 1u) << "kind " << kind;
    EXPECT_EQ(containment.count_outside(at({{2, 1.3f, 0}, {2, 1.2f, 0}, {2, 9, 0}}), 1),
              kind == LOAM_COLLIDER_MESH ? 1u : 0u)
        << "kind " << kind;
  }
}

// A ball of radius 1 that is squashed, twisted and moved in a wave, at a quarter of the period where all is greatest.
TEST(RunnerDeformation, SquashesTwistsAndWaves) {
  const runner::Mesh ball = runner::make_capsule(1, 0);
  using Kind = runner::Deformation::Kind;
  const auto at = [&](runner::Deformation how, double time) { return runner::deformed(ball, {how}, time).vertices; };
  const runner::Deformation squash = {.kind = Kind::squash, .axis = {0, 1, 0}, .amplitude = 0.5f, .period = 2, .start = 1};
  const runner::Deformation twist = {.kind = Kind::twist, .axis = {0, 1, 0}, .amplitude = 90, .period = 2};
  const runner::Deformation wave = {
      .kind = Kind::wave, .axis = {0, 1, 0}, .amplitude = 0.1f, .period = 2, .direction = {1, 0, 0}, .wavelength = 4};
  const std::vector<Vector3> before = at(squash, 0.9), squashed = at(squash, 1.5), twisted = at(twist, 0.5),
                             waved = at(wave, 0.5);
  for (std::size_t i = 0; i < ball.vertices.size(); ++i) {
    const Vector3 p = ball.vertices[i];
    EXPECT_EQ(before[i].x, p.x);
    EXPECT_NEAR(squashed[i].y, 0.5f * p.y, 1e-6);
    EXPECT_NEAR(squashed[i].z, std::sqrt(2.0f) * p.z, 1e-6);
    EXPECT_NEAR(twisted[i].y, p.y, 1e-6);
    EXPECT_NEAR(std::hypot(twisted[i].x, twisted[i].z), std::hypot(p.x, p.z), 1e-6);
    EXPECT_NEAR(twisted[i].x, std::cos(1.5707963f * p.y) * p.x + std::sin(1.5707963f * p.y) * p.z, 1e-6);
    EXPECT_NEAR(waved[i].y, p.y + 0.1f * std::cos(1.5707963f * p.x), 1e-6); // sin(90 degrees - x / 4 of a turn)
    EXPECT_EQ(waved[i].x, p.x);
  }
}

TEST(RunnerContainment, KnowsHowAMeshIsDeformed) {
  runner::Scene scene;
  scene.meshes.emplace("ball", runner::make_capsule(0.1f, 0));
  runner::SceneCollider collider;
  collider.kind = LOAM_COLLIDER_MESH;
  collider.file = "ball";
  collider.deformations.push_back({.axis = {0, 1, 0}, .amplitude = 0.5f, .period = 4});
  scene.colliders.push_back(collider);
  // Above the middle, beside it, and outside.
  const std::vector<Vector3> start = {{0, 0.08f, 0}, {0.08f, 0, 0}, {0.12f, 0, 0}};
  const runner::Containment containment(scene, at(start));
  EXPECT_EQ(containment.count_outside(at(start), 0), 0u);
  EXPECT_EQ(containment.count_outside(at(start), 1), 2u); // half as high, 1.4 times as wide
  EXPECT_EQ(containment.count_outside(at({{0, 0.04f, 0}, {0.08f, 0, 0}, {0.15f, 0, 0}}), 1), 0u);
  EXPECT_EQ(containment.count_outside(at({{0, 0.12f, 0}, {0.09f, 0, 0}, {0.12f, 0, 0}}), 3),
            1u); // half as high again, and narrower
}

} // namespace
