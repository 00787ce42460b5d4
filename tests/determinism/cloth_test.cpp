/* Cloth has the same bits for any number of threads and any instruction set. */
#include <gtest/gtest.h>

#include "support/cloths.h"
#include "support/hooks.h"

namespace loam {
namespace {

/* A sheet that is held at a corner by a spring and falls on a floor in the wind, and another beside it that is torn apart; the hash of what it comes to. Null if the machine lacks the instruction set. */
std::uint64_t hash_of(std::uint32_t threads, std::uint32_t instruction_set) {
  loam_world_def def = cloths::world_def(5, 4);
  def.thread_count = threads;
  def.instruction_set = instruction_set;
  def.particle_capacity = 216;
  loam_world *made = nullptr;
  if (loam_world_create(&def, &made) != LOAM_OK) return 0;
  loam_world_destroy(made);
  scenes::World world(def);
  loam_collider_def floor;
  scenes::require(loam_collider_def_default(&floor, sizeof floor), "loam_collider_def_default");
  loam_collider_id id;
  scenes::require(loam_collider_create(world.get(), &floor, &id), "loam_collider_create");
  const cloths::Grid grid(37, 29, 0.01f);
  loam_cloth_def cloth_def = cloths::definition(grid);
  cloth_def.position[1] = 0.05f;
  cloth_def.self_distance = 0.012f;
  const cloths::Cloth cloth(world.get(), cloth_def);
  cloth.attach({grid.at(0, 0)}, {}, 0.01f);
  cloth.set_wind(3, 0, 1, 1, 0.5f);
  const cloths::Grid torn(12, 12, 0.02f, true);
  loam_cloth_def other_def = cloths::definition(torn);
  other_def.self_distance = 0.021f;
  other_def.greatest_stretch = 0.1f;
  other_def.tear_strain = 0.05f;
  const cloths::Cloth other(world.get(), other_def);
  other.attach({torn.at(0, 0), torn.at(12, 0)}, {-0.18f, 0, 0, 0.18f, 0, 0}, 1e-4f);
  world.add(scenes::drop_block(scenes::sand(), 6, 0.1f));
  for (int frame = 0; frame < (hooks::only_races ? 10 : 20); ++frame) world.step(1.0f / 60);
  EXPECT_TRUE(cloth.vertices().finite());
  EXPECT_GT(other.vertices().count(), 169u);
  return world.state_hash();
}

TEST(SameBitsOfCloth, ForAnyNumberOfThreadsAndInstructionSet) {
  const std::uint64_t expected = hash_of(2, LOAM_INSTRUCTION_SET_AUTO);
  if (hooks::only_races) return;
  EXPECT_EQ(hash_of(1, LOAM_INSTRUCTION_SET_AUTO), expected);
  EXPECT_EQ(hash_of(5, LOAM_INSTRUCTION_SET_AUTO), expected);
  for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set)
    if (const std::uint64_t hash = hash_of(1, set); hash != 0) {
      EXPECT_EQ(hash, expected) << set;
    }
}

} // namespace
} // namespace loam
