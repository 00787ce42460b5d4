// Solid shapes: distances and normals against double precision, and that nothing gets into any of them, at rest or moving.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "scene/collider_shape.h"
#include "scene/winding_number.h"
#include "solver/collider_shapes.h"
#include "unit/contact_scene.h"

namespace loam {
namespace {

using test::ContactScene;
using test::MeshData;
using test::turn;

using Distance = std::function<double(Vec3<double>)>; // signed

Vec3<double> widen(Vec3<float> v) { return {v.x, v.y, v.z}; }

// As the host gives it, through the checks of the scene.
Shape checked(loam_collider_def def, ColliderShape &keep) {
  def.struct_size = sizeof def;
  loam_collider_report report{};
  keep = make_collider_shape(def, report);
  Shape shape{};
  shape.kind = def.kind;
  if (const auto *sphere = std::get_if<SphereShape>(&keep)) shape.sphere = *sphere;
  if (const auto *capsule = std::get_if<CapsuleShape>(&keep)) shape.capsule = *capsule;
  if (const auto *box = std::get_if<BoxShape>(&keep)) shape.box = *box;
  if (const auto *hull = std::get_if<ConvexHull>(&keep)) {
    float size = 0;
    for (const HullFace &face : hull->faces) size = std::max({size, length(face.a), length(face.b), length(face.c)});
    shape.hull = {hull->faces.data(), int(hull->faces.size()), size};
  }
  if (const auto *grid = std::get_if<DistanceGrid>(&keep)) {
    shape.grid = grid->shape;
    shape.grid.values = grid->values.data();
  }
  return shape;
}

struct Solid {
  std::string name;
  ColliderShape keep;
  Shape shape{};
  Distance exact;
  double tolerance = 1e-6;  // of a distance
  double outside_least = 1; // the least share of the exact distance that is answered, far away
};

// Signed distance to a closed mesh, by the winding number and the nearest triangle: none of it is used by the shapes.
Distance distance_to(const MeshData &mesh) {
  const auto winding = std::make_shared<WindingNumber>(make_triangle_mesh(mesh.view(), "mesh"));
  return [winding](Vec3<double> p) {
    const double distance = winding->distance({float(p.x), float(p.y), float(p.z)}, 100);
    return winding->exactly_at(p) > 0.5 ? -distance : distance;
  };
}

MeshData stretched_ball(Vec3<float> scale, int subdivisions) {
  MeshData mesh = test::icosphere_mesh(1, subdivisions);
  for (Vec3<float> &v : mesh.vertices) v = {scale.x * v.x, scale.y * v.y, scale.z * v.z};
  return mesh;
}

Solid make_sphere() {
  Solid solid;
  solid.name = "sphere";
  loam_collider_def def{};
  def.kind = LOAM_COLLIDER_SPHERE;
  def.radius = 0.05f;
  solid.shape = checked(def, solid.keep);
  solid.exact = [](Vec3<double> p) { return length(p) - double(0.05f); };
  return solid;
}
Solid make_capsule() {
  Solid solid;
  solid.name = "capsule";
  loam_collider_def def{};
  def.kind = LOAM_COLLIDER_CAPSULE;
  def.radius = 0.03f;
  def.half_height = 0.04f;
  solid.shape = checked(def, solid.keep);
  solid.exact = [](Vec3<double> p) {
    double nearest = 1e30; // a brute force over the segment
    for (int k = 0; k <= 4000; ++k) nearest = std::min(nearest, std::hypot(p.x, p.y - 0.04 * (k / 2000.0 - 1), p.z));
    return nearest - 0.03;
  };
  solid.tolerance = 1e-5;
  return solid;
}
Solid make_box() {
  Solid solid;
  solid.name = "box";
  loam_collider_def def{};
  def.kind = LOAM_COLLIDER_BOX;
  def.half_extents[0] = 0.05f;
  def.half_extents[1] = 0.02f;
  def.half_extents[2] = 0.04f;
  solid.shape = checked(def, solid.keep);
  solid.exact = distance_to(test::box_mesh({0.05f, 0.02f, 0.04f}));
  return solid;
}
Solid make_hull(const std::string &name, const MeshData &mesh) {
  Solid solid;
  solid.name = name;
  loam_collider_def def{};
  def.kind = LOAM_COLLIDER_HULL;
  def.mesh = mesh.view();
  solid.shape = checked(def, solid.keep);
  solid.exact = distance_to(mesh);
  return solid;
}
MeshData wedge() { // as sharp as a blade
  MeshData mesh;
  mesh.vertices = {{-0.05f, 0, -0.04f},    {-0.05f, 0, 0.04f},       {0.05f, 0.003f, -0.04f},
                   {0.05f, 0.003f, 0.04f}, {0.05f, -0.003f, -0.04f}, {0.05f, -0.003f, 0.04f}};
  for (const std::array<std::uint32_t, 3> &t : std::initializer_list<std::array<std::uint32_t, 3>>{
           {0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}, {2, 3, 5}, {2, 5, 4}, {0, 2, 4}, {1, 5, 3}})
    mesh.triangle(t[0], t[1], t[2]);
  return mesh;
}
Solid make_grid(const std::string &name, const Distance &exact, double half, int points) {
  Solid solid;
  solid.name = name;
  std::vector<float> values;
  const double spacing = 2 * half / (points - 1);
  for (int z = 0; z < points; ++z)
    for (int y = 0; y < points; ++y)
      for (int x = 0; x < points; ++x)
        values.push_back(float(exact({x * spacing - half, y * spacing - half, z * spacing - half})));
  loam_collider_def def{};
  def.kind = LOAM_COLLIDER_GRID;
  def.grid.values = values.data();
  for (int axis = 0; axis < 3; ++axis) {
    def.grid.origin[axis] = float(-half);
    def.grid.size[axis] = std::uint32_t(points);
  }
  def.grid.spacing = float(spacing);
  solid.shape = checked(def, solid.keep);
  solid.exact = exact;
  solid.tolerance = 0.15 * spacing;
  solid.outside_least = 0.5;
  return solid;
}
double torus(Vec3<double> p) { return std::hypot(std::hypot(p.x, p.z) - 0.05, p.y) - 0.02; }
// A thick cup, open at the top, 8 cm wide inside.
double cup(Vec3<double> p) {
  const double aside = std::hypot(p.x, p.z);
  const double outer = std::max(aside - 0.05, std::abs(p.y) - 0.05), inner = std::max(aside - 0.04, -0.04 - p.y);
  return std::max(outer, -inner);
}

std::vector<Solid> all_solids() {
  std::vector<Solid> solids;
  solids.push_back(make_sphere());
  solids.push_back(make_capsule());
  solids.push_back(make_box());
  solids.push_back(make_hull("pebble", stretched_ball({0.06f, 0.03f, 0.045f}, 1)));
  solids.push_back(make_hull("wedge", wedge()));
  solids.push_back(make_grid("torus", torus, 0.08, 41));
  return solids;
}

TEST(Shapes, DistancesAndNormalsAreThoseOfDoublePrecision) {
  for (const Solid &solid : all_solids()) {
    test::Random random{11};
    double worst = 0, worst_foot = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3<float> point = random.in_box(0.078f);
      const double exact = solid.exact(widen(point));
      const Surface surface = surface_of(solid.shape, point, 1);
      EXPECT_NEAR(length(surface.normal), 1, 1e-5) << solid.name;
      if (solid.name == "torus" && std::hypot(std::hypot(point.x, point.z) - 0.05, point.y) < 0.006) continue; // its core
      if (solid.name == "torus" && std::hypot(point.x, point.z) < 0.006) continue;                             // its axis
      worst = std::max(worst, std::abs(double(surface.distance) - exact));
      worst_foot = std::max(worst_foot, std::abs(solid.exact(widen(point - surface.distance * surface.normal))));
    }
    EXPECT_LT(worst, solid.tolerance) << solid.name;
    EXPECT_LT(worst_foot, 2 * solid.tolerance) << solid.name;
    // Far away no distance is too long: free distances and the sweep rely on it.
    for (int i = 0; i < 2000; ++i) {
      const Vec3<float> point = random.between(0.05f, 1) * random.direction();
      const double exact = solid.exact(widen(point));
      const double certain = certain_distance(solid.shape, surface_of(solid.shape, point, 0.02f));
      if (exact <= 0) continue;
      EXPECT_LE(certain, exact + solid.tolerance) << solid.name;
      if (exact > 0.02) { // beyond the limit any bound over it will do
        EXPECT_GT(certain, solid.outside_least * 0.02) << solid.name;
      }
    }
  }
}

TEST(Shapes, AThinWedgeKeepsNobodyFartherOffThanItsStandOff) {
  const Solid solid = make_hull("wedge", wedge());
  const Surface tip = surface_of(solid.shape, {-0.06f, 0, 0}, 1); // planes alone would say 0.0003
  EXPECT_NEAR(tip.distance, 0.01, 1e-6);
  EXPECT_NEAR(tip.normal.x, -1, 1e-5);
}

// Shot at from all around at r a substep, and pressed on for as long: nothing is ever inside.
TEST(Shapes, NothingGetsIntoASolid) {
  for (const Solid &solid : all_solids())
    for (const bool solve : {true, false})
      for (const bool moving : {false, true}) {
        ContactScene scene;
        scene.solve = solve;
        scene.gravity = {0, 0, 0};
        Pose pose{{0, 0, 0}, {0, 0, 0, 1}};
        const int collider = scene.add_shape(solid.shape, 0.3f, pose);
        test::Random random{5};
        for (int i = 0; i < 60; ++i) scene.add(random.between(0.1f, 0.13f) * random.direction());
        Vec3<float> velocity{}, spin{1, 0, 0};
        int touched = 0;
        double deepest = 1;
        for (int s = 0; s < 200; ++s) {
          for (std::size_t i = 0; i < scene.positions.size(); ++i) { // at the solid's middle, and a little past it
            const Vec3<float> to = (pose.position - scene.x(i)) + random.in_box(0.03f);
            const Vec3<float> v = (scene.radius / scene.substep / std::max(1e-6f, length(to))) * to;
            scene.velocities[i] = {v.x, v.y, v.z, 1000.0f};
          }
          if (s % 40 == 0) {
            velocity = moving ? random.between(0, 0.005f) * random.direction() : Vec3<float>{};
            spin = (moving ? random.between(0.001f, 0.1f) : 0.0f) * random.direction();
          }
          pose.position = pose.position + velocity;
          if (moving) {
            pose.rotation = multiply(turn(spin, length(spin)), pose.rotation);
            const Vec4<float> q = pose.rotation;
            const float norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
            pose.rotation = {q.x / norm, q.y / norm, q.z / norm, q.w / norm};
          }
          scene.move(collider, pose);
          scene.step();
          touched += scene.contact_count;
          for (std::size_t i = 0; i < scene.positions.size() && s % 4 == 0; ++i)
            deepest = std::min(deepest, solid.exact(widen(to_local(pose, scene.x(i)))));
        }
        EXPECT_GT(deepest, solid.name == "torus" ? -0.0002 : 0.9 * double(scene.margin()))
            << solid.name << (solve ? "" : ", by the sweep alone") << (moving ? ", moving" : "");
        EXPECT_GT(touched, 1500) << solid.name;
      }
}

TEST(Shapes, WhatIsInsideASolidComesOutSlowly) {
  for (const Solid &solid : all_solids()) {
    ContactScene scene;
    scene.gravity = {0, 0, 0};
    scene.add_shape(solid.shape, 0.3f);
    test::Random random{8};
    std::vector<double> before;
    while (scene.positions.size() < 200) {
      const Vec3<float> x = random.in_box(0.08f);
      if (solid.exact(widen(x)) < -1e-3) scene.add(x);
    }
    for (std::size_t i = 0; i < 200; ++i) before.push_back(solid.exact(widen(scene.x(i))));
    for (int s = 0; s < 4000; ++s) { // 2 s; a stand-off takes 0.05 s
      scene.step();
      for (std::size_t i = 0; i < 200; ++i) EXPECT_LE(length(scene.v(i)), 0.11f) << solid.name; // the stand-off in that time
    }
    for (std::size_t i = 0; i < 200; ++i)
      EXPECT_GT(solid.exact(widen(scene.x(i))), 0.9 * double(scene.stand_off())) << solid.name << " " << before[i];
  }
}

TEST(Shapes, AGridMayHaveCornersOnTheInside) {
  const Solid solid = make_grid("cup", cup, 0.055, 56); // 2 mm
  ContactScene scene;
  scene.add_shape(solid.shape, 0.5f);
  scene.add({0.0346f, -0.0348f, 0});                      // in the corner between floor and wall
  scene.add({0, -0.0346f, 0});                            // on the floor
  scene.add({0.02f, 0, 0.02f * std::sqrt(3.0f) * 0.93f}); // at the wall
  scene.add({0, 0.01f, 0});                               // in the middle
  scene.find();
  ASSERT_EQ(scene.contact_count, 3);
  EXPECT_GE(scene.contacts[0].plane_count, 2);
  EXPECT_EQ(scene.contacts[1].plane_count, 1);
  EXPECT_EQ(scene.contacts[2].plane_count, 1);
  // Thrown about in it, particles stay; then they come to rest at the stand-off from floor and wall.
  ContactScene thrown;
  thrown.add_shape(solid.shape, 0.5f);
  test::Random random{2};
  for (int i = 0; i < 300; ++i)
    thrown.add({random.between(-0.025f, 0.025f), random.between(-0.03f, 0.0f), random.between(-0.025f, 0.025f)},
               {random.between(-3, 3), random.between(-9, 0.5f), random.between(-3, 3)});
  for (int s = 0; s < 3000; ++s) thrown.step();
  for (std::size_t i = 0; i < 300; ++i) {
    const Vec3<float> x = thrown.x(i);
    EXPECT_LT(std::hypot(x.x, x.z), 0.0355f);
    EXPECT_GT(cup(widen(x)), 0.0045);
    EXPECT_LT(length(thrown.v(i)), 1e-3f);
  }
}

} // namespace
} // namespace loam
