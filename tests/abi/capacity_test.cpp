/* Capacities: a status that tells the size needed, and a world that stands where it says. */
#include "small_world.h"

namespace loam {
namespace {

using test::SmallWorld;

TEST_F(SmallWorld, ParticlesBeyondTheCapacityAreRefusedWithTheNumberNeeded) {
  loam_particles_def def;
  ASSERT_EQ(loam_particles_def_default(&def, sizeof def), LOAM_OK);
  std::vector<float> places(3 * 37);
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = 0.3f + 0.005f * float(i);
  def.material = material_;
  def.positions = places.data();
  def.count = 37; // 64 + 37 = 101
  refused(LOAM_ERROR_CAPACITY, {"particle_capacity", "101", "100"},
          [&] { return loam_particles_add(world(), &def, nullptr); });
  def.count = 36;
  EXPECT_EQ(loam_particles_add(world(), &def, nullptr), LOAM_OK);
}

/* The count alone is looked at: arrays that short would be overrun otherwise. */
TEST_F(SmallWorld, AbsurdCountsAreRefusedBeforeAnythingIsRead) {
  const float place[3] = {0, 1, 0};
  loam_particles_def def;
  ASSERT_EQ(loam_particles_def_default(&def, sizeof def), LOAM_OK);
  def.material = material_;
  def.positions = place;
  for (const std::uint64_t count :
       {std::uint64_t(1) << 32, std::uint64_t(6148914691236517206u), ~std::uint64_t(0), ~std::uint64_t(63)}) {
    def.count = count;
    refused(LOAM_ERROR_CAPACITY, {"particle_capacity"}, [&] { return loam_particles_add(world(), &def, nullptr); });
  }
}

TEST_F(SmallWorld, AFillBeyondTheCapacityNamesWhatItWouldTake) {
  loam_fill_def def;
  ASSERT_EQ(loam_fill_def_default(&def, sizeof def), LOAM_OK);
  def.material = material_;
  def.sampling = LOAM_SAMPLING_LATTICE;
  def.region.kind = LOAM_REGION_BOX;
  for (float &half : def.region.half_extents) half = 0.05f; // 1000 of the lattice
  refused(LOAM_ERROR_CAPACITY, {"particle_capacity", "1000"}, [&] { return loam_particles_fill(world(), &def, nullptr); });
  for (float &half : def.region.half_extents) half = 1e3f;
  refused(LOAM_ERROR_CAPACITY, {"particle_capacity"}, [&] { return loam_particles_fill(world(), &def, nullptr); });
}

TEST(PairCapacity, TooLittleRefusesTheStepAndNamesTheNeed) {
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 200);
  loam_world_def def = scenes::world_def(scene);
  def.substeps = 1;
  scenes::World roomy(def, scene);
  roomy.step(1e-4f);
  const std::uint64_t pairs = roomy.statistics().pairs;

  def.pair_capacity = pairs - 1;
  scenes::World narrow(def, scene);
  const scenes::Snapshot before = narrow.snapshot();
  EXPECT_STREQ(loam_status_name(loam_world_step(narrow.get(), 1e-4f)), "LOAM_ERROR_CAPACITY");
  test::expect_error_names({"pair_capacity", std::to_string(pairs)});
  EXPECT_EQ(narrow.statistics().pairs_peak, pairs);
  EXPECT_EQ(narrow.statistics().substeps_done, 0u);
  EXPECT_EQ(narrow.snapshot().positions, before.positions);
  EXPECT_EQ(narrow.snapshot().velocities, before.velocities);
}

/* Two blocks fly at each other; the pairs that meet are too many half-way through a step. */
TEST(PairCapacity, TheWorldStandsAtTheLastWholeSubstep) {
  scenes::Scene scene = scenes::jittered_block(scenes::rubber(), 125);
  scene.planes.clear();
  const std::size_t count = scene.count();
  for (std::size_t i = 0; i < 3 * count; ++i) scene.positions.push_back(scene.positions[i] + (i % 3 == 1 ? 0.1f : 0.0f));
  scene.velocities.assign(6 * count, 0.0f);
  for (std::size_t i = count; i < 2 * count; ++i) scene.velocities[3 * i + 1] = -10;
  loam_world_def def = scenes::world_def(scene);
  def.gravity[1] = 0;
  def.substeps = 20;
  scenes::World free(def, scene);
  free.step(1e-5f);
  def.pair_capacity = free.statistics().pairs + 100;
  scenes::World narrow(def, scene);
  ASSERT_EQ(loam_world_step(narrow.get(), 0.01f), LOAM_ERROR_CAPACITY);
  const std::uint32_t done = narrow.statistics().substeps_done;
  ASSERT_GT(done, 2u);
  ASSERT_LT(done, 20u);

  // The same substeps without a bound.
  def.pair_capacity = 0;
  def.substeps = done;
  scenes::World reference(def, scene);
  reference.step(0.0005f * float(done));
  const scenes::Snapshot a = narrow.snapshot(), b = reference.snapshot();
  for (std::size_t i = 0; i < a.positions.size(); ++i) ASSERT_NEAR(a.positions[i], b.positions[i], 1e-7) << i;
  for (std::size_t i = 0; i < a.velocities.size(); ++i) ASSERT_NEAR(a.velocities[i], b.velocities[i], 1e-4) << i;
  EXPECT_GE(narrow.statistics().pairs_peak, narrow.statistics().pairs);
}

} // namespace
} // namespace loam
