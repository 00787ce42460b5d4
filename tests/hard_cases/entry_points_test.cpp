/* NaN, infinity and huge values at every entry point that takes numbers, one after the other on one world that goes on stepping: each is refused,
 * and in the end the world is where it would have been without them. */
#include <limits>

#include "hard_case.h"

namespace loam {
namespace {

void try_everything(loam_world *world, loam_material_id material, loam_collider_id collider, float bad) {
  const auto refused = [](loam_status status) { EXPECT_EQ(status, LOAM_ERROR_INVALID_ARGUMENT) << loam_last_error(); };
  refused(loam_world_step(world, bad));
  for (int k = 0; k < 4; ++k) {
    float v[4] = {0, 0, 0, 1}, zero[3] = {0, 0, 0}, identity[4] = {0, 0, 0, 1};
    v[k] = bad;
    refused(loam_collider_move(world, collider, zero, v));
    refused(loam_collider_place(world, collider, zero, v));
    if (k == 3) continue;
    refused(loam_world_set_gravity(world, v));
    refused(loam_collider_move(world, collider, v, identity));
    refused(loam_collider_place(world, collider, v, identity));
    loam_particles_def add;
    scenes::require(loam_particles_def_default(&add, sizeof add), "default");
    add.material = material;
    add.count = 1;
    add.positions = v;
    refused(loam_particles_add(world, &add, nullptr));
    add.positions = zero;
    add.velocities = v;
    refused(loam_particles_add(world, &add, nullptr));
    loam_fill_def fill;
    scenes::require(loam_fill_def_default(&fill, sizeof fill), "default");
    fill.material = material;
    fill.region.kind = LOAM_REGION_SPHERE;
    fill.region.radius = 0.01f;
    fill.velocity[k] = bad;
    refused(loam_particles_fill(world, &fill, nullptr));
    fill.velocity[k] = 0;
    fill.region.center[k] = bad;
    refused(loam_particles_fill(world, &fill, nullptr));
  }
  for (float loam_material_def::*field :
       {&loam_material_def::density, &loam_material_def::youngs_modulus, &loam_material_def::poissons_ratio,
        &loam_material_def::friction_angle, &loam_material_def::cohesion}) {
    loam_material_def def = scenes::sand();
    def.*field = bad;
    loam_material_id id = 0;
    refused(loam_material_create(world, &def, &id));
  }
  meshes::Mesh mesh = meshes::box(1, 1, 1);
  mesh.positions[7] = bad;
  loam_collider_def def;
  scenes::require(loam_collider_def_default(&def, sizeof def), "default");
  def.kind = LOAM_COLLIDER_MESH;
  def.mesh = mesh.view();
  loam_collider_id id = 0;
  refused(loam_collider_create(world, &def, &id));
}

TEST(EntryPoints, BadNumbersAreRefusedAndLeaveNoTrace) {
  const scenes::Scene scene = test::block(scenes::sand(), 5, 0.01f);
  loam_world_def def = scenes::world_def(scene);
  def.particle_capacity += 100;
  scenes::World tried(def, scene), untouched(def, scene);
  loam_material_id material = 0;
  for (scenes::World *world : {&tried, &untouched})
    ASSERT_EQ(loam_material_create(world->get(), &scene.material, &material), LOAM_OK);
  loam_material_id material_of_tried = 0;
  ASSERT_EQ(loam_material_create(tried.get(), &scene.material, &material_of_tried), LOAM_OK);
  loam_collider_id collider = 0;
  loam_collider_def plane;
  ASSERT_EQ(loam_collider_def_default(&plane, sizeof plane), LOAM_OK);
  for (scenes::World *world : {&untouched, &tried})
    ASSERT_EQ(loam_collider_create(world->get(), &plane, &collider), LOAM_OK);
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(), 3e38f, -3e38f}) {
    try_everything(tried.get(), material_of_tried, collider, bad);
    tried.step(0.005f);
    untouched.step(0.005f);
    ASSERT_EQ(tried.state_hash(), untouched.state_hash()) << bad;
  }
}

/* What is allowed though extreme must be survived. */
TEST(EntryPoints, TheLargestAllowedNumbersAreSurvived) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    loam_material_def stiff = scenes::rubber(1e13f);
    stiff.density = 1e6f;
    scenes::Scene scene = test::block(stiff, 4, 0.01f);
    for (float &v : scene.velocities) v = 1e9f;
    loam_world_def def = scenes::world_def(scene);
    def.solver = solver;
    def.substeps = 2;
    def.gravity[0] = 1e6f;
    def.velocity_smoothing = 1e4f;
    scenes::World world(def, scene);
    for (int k = 0; k < 10; ++k) {
      world.step(1);
      ASSERT_EQ(world.statistics().non_finite, 0u);
      ASSERT_LE(world.statistics().max_speed, 0.01 / 0.5 * 1.001);
    }
  }
}

} // namespace
} // namespace loam
