/* The calls of world.h on a world: correct use, and what each refuses. */
#include "small_world.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;
using test::SmallWorld;

TEST_F(SmallWorld, EveryCallRefusesANullWorld) {
  float vector[3] = {};
  std::uint32_t number = 0;
  std::uint64_t large = 0;
  loam_statistics statistics = {};
  statistics.struct_size = sizeof statistics;
  for (const loam_status status :
       {loam_world_step(nullptr, 0.01f), loam_world_set_gravity(nullptr, vector), loam_world_set_accuracy(nullptr, 1, 1),
        loam_world_get_backend(nullptr, &number, &number), loam_world_state_hash(nullptr, &large),
        loam_world_get_statistics(nullptr, &statistics), loam_world_get_stages(nullptr, nullptr, 0, &number),
        loam_world_get_memory(nullptr, nullptr, 0, &number), loam_particles_count(nullptr, &large),
        loam_particles_unmap(nullptr)}) {
    EXPECT_EQ(status, LOAM_ERROR_INVALID_ARGUMENT);
    test::expect_error_names({"world is null"});
  }
}

TEST_F(SmallWorld, StepRefusesDurationsThatAreNone) {
  for (const float seconds : {0.0f, -0.0f, -0.01f, 1.001f, 1e30f, nan, infinity, -infinity, 1e-10f, 1e-40f})
    invalid({"seconds"}, [&] { return loam_world_step(world(), seconds); });
  EXPECT_EQ(loam_world_step(world(), 1e-6f), LOAM_OK);
  EXPECT_EQ(loam_world_step(world(), 1), LOAM_OK); // the greatest
}

TEST_F(SmallWorld, GravityIsFiniteAndBounded) {
  invalid({"gravity is null"}, [&] { return loam_world_set_gravity(world(), nullptr); });
  for (int k = 0; k < 3; ++k)
    for (const float bad : {nan, infinity, -infinity, 1.1e6f, -1.1e6f}) {
      float gravity[3] = {0, 0, 0};
      gravity[k] = bad;
      invalid({"gravity[" + std::to_string(k) + "]"}, [&] { return loam_world_set_gravity(world(), gravity); });
    }
}

TEST_F(SmallWorld, GravityActsFromTheNextStep) {
  scenes::Scene lone;
  lone.material = scenes::rubber();
  lone.spacing = 0.01f;
  lone.positions = {0, 0, 0};
  scenes::World falling(scenes::world_def(lone), lone);
  const float sideways[3] = {2, 0, 0}, none[3] = {0, 0, 0};
  ASSERT_EQ(loam_world_set_gravity(falling.get(), sideways), LOAM_OK);
  falling.step(0.01f);
  EXPECT_NEAR(falling.snapshot().velocities[0], 0.02f, 1e-6);
  ASSERT_EQ(loam_world_set_gravity(falling.get(), none), LOAM_OK);
  falling.step(0.01f);
  EXPECT_NEAR(falling.snapshot().velocities[0], 0.02f, 1e-6);
  EXPECT_EQ(falling.snapshot().velocities[1], 0.0f);
}

TEST_F(SmallWorld, AccuracyIsBounded) {
  for (const std::uint32_t bad : {0u, 10001u, ~0u})
    invalid({"substeps", "must be"}, [&] { return loam_world_set_accuracy(world(), bad, 1); });
  for (const std::uint32_t bad : {0u, 1001u, ~0u})
    invalid({"iterations", "must be"}, [&] { return loam_world_set_accuracy(world(), 1, bad); });
  ASSERT_EQ(loam_world_set_accuracy(world(), 7, 3), LOAM_OK);
  world_.step(0.01f);
  const loam_statistics statistics = world_.statistics();
  EXPECT_EQ(statistics.substeps_done, 7u);
  EXPECT_GE(statistics.pair_visits, 7 * 3 * statistics.pairs / 2);
}

TEST_F(SmallWorld, GettersRefuseNullResults) {
  invalid({"hash is null"}, [&] { return loam_world_state_hash(world(), nullptr); });
  invalid({"statistics is null"}, [&] { return loam_world_get_statistics(world(), nullptr); });
  invalid({"count is null"}, [&] { return loam_world_get_stages(world(), nullptr, 0, nullptr); });
  invalid({"count is null"}, [&] { return loam_world_get_memory(world(), nullptr, 0, nullptr); });
  invalid({"count is null"}, [&] { return loam_particles_count(world(), nullptr); });
  std::uint32_t count = 0;
  invalid({"stages is null"}, [&] { return loam_world_get_stages(world(), nullptr, 1, &count); });
  invalid({"rows is null"}, [&] { return loam_world_get_memory(world(), nullptr, 1, &count); });
  EXPECT_EQ(loam_world_get_backend(world(), nullptr, nullptr), LOAM_OK);
}

TEST_F(SmallWorld, StatisticsRefuseUnknownSizes) {
  for (const std::uint32_t size : wrong_sizes(sizeof(loam_statistics))) {
    loam_statistics statistics = {};
    statistics.struct_size = size;
    statistics.particles = 12345;
    invalid({"statistics", std::to_string(size)}, [&] { return loam_world_get_statistics(world(), &statistics); });
    EXPECT_EQ(statistics.particles, 12345u);
  }
}

TEST_F(SmallWorld, StatisticsAreThoseOfTheLastStep) {
  ASSERT_EQ(loam_world_set_accuracy(world(), 4, 6), LOAM_OK);
  world_.step(4e-4f);
  const loam_statistics s = world_.statistics();
  const scenes::Snapshot now = world_.snapshot();
  EXPECT_EQ(s.particles, 64u);
  EXPECT_EQ(s.substeps_done, 4u);
  EXPECT_EQ(s.non_finite, 0u);
  EXPECT_EQ(s.pairs % 2, 0u); // ordered pairs
  EXPECT_GT(s.pairs, 64u * 5);
  EXPECT_GE(s.pairs_peak, s.pairs);
  EXPECT_GT(s.contacts, 0u);
  double energy = 0, momentum = 0, fastest = 0, sum = 0;
  for (std::size_t i = 0; i < now.count(); ++i) {
    const double mass = 1.0 / double(now.inverse_masses[i]);
    const double speed =
        std::hypot(double(now.velocities[3 * i]), double(now.velocities[3 * i + 1]), double(now.velocities[3 * i + 2]));
    energy += 0.5 * mass * speed * speed;
    momentum += mass * double(now.velocities[3 * i]);
    fastest = std::max(fastest, speed);
    sum += speed;
  }
  EXPECT_NEAR(s.kinetic_energy, energy, 1e-5 * energy);
  EXPECT_NEAR(s.momentum[0], momentum, 1e-5 * std::fabs(momentum) + 1e-9);
  EXPECT_NEAR(s.max_speed, fastest, 1e-6 * fastest);
  EXPECT_NEAR(s.mean_speed, sum / 64, 1e-5 * fastest);
  EXPECT_GE(s.step_seconds, 0);
}

TEST_F(SmallWorld, StagesAndMemoryAreCopiedUpToTheCapacity) {
  const std::vector<loam_stage> stages = world_.stages();
  ASSERT_GT(stages.size(), 5u);
  std::vector<loam_stage> two(3);
  std::strcpy(two[2].name, "untouched");
  std::uint32_t count = 0;
  EXPECT_EQ(loam_world_get_stages(world(), two.data(), 2, &count), LOAM_OK);
  EXPECT_EQ(count, stages.size());
  EXPECT_STREQ(two[1].name, stages[1].name);
  EXPECT_STREQ(two[2].name, "untouched");
  const auto solve = std::find_if(stages.begin(), stages.end(),
                                  [](const loam_stage &stage) { return std::string(stage.name) == "solve sand"; });
  ASSERT_NE(solve, stages.end());
  EXPECT_EQ(solve->items, 64u * 2 * 5); // particles x substeps x iterations

  loam_memory row = {};
  EXPECT_EQ(loam_world_get_memory(world(), &row, 1, &count), LOAM_OK);
  EXPECT_GT(count, 3u);
  EXPECT_STREQ(row.effect, "particles");
  EXPECT_GT(row.bytes, 64u * 64);
}

TEST(Stages, AreThoseThatTheContentsCallFor) {
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 8);
  const scenes::World world(scenes::world_def(scene));
  const auto has = [&](const std::string &name) {
    const std::vector<loam_stage> stages = world.stages();
    return std::any_of(stages.begin(), stages.end(), [&](const loam_stage &stage) { return stage.name == name; });
  };
  EXPECT_TRUE(has("advance")); // though nothing was stepped
  EXPECT_FALSE(has("find contacts"));
  loam_collider_def def;
  ASSERT_EQ(loam_collider_def_default(&def, sizeof def), LOAM_OK);
  loam_collider_id collider = 0;
  ASSERT_EQ(loam_collider_create(world.get(), &def, &collider), LOAM_OK);
  EXPECT_TRUE(has("find contacts"));
  ASSERT_EQ(loam_collider_destroy(world.get(), collider), LOAM_OK);
  EXPECT_FALSE(has("find contacts"));

  loam_material_id material = 0;
  ASSERT_EQ(loam_material_create(world.get(), &scene.material, &material), LOAM_OK);
  EXPECT_FALSE(has("solve sand")); // nothing is made of it
  loam_particles_def particles;
  ASSERT_EQ(loam_particles_def_default(&particles, sizeof particles), LOAM_OK);
  particles.material = material;
  particles.count = scene.count();
  particles.positions = scene.positions.data();
  ASSERT_EQ(loam_particles_add(world.get(), &particles, nullptr), LOAM_OK);
  EXPECT_TRUE(has("solve sand"));
  EXPECT_TRUE(has("strain sand"));
}

TEST_F(SmallWorld, TheHashTellsStatesApart) {
  const std::uint64_t hash = world_.state_hash();
  EXPECT_EQ(world_.state_hash(), hash); // asking changes nothing
  const scenes::World other(definition(scene_), scene_);
  EXPECT_NE(other.state_hash(), hash);
}

} // namespace
} // namespace loam
