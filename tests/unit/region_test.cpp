#include "scene/region.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "scene/error.h"
#include "unit/test_meshes.h"

namespace loam {
namespace {

using test::MeshData;

constexpr double pi = 3.14159265358979;
const loam_region everything{};

loam_region box(float x, float y, float z) {
  loam_region region{};
  region.kind = LOAM_REGION_BOX;
  region.half_extents[0] = x;
  region.half_extents[1] = y;
  region.half_extents[2] = z;
  return region;
}

loam_region sphere(float radius) {
  loam_region region{};
  region.kind = LOAM_REGION_SPHERE;
  region.radius = radius;
  return region;
}

loam_region cylinder(float radius, float half_height) {
  loam_region region = sphere(radius);
  region.kind = LOAM_REGION_CYLINDER;
  region.half_height = half_height;
  return region;
}

loam_region inside_of(const MeshData &mesh) {
  loam_region region{};
  region.kind = LOAM_REGION_MESH;
  region.mesh = mesh.view();
  return region;
}

double volume(const loam_region &region, const loam_region &cut = everything, double inset = 0) {
  return RegionSampler(region, cut, inset).volume();
}

void expect_error(const loam_region &region, loam_status status, const std::string &part) {
  try {
    const Region checked(region, "region");
    ADD_FAILURE() << "accepted, but should say " << part;
  } catch (const Error &error) {
    EXPECT_EQ(error.status(), status);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Region, BadFieldsAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  expect_error(everything, LOAM_ERROR_INVALID_ARGUMENT, "region.kind is 0");
  loam_region bad = box(1, 1, 1);
  bad.kind = 5;
  expect_error(bad, LOAM_ERROR_INVALID_ARGUMENT, "region.kind is 5");
  expect_error(box(1, -2, 1), LOAM_ERROR_INVALID_ARGUMENT, "region.half_extents[1] is -2, must be over 0");
  expect_error(box(1, 1, 0), LOAM_ERROR_INVALID_ARGUMENT, "region.half_extents[2] is 0");
  expect_error(box(inf, 1, 1), LOAM_ERROR_INVALID_ARGUMENT, "region.half_extents[0]");
  expect_error(sphere(nan), LOAM_ERROR_INVALID_ARGUMENT, "region.radius is nan");
  expect_error(cylinder(1, 0), LOAM_ERROR_INVALID_ARGUMENT, "region.half_height is 0");
  bad = sphere(1);
  bad.center[2] = inf;
  expect_error(bad, LOAM_ERROR_INVALID_ARGUMENT, "region.center[2] is inf");
  bad = sphere(1);
  bad.rotation[3] = nan;
  expect_error(bad, LOAM_ERROR_INVALID_ARGUMENT, "region.rotation[3]");
  loam_region no_mesh{};
  no_mesh.kind = LOAM_REGION_MESH;
  expect_error(no_mesh, LOAM_ERROR_INVALID_ARGUMENT, "region.mesh.positions is null");
  MeshData open = test::box_mesh({1, 1, 1});
  open.indices.resize(33);
  expect_error(inside_of(open), LOAM_ERROR_INVALID_MESH, "region.mesh does not close, so it has no inside: 3 open edges");
}

TEST(Region, VolumesOfPrimitivesAreExact) {
  EXPECT_NEAR(volume(box(1, 2, 3)), 48, 1e-9);
  EXPECT_NEAR(volume(sphere(2)), 4.0 / 3 * pi * 8, 1e-9);
  EXPECT_NEAR(volume(cylinder(2, 3)), pi * 4 * 6, 1e-9);
  EXPECT_NEAR(volume(box(1, 2, 3), everything, 0.5), 8 * 0.5 * 1.5 * 2.5, 1e-9);
  EXPECT_NEAR(volume(sphere(2), everything, 0.5), 4.0 / 3 * pi * 3.375, 1e-9);
  EXPECT_NEAR(volume(cylinder(2, 3), everything, 1), pi * 4, 1e-9);
  EXPECT_EQ(volume(sphere(2), everything, 2), 0);
  EXPECT_EQ(volume(box(1, 2, 3), everything, 1.5), 0);
}

TEST(Region, VolumesOfCutsAreCounted) {
  loam_region upper = box(5, 5, 5);
  upper.center[1] = 5;
  EXPECT_NEAR(volume(sphere(1), upper) / (2.0 / 3 * pi), 1, 2e-3);
  // Two unit spheres one apart: pi (4 + 1) (2 - 1)^2 / 12.
  loam_region other = sphere(1);
  other.center[0] = 1;
  EXPECT_NEAR(volume(sphere(1), other) / (5 * pi / 12), 1, 2e-3);
  // A turned cut: the half of a cube below its diagonal plane.
  loam_region tilted = box(5, 5, 5);
  tilted.rotation[2] = std::sin(float(pi) / 8);
  tilted.rotation[3] = std::cos(float(pi) / 8);
  tilted.center[0] = 5 * std::sqrt(0.5f);
  tilted.center[1] = 5 * std::sqrt(0.5f);
  EXPECT_NEAR(volume(box(1, 1, 1), tilted), 4, 0.02);
  loam_region far_away = sphere(1);
  far_away.center[2] = 10;
  EXPECT_EQ(volume(sphere(1), far_away), 0);
  loam_region touching = sphere(1);
  touching.center[2] = 2;
  EXPECT_LT(volume(sphere(1), touching), 1e-3);
}

TEST(Region, MeshesAndTheirCutsAndInsets) {
  const MeshData ball = test::icosphere_mesh(1, 4);
  const double whole = volume(inside_of(ball));
  EXPECT_NEAR(whole / (4.0 / 3 * pi), 1, 5e-3); // chords: a little less
  EXPECT_NEAR(volume(inside_of(ball), everything, 0.25) / (4.0 / 3 * pi * 0.421875), 1, 1e-2);
  loam_region upper = box(5, 5, 5);
  upper.center[1] = 5;
  EXPECT_NEAR(volume(inside_of(ball), upper) / (whole / 2), 1, 3e-3);

  MeshData twice = test::box_mesh({1, 1, 1});
  twice.append(test::box_mesh({1, 1, 1}), {1, 0, 0});
  EXPECT_NEAR(volume(inside_of(twice)), 12, 0.05); // not 16: the overlap is filled once

  MeshData reversed = test::box_mesh({1, 1, 1});
  for (std::size_t i = 0; i < reversed.indices.size(); i += 3) std::swap(reversed.indices[i], reversed.indices[i + 1]);
  EXPECT_NEAR(volume(inside_of(reversed)), 8, 1e-6);
  EXPECT_TRUE(Region(inside_of(reversed), "region").contains({0, 0, 0}, 0));
}

TEST(Region, ContainsAgreesWithGeometryInTheWorld) {
  loam_region region = box(1, 2, 3);
  region.center[0] = 10;
  region.rotation[1] = std::sin(float(pi) / 4); // a quarter turn about y, not normalised
  region.rotation[3] = std::cos(float(pi) / 4);
  for (float &q : region.rotation) q *= 7;
  const Region turned(region, "region");
  const auto contains = [&](double x, double y, double z, double inset) {
    return turned.contains(turned.to_own({x, y, z}), inset);
  };
  EXPECT_TRUE(contains(12.9, 1.9, 0.9, 0)); // the long axis lies along x now
  EXPECT_FALSE(contains(10, 0, 2, 0));
  EXPECT_FALSE(contains(12.9, 1.9, 0.9, 0.2));
  EXPECT_TRUE(contains(12.7, 1.7, 0.7, 0.2));
}

TEST(Region, DepthIsTheDistanceToTheBoundary) {
  const auto depth = [](const loam_region &region, Vec3<double> p) { return Region(region, "region").depth(p); };
  EXPECT_NEAR(depth(box(1, 2, 3), {0.5, 0, 0}), 0.5, 1e-12);
  EXPECT_NEAR(depth(box(1, 2, 3), {4, 6, 0}), -5, 1e-12);
  EXPECT_NEAR(depth(cylinder(1, 2), {0, 1.75, 0.5}), 0.25, 1e-12);
  EXPECT_NEAR(depth(cylinder(1, 2), {0, 6, 4}), -5, 1e-12);
  EXPECT_NEAR(depth(sphere(2), {0, 0, 0.5}), 1.5, 1e-12);
  const MeshData mesh = test::box_mesh({1, 2, 3});
  EXPECT_NEAR(depth(inside_of(mesh), {0.5, 0, 0}), 0.5, 1e-6);
  EXPECT_NEAR(depth(inside_of(mesh), {4, 6, 0}), -5, 1e-6);
}

} // namespace
} // namespace loam
