/* The hash tells apart what steps apart; and what lies far away does not matter to what happens here. */
#include <bit>

#include "settling_scene.h"

namespace loam {
namespace {

TEST(StateHash, DiffersWhenOneBitOfOneVelocityDiffers) {
  scenes::Scene scene = scenes::drop_block(scenes::sand(), 6, 0.1f, 1);
  const loam_world_def def = scenes::world_def(scene);
  const std::uint64_t hash = scenes::World(def, scene).state_hash();
  EXPECT_EQ(scenes::World(def, scene).state_hash(), hash);
  for (const std::size_t at : {std::size_t(1), scene.velocities.size() / 2, scene.velocities.size() - 2}) {
    scenes::Scene changed = scene;
    float &component = changed.velocities[at];
    component = std::bit_cast<float>(std::bit_cast<std::uint32_t>(component) ^ 1u);
    EXPECT_NE(scenes::World(def, changed).state_hash(), hash) << at;
  }
}

TEST(StateHash, DiffersByPositionMassMaterialAndNumber) {
  const scenes::Scene scene = scenes::drop_block(scenes::sand(), 4, 0.1f);
  const loam_world_def def = scenes::world_def(scene);
  const std::uint64_t hash = scenes::World(def, scene).state_hash();
  scenes::Scene moved = scene, heavier = scene, fewer = scene;
  moved.positions[7] = std::nextafter(moved.positions[7], 1.0f);
  heavier.material.density *= 1.001f;
  fewer.positions.resize(fewer.positions.size() - 3);
  fewer.velocities.resize(fewer.positions.size());
  for (const scenes::Scene &other : {moved, heavier, fewer}) EXPECT_NE(scenes::World(def, other).state_hash(), hash);
}

TEST(StateHash, EqualHashesStepAlike) {
  const scenes::Scene scene = scenes::drop_block(scenes::plasticine(), 5, 0.005f, 2);
  const loam_world_def def = scenes::world_def(scene);
  scenes::World one(def, scene), other(def, scene);
  for (int frame = 0; frame < 5; ++frame) {
    one.step(0.005f);
    other.step(0.005f);
    ASSERT_EQ(one.state_hash(), other.state_hash());
  }
  (void)other.snapshot(); // looking changes nothing
  one.step(0.005f);
  other.step(0.005f);
  EXPECT_EQ(one.state_hash(), other.state_hash());
}

/* Particles kilometres apart make the grid of cells wrap around, so that far cells share an entry; the motion must not notice. */
TEST(Torus, ScatteredParticlesDoNotChangeTheMotionOfACluster) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    const scenes::Scene cluster = scenes::drop_block(scenes::sand(), 6, 0.01f, 0);
    loam_world_def def = scenes::world_def(cluster);
    def.solver = solver;
    def.substeps = 8;
    scenes::World alone(def, cluster);

    scenes::Scene scattered = cluster;
    std::uint64_t state = 1;
    const auto next = [&] {
      return float(int((state = state * 6364136223846793005u + 1442695040888963407u) >> 40) % 18000 - 9000);
    };
    for (int k = 0; k < 300; ++k) {
      scattered.positions.insert(scattered.positions.end(), {next(), 5 + std::fabs(next()), next()});
      scattered.velocities.insert(scattered.velocities.end(), {0, 0, 0});
    }
    def.particle_capacity = scattered.count();
    scenes::World among(def, scattered);
    for (int frame = 0; frame < 20; ++frame) { // falls for 45 ms, then rests for 35
      alone.step(0.004f);
      among.step(0.004f);
    }
    // The same neighbours in another order of visits: equal but for what an unconverged solve makes of the order.
    const scenes::Snapshot a = alone.snapshot(), b = among.snapshot();
    double worst = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i)
      worst = std::max(worst, std::fabs(double(a.positions[i]) - double(b.positions[i])));
    EXPECT_LT(worst, solver == LOAM_SOLVER_JACOBI ? 1e-7 : 1e-4);
    // A lone particle far out falls freely, whatever shares its cell: 0.08 s.
    for (std::size_t i = cluster.count(); i < scattered.count(); ++i)
      ASSERT_NEAR(b.velocities[3 * i + 1], -9.81f * 0.08f, 1e-4) << i;
  }
}

} // namespace
} // namespace loam
