/* Where a stream's momentum goes. */
#include "support/streams.h"

namespace loam {
namespace {

struct Jet {
  double entered = 0; // momentum of what the nozzle has let go of, downwards
  double left = 0;    // of it, in what flies
  double plate = 0;   // taken by the plate
};

/* A jet of sand at 1 m/s without gravity, 3 cm in radius, for 0.35 s; the plate is 20 cm below the nozzle. */
Jet shoot(bool has_plate) {
  streams::EmptyWorld jet(4000);
  const float none[3] = {};
  EXPECT_EQ(loam_world_set_gravity(jet.world.get(), none), LOAM_OK);
  (void)jet.add(streams::disc(jet.material, 0.03f));
  loam_collider_def def;
  EXPECT_EQ(loam_collider_def_default(&def, sizeof def), LOAM_OK);
  def.position[1] = has_plate ? 0.8f : -10.0f;
  def.reaction = 1;
  loam_collider_id plate = 0;
  EXPECT_EQ(loam_collider_create(jet.world.get(), &def, &plate), LOAM_OK);
  Jet result;
  for (int frame = 0; frame < 42; ++frame) {
    jet.world.step(1.0f / 120);
    loam_collider_reaction reaction = {};
    reaction.struct_size = sizeof reaction;
    EXPECT_EQ(loam_collider_get_reaction(jet.world.get(), plate, &reaction), LOAM_OK);
    result.plate -= reaction.impulse[1];
  }
  jet.look([&](const loam_particle_view &view) {
    for (std::uint64_t i = 0; i < view.count; ++i) {
      const double inverse_mass = double(view.velocities[4 * i + 3]);
      if (inverse_mass == 0) continue; // the nozzle leads it
      result.entered += 1 / inverse_mass;
      result.left -= double(view.velocities[4 * i + 1]) / inverse_mass;
    }
  });
  return result;
}

TEST(Stream, ItsMomentumEndsInWhatItHits) {
  const Jet jet = shoot(true), free = shoot(false);
  EXPECT_NEAR(jet.left + jet.plate, jet.entered, 0.01 * jet.entered);
  EXPECT_GT(jet.plate, 0.3 * jet.entered); // and not by chance
  EXPECT_EQ(free.plate, 0);
  EXPECT_NEAR(free.left, free.entered, 1e-5 * free.entered);
  EXPECT_NEAR(free.entered, jet.entered, 1e-6 * jet.entered);
}

} // namespace
} // namespace loam
