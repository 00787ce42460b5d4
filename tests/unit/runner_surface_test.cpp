// The surface around particles of one body, and the motions of colliders.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "inside_test.h"
#include "motion.h"
#include "picture/surface.h"

namespace {

double volume(const runner::Mesh &mesh) {
  double sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    sum += dot(to_double(mesh.vertices[mesh.indices[i]]),
               cross(to_double(mesh.vertices[mesh.indices[i + 1]]), to_double(mesh.vertices[mesh.indices[i + 2]]))) /
           6;
  return sum;
}

std::vector<runner::Vector3> lattice_ball(float radius, float spacing, runner::Vector3 center) {
  std::vector<runner::Vector3> result;
  const int reach = static_cast<int>(radius / spacing);
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const runner::Vector3 offset = {spacing * static_cast<float>(x), spacing * static_cast<float>(y),
                                        spacing * static_cast<float>(z)};
        if (length(offset) <= radius) result.push_back(center + offset);
      }
  return result;
}

TEST(RunnerSurface, IsClosedOutwardAndHoldsTheMatter) {
  const float spacing = 0.1f;
  const std::vector<runner::Vector3> particles = lattice_ball(0.75f, spacing, {3, -2, 1});
  const runner::Mesh mesh = runner::make_surface(particles, spacing);
  EXPECT_TRUE(runner::is_closed(mesh));
  const double matter = static_cast<double>(particles.size()) * spacing * spacing * spacing;
  EXPECT_NEAR(volume(mesh), matter, 0.12 * matter);
}

TEST(RunnerSurface, PartsBodiesThatAreThreeSpacingsApart) {
  const float spacing = 0.1f;
  std::vector<runner::Vector3> particles = lattice_ball(0.5f, spacing, {0, 0, 0});
  const double one = volume(runner::make_surface(particles, spacing));
  for (const runner::Vector3 x : lattice_ball(0.5f, spacing, {1.3f, 0, 0})) particles.push_back(x);
  EXPECT_NEAR(volume(runner::make_surface(particles, spacing)), 2 * one, 0.01 * one) << "no bridge between them";
}

/* A film of particles half a spacing above a sheet: without the sheet its surface reaches through. */
TEST(RunnerSurface, EndsAtASheet) {
  const float spacing = 0.1f;
  std::vector<runner::Vector3> particles;
  for (int x = -5; x <= 5; ++x)
    for (int z = -5; z <= 5; ++z)
      particles.push_back({spacing * static_cast<float>(x), 0.53f * spacing, spacing * static_cast<float>(z)});
  const runner::Barrier floor = [spacing](runner::Vector3 from, runner::Vector3 direction, float limit) {
    const float distance = (0.03f * spacing - from.y) / direction.y;
    return direction.y < 0 && distance < limit ? distance : limit;
  };
  const auto bottom = [&](const runner::Mesh &mesh) {
    float lowest = 1;
    for (const runner::Vector3 x : mesh.vertices) lowest = std::fmin(lowest, x.y);
    return lowest;
  };
  const runner::Mesh whole = runner::make_surface(particles, spacing), cut = runner::make_surface(particles, spacing, floor);
  EXPECT_LT(bottom(whole), -0.08f * spacing);
  EXPECT_GT(bottom(cut), 0.1f * spacing);
  EXPECT_LT(bottom(cut), 0.3f * spacing); // and there it lies
  EXPECT_TRUE(runner::is_closed(cut));
}

TEST(RunnerSurface, LeavesOutWhatIsNotFinite) {
  const float lost = std::numeric_limits<float>::quiet_NaN(), far = std::numeric_limits<float>::infinity();
  EXPECT_EQ(runner::make_surface({{lost, 0, 0}, {0, far, 0}, {1e30f, 0, 0}}, 0.1f).triangle_count(), 0u);
  EXPECT_EQ(runner::make_surface({}, 0.1f).triangle_count(), 0u);
}

TEST(RunnerMotion, RestsBeforeItsStartAndAfterItsStop) {
  const std::vector<runner::Motion> motions = {{1, 2, {3, 0, 0}, {0, 1, 0}, 0}};
  const runner::Pose start{{0, 5, 0}, {0, 0, 0, 1}};
  EXPECT_FLOAT_EQ(runner::pose_at(start, motions, 0.5).position.x, 0);
  EXPECT_FLOAT_EQ(runner::pose_at(start, motions, 1.5).position.x, 1.5f);
  EXPECT_FLOAT_EQ(runner::pose_at(start, motions, 9).position.x, 3);
  EXPECT_FLOAT_EQ(runner::pose_at(start, motions, 9).position.y, 5);
}

TEST(RunnerMotion, SpinsAboutTheWorldsAxisWhateverTheRotationAtTheStart) {
  const double quarter = std::acos(0.0);
  const float half = std::sqrt(0.5f);
  const runner::Pose start{{}, {half, 0, 0, half}}; // y to z
  const std::vector<runner::Motion> motions = {{0, 1, {}, {0, 0, 1}, quarter}};
  // x stays under the first turn and goes to y under the second; y goes to z and stays there.
  const runner::Pose pose = runner::pose_at(start, motions, 1);
  EXPECT_NEAR(runner::rotate(pose.rotation, {1, 0, 0}).y, 1, 1e-6);
  EXPECT_NEAR(runner::rotate(pose.rotation, {0, 1, 0}).z, 1, 1e-6);
}

} // namespace
