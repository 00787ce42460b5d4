/* A stream in a wind, around an attractor, blown apart once and taken out by killers: the same bits for any number of threads and any instruction set. */
#include <gtest/gtest.h>

#include "support/streams.h"

namespace loam {
namespace {

using streams::EmptyWorld;

std::uint64_t hash_of_a_blown_stream(std::uint32_t threads, std::uint32_t instruction_set) {
  EmptyWorld world(2000, threads, LOAM_SOLVER_GAUSS_SEIDEL, instruction_set);
  loam_emitter_def stream = streams::disc(world.material, 0.03f);
  stream.velocity_jitter = 0.1f;
  (void)world.add(stream);

  const auto add_field = [&](std::uint32_t kind, auto &&change) {
    loam_field_def def;
    EXPECT_EQ(loam_field_def_default(&def, sizeof def), LOAM_OK);
    def.kind = kind;
    def.position[0] = 0.05f;
    def.position[1] = 0.9f;
    change(def);
    loam_field_id id = 0;
    EXPECT_EQ(loam_field_create(world.world.get(), &def, &id), LOAM_OK) << loam_last_error();
  };
  add_field(LOAM_FIELD_WIND, [](loam_field_def &def) {
    def.velocity[0] = 2;
    def.velocity[2] = 0.3f;
    def.rate = 5;
  });
  add_field(LOAM_FIELD_ATTRACTOR, [](loam_field_def &def) {
    def.strength = 0.01f;
    def.softening = 0.02f;
  });
  add_field(LOAM_FIELD_BLAST, [](loam_field_def &def) {
    def.speed = 1;
    def.radius = 0.1f;
    def.time = 0.07f;
  });

  const auto add_killer = [&](std::uint32_t kind, auto &&change) {
    loam_killer_def def;
    EXPECT_EQ(loam_killer_def_default(&def, sizeof def), LOAM_OK);
    def.kind = kind;
    change(def);
    loam_killer_id id = 0;
    EXPECT_EQ(loam_killer_create(world.world.get(), &def, &id), LOAM_OK) << loam_last_error();
    return id;
  };
  const loam_killer_id sphere = add_killer(LOAM_KILLER_SPHERE, [](loam_killer_def &def) {
    def.position[1] = 0.9f;
    def.radius = 0.03f;
  });
  const loam_killer_id old = add_killer(LOAM_KILLER_AGE, [](loam_killer_def &def) { def.age = 0.09f; });

  for (int frame = 0; frame < 12; ++frame) world.world.step(0.01f);
  EXPECT_GT(world.world.statistics().particles, 50u);
  for (const loam_killer_id killer : {sphere, old}) {
    std::uint64_t total = 0, count = 0;
    EXPECT_EQ(loam_killer_get_killed(world.world.get(), killer, &total, nullptr, 0, &count), LOAM_OK);
    EXPECT_GT(total, 0u);
  }
  return world.world.state_hash();
}

TEST(FieldsAndKillers, HaveTheSameBitsForAnyThreadsAndInstructionSet) {
  const std::uint64_t expected = hash_of_a_blown_stream(1, LOAM_INSTRUCTION_SET_AUTO);
  for (const std::uint32_t threads : {2u, 5u})
    EXPECT_EQ(hash_of_a_blown_stream(threads, LOAM_INSTRUCTION_SET_AUTO), expected);
  for (const std::uint32_t set : streams::instruction_sets()) EXPECT_EQ(hash_of_a_blown_stream(1, set), expected) << set;
}

} // namespace
} // namespace loam
