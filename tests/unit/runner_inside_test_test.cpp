// The inside test against shapes whose inside is known, and against the plain sum over all triangles.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "inside_test.h"
#include "obj_reader.h"

namespace {

using runner::Vector3d;

runner::Mesh make_cube(float half) {
  runner::Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.push_back({i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half});
  mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return mesh;
}

// A sphere of rings and segments, outward.
runner::Mesh make_sphere(float radius, unsigned rings, unsigned segments) {
  runner::Mesh mesh;
  const float pi = std::numbers::pi_v<float>;
  mesh.vertices.push_back({0, -radius, 0});
  for (unsigned r = 1; r < rings; ++r)
    for (unsigned s = 0; s < segments; ++s) {
      const float polar = pi * static_cast<float>(r) / static_cast<float>(rings);
      const float turn = 2 * pi * static_cast<float>(s) / static_cast<float>(segments);
      mesh.vertices.push_back(
          {radius * std::sin(polar) * std::cos(turn), -radius * std::cos(polar), radius * std::sin(polar) * std::sin(turn)});
    }
  mesh.vertices.push_back({0, radius, 0});
  const auto at = [&](unsigned r, unsigned s) { return 1 + (r - 1) * segments + s % segments; };
  const auto top = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (unsigned s = 0; s < segments; ++s) {
    mesh.indices.insert(mesh.indices.end(), {0, at(1, s), at(1, s + 1)});
    for (unsigned r = 1; r + 1 < rings; ++r)
      mesh.indices.insert(mesh.indices.end(),
                          {at(r, s), at(r + 1, s), at(r, s + 1), at(r, s + 1), at(r + 1, s), at(r + 1, s + 1)});
    mesh.indices.insert(mesh.indices.end(), {top, at(rings - 1, s + 1), at(rings - 1, s)});
  }
  return mesh;
}

std::vector<Vector3d> random_points(double half, int count) {
  std::mt19937 random(7);
  const auto coordinate = [&] { return half * (2 * static_cast<double>(random()) / 4294967296.0 - 1); };
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    points.push_back({x, y, z});
  }
  return points;
}

TEST(RunnerInsideTest, KnowsTheInsideOfACube) {
  const runner::Mesh cube = make_cube(0.5f);
  ASSERT_TRUE(runner::is_closed(cube));
  const runner::InsideTest test(cube, {0, 0, 0}, {0, 0, 0, 1});
  for (const Vector3d point : random_points(1.0, 5000)) {
    const bool expected = std::fabs(point.x) < 0.5 && std::fabs(point.y) < 0.5 && std::fabs(point.z) < 0.5;
    EXPECT_EQ(test.inside(point), expected) << point.x << " " << point.y << " " << point.z;
  }
  EXPECT_FALSE(test.inside({std::nan(""), 0, 0}));
  EXPECT_FALSE(test.inside({1e30, 0, 0}));
}

TEST(RunnerInsideTest, MovesWithTheCollider) {
  const float half_turn = std::sqrt(0.5f); // a quarter turn about z
  runner::Mesh slab = make_cube(0.5f);
  for (runner::Vector3 &vertex : slab.vertices) vertex.x *= 4;
  const runner::InsideTest test(slab, {10, 0, 0}, {0, 0, half_turn, half_turn});
  EXPECT_TRUE(test.inside({10, 1.9, 0}));
  EXPECT_FALSE(test.inside({11.9, 0, 0}));
}

TEST(RunnerInsideTest, AgreesWithTheSumOverAllTriangles) {
  const runner::Mesh sphere = make_sphere(1.0f, 40, 50);
  ASSERT_TRUE(runner::is_closed(sphere));
  const runner::InsideTest test(sphere, {0, 0, 0}, {0, 0, 0, 1});
  for (const Vector3d point : random_points(1.1, 500)) {
    const double all = runner::winding_number_of_all_triangles(sphere, point);
    EXPECT_NEAR(test.winding_number(point), all, 1e-9);
    EXPECT_EQ(test.inside(point), all > 0.5);
    EXPECT_EQ(test.inside(point), all > 0.5) << "and again, now that the cell may be known";
  }
}

TEST(RunnerInsideTest, KnowsTheHourglass) {
  const runner::Mesh glass = runner::read_obj(LOAM_SOURCE_DIR "/samples/scenes/hourglass/hourglass.obj");
  ASSERT_TRUE(runner::is_closed(glass));
  const runner::InsideTest test(glass, {0, 0, 0}, {0, 0, 0, 1});
  EXPECT_TRUE(test.inside({0, 0, 0}));
  EXPECT_TRUE(test.inside({0.016, 0, 0}));
  EXPECT_FALSE(test.inside({0.0185, 0, 0}));
  EXPECT_TRUE(test.inside({0.1, 0.16, 0}));
  EXPECT_TRUE(test.inside({0, -0.2, 0}));
  EXPECT_FALSE(test.inside({0.05, 0.03, 0}));
}

TEST(RunnerInsideTest, TellsOpenFromClosed) {
  runner::Mesh mesh = make_cube(1);
  EXPECT_TRUE(runner::is_closed(mesh));
  std::swap(mesh.indices[0], mesh.indices[1]);
  EXPECT_FALSE(runner::is_closed(mesh)) << "one triangle is turned over";
  std::swap(mesh.indices[0], mesh.indices[1]);
  mesh.indices.resize(mesh.indices.size() - 3);
  EXPECT_FALSE(runner::is_closed(mesh)) << "one triangle is missing";
}

} // namespace
