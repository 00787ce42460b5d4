/* Cloth and particles: momentum goes both ways, nothing passes. */
#include <gtest/gtest.h>
#include <numeric>
#include <string>

#include "support/cloths.h"
#include "support/meshes.h"

namespace loam {
namespace {

using cloths::Cloth;
using cloths::Grid;

/* Sand of `density` in a ball, as particles of kernel radius r. */
std::uint64_t add_ball(loam_world *world, float density, float radius, float height, float speed) {
  loam_material_def def;
  loam_material_id material;
  scenes::require(loam_material_def_default(LOAM_LAW_DRUCKER_PRAGER, &def, sizeof def), "loam_material_def_default");
  def.density = density;
  scenes::require(loam_material_create(world, &def, &material), "loam_material_create");
  loam_fill_def fill;
  scenes::require(loam_fill_def_default(&fill, sizeof fill), "loam_fill_def_default");
  fill.material = material;
  fill.region.kind = LOAM_REGION_SPHERE;
  fill.region.radius = radius;
  fill.region.center[1] = height;
  fill.velocity[1] = speed;
  fill.velocity[0] = 0.2f;
  std::uint64_t count = 0;
  scenes::require(loam_particles_fill(world, &fill, &count), "loam_particles_fill");
  return count;
}

loam_world_def world_def(float radius, std::uint32_t substeps) {
  loam_world_def def = cloths::world_def(5, substeps);
  def.kernel_radius = radius;
  def.particle_capacity = 4000;
  return def;
}

struct Momentum {
  double sum[3] = {}, size = 0;
  void add(const std::vector<float> &velocities, const std::vector<float> &inverse_masses) {
    for (std::size_t i = 0; i < inverse_masses.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const double p = double(velocities[3 * i + k]) / double(inverse_masses[i]);
        sum[k] += p;
        size += std::fabs(p);
      }
  }
};

/* A ball of sand hits a sheet, without gravity or anything that holds either: the change of momentum over all |p|; `share` receives what the cloth has of it at the end. */
double momentum_error(float speed, double &share) {
  loam_world_def def = world_def(0.02f, 8);
  def.gravity[1] = 0;
  scenes::World world(def);
  const Grid grid(16, 16, 0.03f);
  const Cloth cloth(world.get(), cloths::definition(grid));
  EXPECT_GT(add_ball(world.get(), 1600, 0.08f, 0.1f, -speed), 100u);
  const auto total = [&](Momentum &of_cloth) {
    const scenes::Snapshot sand = world.snapshot();
    const Cloth::Vertices now = cloth.vertices();
    Momentum all;
    all.add(sand.velocities, sand.inverse_masses);
    all.add(now.velocities, now.inverse_masses);
    of_cloth.add(now.velocities, now.inverse_masses);
    return all;
  };
  Momentum cloth_before, cloth_after;
  const Momentum before = total(cloth_before);
  for (int frame = 0; frame < 12; ++frame) world.step(1.0f / 60);
  const Momentum after = total(cloth_after);
  double worst = 0;
  for (int k = 0; k < 3; ++k) worst = std::max(worst, std::fabs(after.sum[k] - before.sum[k]) / before.size);
  share = -cloth_after.sum[1] / before.size;
  return worst;
}

/* Impulses are given both ways to the last bit, in hard impacts too. */
TEST(ClothAndParticles, KeepTheirMomentumTogether) {
  double share = 0;
  for (const float speed : {0.2f, 2.0f, 5.0f}) {
    const double error = momentum_error(speed, share);
    RecordProperty("at_" + std::to_string(speed), std::to_string(1e6 * error));
    EXPECT_LT(error, 1e-5) << speed;
    EXPECT_GT(share, 0.001) << speed; // it was taken along: it has .009 of the mass
  }
}

std::size_t outside(const scenes::World &world, const Cloth &cloth, meshes::Mesh bag) {
  const Cloth::Vertices now = cloth.vertices();
  EXPECT_TRUE(now.finite());
  bag.positions.assign(now.positions.begin(), now.positions.end());
  const scenes::Snapshot sand = world.snapshot();
  std::size_t result = 0;
  for (std::size_t i = 0; i < sand.count(); ++i) {
    const double point[3] = {double(sand.positions[3 * i]), double(sand.positions[3 * i + 1]),
                             double(sand.positions[3 * i + 2])};
    result += meshes::winding_number(bag, point) < 0.5 ? 1 : 0;
  }
  return result;
}

/* A bag of cloth full of sand falls on the floor. */
std::size_t outside(float areal_density, float sand_density, int frames) {
  scenes::World world(world_def(0.025f, 12));
  loam_collider_def floor;
  scenes::require(loam_collider_def_default(&floor, sizeof floor), "loam_collider_def_default");
  loam_collider_id id;
  scenes::require(loam_collider_create(world.get(), &floor, &id), "loam_collider_create");
  const meshes::Mesh bag = meshes::icosphere(0.15f, 2);
  loam_cloth_def def;
  scenes::require(loam_cloth_def_default(&def, sizeof def), "loam_cloth_def_default");
  def.mesh = bag.view();
  def.position[1] = 0.3f;
  def.areal_density = areal_density;
  const Cloth cloth(world.get(), def);
  const std::uint64_t count = add_ball(world.get(), sand_density, 0.125f, 0.3f, 0);
  EXPECT_GT(count, 400u);
  for (int frame = 0; frame < frames; ++frame) world.step(1.0f / 60);
  EXPECT_LT(cloth.vertices().lowest(), 0.02f); // it lies on the floor
  return outside(world, cloth, bag);
}

TEST(ClothAndParticles, ABagFullOfSandIsTight) { EXPECT_EQ(outside(0.3f, 1600, 60), 0u); }

/* A grain a thousand times as heavy as the cloth around it: 14 g a vertex against 14 kg. */
TEST(ClothAndParticles, ABagOfThinClothHoldsHeavyGrains) { EXPECT_EQ(outside(0.02f, 50000, 40), 0u); }

/* A bag that hits the floor at 6 m/s with sand in it that is 4 m/s faster. */
TEST(ClothAndParticles, ABagThatIsThrownDownIsTight) {
  scenes::World world(world_def(0.02f, 16));
  loam_collider_def floor;
  scenes::require(loam_collider_def_default(&floor, sizeof floor), "loam_collider_def_default");
  loam_collider_id id;
  scenes::require(loam_collider_create(world.get(), &floor, &id), "loam_collider_create");
  const meshes::Mesh bag = meshes::icosphere(0.15f, 3);
  loam_cloth_def def;
  scenes::require(loam_cloth_def_default(&def, sizeof def), "loam_cloth_def_default");
  def.mesh = bag.view();
  def.position[1] = 0.3f;
  def.velocity[1] = -6;
  def.self_distance = 0.026f;
  const Cloth cloth(world.get(), def);
  EXPECT_GT(add_ball(world.get(), 1600, 0.11f, 0.3f, -10), 700u);
  std::size_t most = 0;
  for (int frame = 0; frame < 15; ++frame) {
    world.step(1.0f / 60);
    most = std::max(most, outside(world, cloth, bag));
  }
  EXPECT_EQ(most, 0u);
}

/* Sand on a sheet that is held at its rim stays on it, and weighs it down. */
TEST(ClothAndParticles, AHeldSheetCarriesSand) {
  scenes::World world(world_def(0.02f, 10));
  const Grid grid(20, 20, 0.025f);
  const Cloth cloth(world.get(), cloths::definition(grid));
  std::vector<std::uint32_t> rim;
  for (std::uint32_t i = 0; i <= 20; ++i)
    for (std::uint32_t j = 0; j <= 20; ++j)
      if (i == 0 || j == 0 || i == 20 || j == 20) rim.push_back(grid.at(i, j));
  cloth.attach(rim);
  add_ball(world.get(), 1600, 0.08f, 0.12f, 0);
  for (int frame = 0; frame < 60; ++frame) world.step(1.0f / 60);
  const scenes::Snapshot sand = world.snapshot();
  const float lowest = cloth.vertices().lowest();
  EXPECT_LT(lowest, -0.01f);
  std::size_t on_it = 0; // some bounces off
  for (std::size_t i = 0; i < sand.count(); ++i) {
    const float *x = &sand.positions[3 * i];
    const bool over = std::fabs(x[0]) < 0.25f && std::fabs(x[2]) < 0.25f;
    if (over) {
      EXPECT_GT(x[1], lowest);
    }
    on_it += over ? 1 : 0;
  }
  EXPECT_GT(static_cast<double>(on_it), 0.97 * static_cast<double>(sand.count()));
}

/* Particles that touched a sheet and were removed push it no more, though more of their kind are yet to come: it falls freely from there. */
TEST(ClothAndParticles, WhoIsGonePushesNoMore) {
  scenes::Scene block = scenes::jittered_block(scenes::sand(), 200);
  block.planes.clear();
  float lowest = 1;
  for (std::size_t i = 1; i < block.positions.size(); i += 3) lowest = std::min(lowest, block.positions[i]);
  loam_world_def def = scenes::world_def(block);
  def.substeps = 4;
  scenes::World world(def);
  loam_emitter_def later;
  scenes::require(loam_emitter_def_default(&later, sizeof later), "loam_emitter_def_default");
  later.material = world.add(block);
  later.radius = 0.05f;
  later.start = 100;
  loam_emitter_id emitter = 0;
  scenes::require(loam_emitter_create(world.get(), &later, &emitter), "loam_emitter_create");
  const cloths::Grid grid(30, 30, 0.01f);
  loam_cloth_def cloth_def = cloths::definition(grid);
  cloth_def.position[1] = lowest - 0.006f;
  cloth_def.velocity[1] = 2; // up, against the block
  const cloths::Cloth cloth(world.get(), cloth_def);
  cloth.set_wind(0, 0, 0, 0, 0);
  world.step(1.0f / 120);
  std::uint64_t contacts = 0;
  for (const loam_stage &stage : world.stages())
    if (std::string(stage.name) == "cloth and particles") contacts = stage.items;
  ASSERT_GT(contacts, 0u);
  std::vector<std::uint32_t> ids(block.count());
  std::iota(ids.begin(), ids.end(), 0u);
  scenes::require(loam_particles_remove(world.get(), ids.data(), ids.size()), "loam_particles_remove");
  const auto mean_speed = [&] {
    const cloths::Cloth::Vertices now = cloth.vertices();
    double momentum = 0, mass = 0;
    for (std::size_t i = 0; i < now.count(); ++i) {
      momentum += double(now.velocities[3 * i + 1]) / double(now.inverse_masses[i]);
      mass += 1 / double(now.inverse_masses[i]);
    }
    return momentum / mass;
  };
  const double before = mean_speed();
  for (int frame = 0; frame < 4; ++frame) world.step(1.0f / 120);
  const double change = mean_speed() - before, fall = double(def.gravity[1]) * 4 / 120;
  RecordProperty("change", std::to_string(change / fall));
  EXPECT_NEAR(change / fall, 1, 1e-3);
}

} // namespace
} // namespace loam
