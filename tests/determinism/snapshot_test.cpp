/* A world that goes on from a snapshot has the same bits as one that was never stopped. */
#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/hooks.h"
#include "support/meshes.h"
#include "support/snapshots.h"

namespace loam {
namespace {

/* A block of one law's matter that collapses on a plane, with a turning mesh in it. */
class Collapse {
public:
  Collapse(const loam_world_def &def, const scenes::Scene &scene) : world_(def, scene) {
    loam_collider_def collider;
    scenes::require(loam_collider_def_default(&collider, sizeof collider), "default");
    const meshes::Mesh ball = meshes::icosphere(0.02f, 1);
    collider.kind = LOAM_COLLIDER_MESH;
    collider.mesh = ball.view();
    collider.position[0] = -0.03f;
    scenes::require(loam_collider_create(world_.get(), &collider, &ball_), "collider");
  }
  /* The frame decides where the ball goes. */
  void step(int frame) {
    const float at[3] = {-0.03f + 0.002f * float(frame), 0.02f, 0.01f}, turn[4] = {0, 0.02f * float(frame), 0, 1};
    scenes::require(loam_collider_move(world_.get(), ball_, at, turn), "move");
    world_.step(2e-3f);
  }
  loam_world *get() const { return world_.get(); }
  std::uint64_t hash() const { return world_.state_hash(); }

private:
  scenes::World world_;
  loam_collider_id ball_ = 0;
};

struct Form {
  std::uint32_t solver, multiplier, warm_start = 0;
};

class SnapshotOf : public testing::TestWithParam<Form> {};

TEST_P(SnapshotOf, EveryLawGoesOnWithTheSameBits) {
  for (const loam_material_def &material : scenes::each_law()) {
    SCOPED_TRACE(material.name);
    const scenes::Scene scene = scenes::jittered_block(material, 200);
    loam_world_def def = scenes::world_def(scene);
    def.solver = GetParam().solver;
    def.multiplier = GetParam().multiplier;
    def.warm_start = GetParam().warm_start;
    def.substeps = 4;
    Collapse straight(def, scene);
    for (int frame = 0; frame < 3; ++frame) straight.step(frame);
    const snapshots::Bytes saved = snapshots::save(straight.get());
    const std::uint64_t then = straight.hash();
    for (int frame = 3; frame < 6; ++frame) straight.step(frame);
    const std::uint64_t expected = straight.hash();
    ASSERT_NE(then, expected);

    /* Back in the same world; and in new ones, by other threads and instruction sets. */
    snapshots::restore(straight.get(), saved);
    EXPECT_EQ(straight.hash(), then);
    for (int frame = 3; frame < 6; ++frame) straight.step(frame);
    EXPECT_EQ(straight.hash(), expected);
    const std::uint32_t last = hooks::short_run() ? LOAM_INSTRUCTION_SET_PORTABLE : LOAM_INSTRUCTION_SET_AVX512;
    for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= last; ++set) {
      def.instruction_set = set;
      def.thread_count = 1 + set;
      loam_world *tried = nullptr;
      if (loam_world_create(&def, &tried) != LOAM_OK) continue;
      loam_world_destroy(tried);
      Collapse other(def, scene);
      for (int frame = 0; frame < 2; ++frame) other.step(frame); /* something else to forget */
      snapshots::restore(other.get(), saved);
      EXPECT_EQ(other.hash(), then);
      EXPECT_EQ(snapshots::save(other.get()), saved);
      for (int frame = 3; frame < 6; ++frame) other.step(frame);
      EXPECT_EQ(other.hash(), expected) << "instruction set " << set;
    }
  }
}

/* What the test above would see if less was kept: new particles with the positions, velocities and masses alone go another way. */
TEST_P(SnapshotOf, PositionsAndVelocitiesAloneAreNotEnough) {
  const loam_material_def material = scenes::sand();
  scenes::Scene scene = scenes::jittered_block(material, 200);
  loam_world_def def = scenes::world_def(scene);
  def.solver = GetParam().solver;
  def.multiplier = GetParam().multiplier;
  def.substeps = 4;
  Collapse straight(def, scene);
  for (int frame = 0; frame < 3; ++frame) straight.step(frame);
  scene.velocities.assign(scene.velocities.size(), 0);
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(loam_particles_map(straight.get(), &view), LOAM_OK);
  for (std::uint64_t i = 0; i < view.count; ++i)
    for (unsigned k = 0; k < 3; ++k) {
      scene.positions[3 * i + k] = view.positions[4 * i + k];
      scene.velocities[3 * i + k] = view.velocities[4 * i + k];
    }
  ASSERT_EQ(loam_particles_unmap(straight.get()), LOAM_OK);
  Collapse other(def, scene);
  straight.step(3);
  other.step(3);
  EXPECT_NE(other.hash(), straight.hash());
}

INSTANTIATE_TEST_SUITE_P(Forms, SnapshotOf,
                         testing::Values(Form{LOAM_SOLVER_GAUSS_SEIDEL, LOAM_MULTIPLIER_PROJECTED_TENSOR},
                                         Form{LOAM_SOLVER_GAUSS_SEIDEL, LOAM_MULTIPLIER_PROJECTED_TENSOR, 1},
                                         Form{LOAM_SOLVER_GAUSS_SEIDEL, LOAM_MULTIPLIER_SCALAR},
                                         Form{LOAM_SOLVER_JACOBI, LOAM_MULTIPLIER_PROJECTED_TENSOR},
                                         Form{LOAM_SOLVER_JACOBI, LOAM_MULTIPLIER_SCALAR}),
                         [](const auto &tested) {
                           return std::string(tested.param.solver == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel") +
                                  (tested.param.multiplier == LOAM_MULTIPLIER_SCALAR ? "Scalar" : "Tensor") +
                                  (tested.param.warm_start != 0 ? "WarmStart" : "");
                         });

/* All laws in one world, particles added after the snapshot, another gravity, a material that came with histories of its own. */
TEST(SnapshotOfAMixture, TakesAwayWhatCameLater) {
  const std::vector<loam_material_def> materials = scenes::each_law();
  loam_world_def def = scenes::world_def(scenes::jittered_block(materials[0], 100));
  def.particle_capacity = 2000;
  def.substeps = 3;
  scenes::World world(def);
  for (std::size_t m = 0; m < materials.size(); ++m) {
    scenes::Scene block = scenes::jittered_block(materials[m], 60);
    for (std::size_t i = 0; i < block.count(); ++i) block.positions[3 * i] += 0.05f * float(m);
    if (m > 0) block.planes.clear();
    world.add(block);
  }
  for (int frame = 0; frame < 3; ++frame) world.step(2e-3f);
  const snapshots::Bytes saved = snapshots::save(world.get());
  for (int frame = 0; frame < 3; ++frame) world.step(2e-3f);
  const std::uint64_t expected = world.state_hash();

  const float up[3] = {0, 5, 0}, place[3] = {0, 1, 0};
  scenes::require(loam_world_set_gravity(world.get(), up), "gravity");
  scenes::require(loam_world_set_accuracy(world.get(), 7, 2), "accuracy");
  loam_particles_def more;
  scenes::require(loam_particles_def_default(&more, sizeof more), "default");
  loam_material_id material = 0;
  scenes::require(loam_material_create(world.get(), &materials[0], &material), "material");
  more.material = material;
  more.count = 1;
  more.positions = place;
  scenes::require(loam_particles_add(world.get(), &more, nullptr), "add");
  world.step(1e-3f);
  EXPECT_EQ(loam_snapshot_restore(world.get(), saved.data(), saved.size()), LOAM_ERROR_SNAPSHOT_MISMATCH);
  EXPECT_EQ(loam_material_destroy(world.get(), material), LOAM_ERROR_IN_USE);

  /* A world without the further material takes it, whatever else happened there. */
  scenes::World other(def);
  for (std::size_t m = 0; m < materials.size(); ++m) {
    scenes::Scene block = scenes::jittered_block(materials[m], 2 + 3 * m);
    if (m > 0) block.planes.clear();
    other.add(block);
  }
  scenes::require(loam_world_set_gravity(other.get(), up), "gravity");
  scenes::require(loam_world_set_accuracy(other.get(), 7, 2), "accuracy");
  other.step(1e-3f);
  snapshots::restore(other.get(), saved);
  for (int frame = 0; frame < 3; ++frame) other.step(2e-3f);
  EXPECT_EQ(other.state_hash(), expected);
  EXPECT_EQ(other.statistics().particles, 60 * materials.size());
}

/* A sheet in the wind, held at a corner of a moving collider, let go of after the snapshot. */
TEST(SnapshotOfCloth, GoesOnWithTheSameBits) {
  const loam_world_def def = cloths::world_def(5, 4);
  scenes::World world(def);
  loam_collider_def floor;
  scenes::require(loam_collider_def_default(&floor, sizeof floor), "default");
  loam_collider_id handle = 0;
  scenes::require(loam_collider_create(world.get(), &floor, &handle), "collider");
  const cloths::Grid grid(17, 13, 0.01f);
  loam_cloth_def cloth_def = cloths::definition(grid);
  cloth_def.position[1] = 0.03f;
  cloth_def.self_distance = 0.012f;
  const cloths::Cloth cloth(world.get(), cloth_def);
  const std::uint32_t corner = grid.at(0, 0), end = grid.at(16, 0);
  cloth.attach({corner}, {}, 0, handle);
  cloth.attach({end}, {}, 0.01f);
  cloth.set_wind(3, 0, 1, 1, 0.5f);
  const auto step = [&](int frame) {
    const float at[3] = {0.001f * float(frame), 0, 0}, turn[4] = {0, 0, 0, 1};
    scenes::require(loam_collider_move(world.get(), handle, at, turn), "move");
    world.step(1.0f / 60);
  };
  for (int frame = 0; frame < 5; ++frame) step(frame);
  const snapshots::Bytes saved = snapshots::save(world.get());
  const std::uint64_t then = world.state_hash();
  for (int frame = 5; frame < 10; ++frame) step(frame);
  const std::uint64_t expected = world.state_hash();

  scenes::require(loam_cloth_release(world.get(), cloth.id, &corner, 1), "release");
  cloth.set_wind(0, 0, 0, 0, 0);
  step(3);
  snapshots::restore(world.get(), saved);
  EXPECT_EQ(world.state_hash(), then);
  EXPECT_EQ(snapshots::save(world.get()), saved);
  for (int frame = 5; frame < 10; ++frame) step(frame);
  EXPECT_EQ(world.state_hash(), expected);
}

/* A sheet that collides with itself is torn apart; back to when it was half torn, and to when it was whole, in this world and in another. */
TEST(SnapshotOfCloth, KnowsHowItIsTorn) {
  const cloths::Grid grid(12, 12, 0.02f, true);
  loam_cloth_def cloth_def = cloths::definition(grid);
  cloth_def.greatest_stretch = 0.1f;
  cloth_def.tear_strain = 0.05f;
  cloth_def.self_distance = 0.021f;
  struct Torn {
    scenes::World world;
    loam_cloth_id cloth = 0;
    explicit Torn(const cloths::Grid &grid, const loam_cloth_def &def) : world(cloths::world_def(5, 4)) {
      const cloths::Cloth made(world.get(), def);
      cloth = made.id;
      made.attach({grid.at(0, 0), grid.at(12, 0)}, {-0.18f, 0, 0, 0.18f, 0, 0}, 1e-4f);
    }
    std::uint64_t step(int frames) {
      std::uint64_t tears = 0;
      for (int frame = 0; frame < frames; ++frame) {
        world.step(1.0f / 60);
        tears += world.statistics().cloth_tears;
      }
      return tears;
    }
  };
  Torn torn(grid, cloth_def);
  const snapshots::Bytes whole = snapshots::save(torn.world.get());
  const std::uint64_t before = torn.world.state_hash();
  ASSERT_GT(torn.step(4), 0u);
  const snapshots::Bytes half = snapshots::save(torn.world.get());
  const std::uint64_t then = torn.world.state_hash();
  ASSERT_GT(half.size(), whole.size());
  torn.step(20);
  const std::uint64_t expected = torn.world.state_hash();
  ASSERT_NE(then, expected);

  Torn other(grid, cloth_def);
  for (Torn *world : {&torn, &other}) {
    snapshots::restore(world->world.get(), half);
    EXPECT_EQ(world->world.state_hash(), then);
    EXPECT_EQ(snapshots::save(world->world.get()), half);
    world->step(20);
    EXPECT_EQ(world->world.state_hash(), expected);
  }
  snapshots::restore(torn.world.get(), whole);
  EXPECT_EQ(torn.world.state_hash(), before);
  torn.step(24);
  EXPECT_EQ(torn.world.state_hash(), expected);
}

} // namespace
} // namespace loam
