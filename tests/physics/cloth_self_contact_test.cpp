/* Cloth that collides with itself and with other cloth. */
#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/intersections.h"
#include "support/meshes.h"

namespace loam {
namespace {

using cloths::Cloth;
using cloths::Grid;

void add_collider(loam_world *world, std::uint32_t kind, float radius, float height) {
  loam_collider_def def;
  scenes::require(loam_collider_def_default(&def, sizeof def), "loam_collider_def_default");
  def.kind = kind;
  def.radius = radius;
  def.position[1] = height;
  loam_collider_id id;
  scenes::require(loam_collider_create(world, &def, &id), "loam_collider_create");
}

/* A sheet falls over a ball and hangs about it in folds that lie on the floor. The greatest number of pairs of triangles that pass through each other, looked at ten times a second. */
std::size_t drape(float self_distance, std::uint32_t substeps, double &height) {
  const Grid grid(40, 40, 0.015f);
  scenes::World world(cloths::world_def(5, substeps));
  add_collider(world.get(), LOAM_COLLIDER_SPHERE, 0.08f, 0.15f);
  add_collider(world.get(), LOAM_COLLIDER_PLANE, 0, 0);
  loam_cloth_def def = cloths::definition(grid);
  def.position[1] = 0.25f;
  def.thickness = 0.008f;
  def.self_distance = self_distance;
  const Cloth cloth(world.get(), def);
  cloth.set_wind(0, 0, 0, 1, 0);
  std::size_t most = 0;
  for (int frame = 0; frame < 120; ++frame) {
    world.step(1.0f / 60);
    if (frame % 6 == 5) most = std::max(most, intersections::count(cloth.vertices().positions, grid.indices));
  }
  const Cloth::Vertices now = cloth.vertices();
  EXPECT_TRUE(now.finite());
  height = double(now.lowest());
  return most;
}

TEST(ClothSelfContact, ADrapeDoesNotPassThroughItself) {
  double height = 0;
  EXPECT_EQ(drape(0.018f, 10, height), 0u);
  EXPECT_EQ(drape(0.018f, 4, height), 0u);
  EXPECT_GT(drape(0, 10, height), 20u); // without
}

} // namespace
} // namespace loam
