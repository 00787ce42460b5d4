/* Solids of every kind in sand: it falls onto each, then each is driven and turned through it. None may get inside. */
#include "hard_case.h"
#include "support/solids.h"

namespace loam {
namespace {

using solids::Solid;
using test::block;
using test::HardCase;
using test::Outcome;
using test::survive;

class SolidCollider : public test::OfASolver {};
INSTANTIATE_TEST_SUITE_P(Solvers, SolidCollider, test::both_solvers(), test::solver_name);

TEST_P(SolidCollider, IsBuriedAndDrivenThroughAHeap) {
  test::shows("every kind of solid under falling sand, then driven and turned through it: none inside");
  for (const Solid &solid : solids::of_every_kind()) {
    if (solid.name == "plane") continue; // the ground of every other case
    SCOPED_TRACE(solid.name);
    HardCase hard(GetParam(), {block(scenes::sand(), 6, 0.1f)});
    hard.steps = 60;
    loam_collider_id id = 0;
    float position[3], rotation[4];
    std::size_t near = 0;
    hard.prepare = [&](scenes::World &world) {
      loam_collider_def def = solid.definition();
      const float start[7] = {0, 0.05f, 0, 0, 0, 0, 1};
      std::copy(start, start + 3, position);
      std::copy(start + 3, start + 7, rotation);
      std::copy(position, position + 3, def.position);
      scenes::require(loam_collider_create(world.get(), &def, &id), "collider");
    };
    hard.each = [&](scenes::World &world, int step) {
      if (step % 5 == 4) {
        const std::vector<float> at = world.snapshot().positions;
        for (std::size_t i = 0; i < at.size(); i += 3) {
          const solids::Point local = solids::to_local(&at[i], position, rotation);
          EXPECT_GT(solid.distance(local), 0) << "step " << step;
          near += std::hypot(local[0], local[1], local[2]) < 0.06 ? 1 : 0;
        }
      }
      const float along = std::max(0.0f, float(step - 24) / 120), half = 4 * along; // 1 m/s at most, 8 rad/s
      position[0] = 0.04f * std::sin(20 * along);
      position[1] = step == 0 ? 0.05f : 0.05f + 0.02f * std::sin(9 * along);
      rotation[0] = 0.6f * std::sin(half);
      rotation[2] = 0.8f * std::sin(half);
      rotation[3] = std::cos(half);
      scenes::require(loam_collider_move(world.get(), id, position, rotation), "move");
    };
    const Outcome outcome = survive(hard);
    EXPECT_GT(outcome.lowest, 0.0);
    EXPECT_GT(near, 200u);
    EXPECT_LT(outcome.peak_speed, 6);
  }
}

} // namespace
} // namespace loam
