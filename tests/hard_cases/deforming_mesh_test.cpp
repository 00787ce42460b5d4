/* Colliders whose vertices move: a bag that is kneaded, a membrane that beats under a pile, skins that are moved without mercy. */
#include "hard_case.h"
#include "support/deforming.h"
#include "support/solids.h"

namespace loam {
namespace {

using meshes::Mesh;
using test::block;
using test::HardCase;
using test::Outcome;
using test::ten_seconds;
using test::without_planes;

/* A closed skin of 320 triangles around sand is squashed and twisted three times a second, and carried around in a circle at 1 m/s. */
TEST(DeformingMesh, ABagOfSandThatIsKneaded) {
  test::shows("a closed bag of sand squashed by a third and twisted three times a second, ten seconds: none outside");
  const Mesh skin = meshes::icosphere(0.032f, 2);
  scenes::Scene sand = without_planes(block(scenes::sand(), 3, 0));
  for (std::size_t i = 1; i < sand.positions.size(); i += 3) sand.positions[i] += 1 - 0.015f;
  HardCase hard = ten_seconds({sand});
  hard.collider_speed = 2;
  loam_collider_id id = 0;
  hard.prepare = [&](scenes::World &world) {
    id = deforming::add(world, skin);
    const float at[3] = {0, 1, 0}, upright[4] = {0, 0, 0, 1};
    scenes::require(loam_collider_place(world.get(), id, at, upright), "place");
  };
  const auto shape = [&](int frame) {
    const float phase = 6.2832f * 3 * float(frame) / 60;
    return deforming::squashed(skin, 0.33f * std::sin(phase), 8 * std::sin(0.7f * phase));
  };
  const auto place = [](int frame, float(&at)[3]) {
    const float angle = float(std::max(0, frame - 30)) / 60 / 0.3f;
    at[0] = 0.3f * std::sin(angle);
    at[1] = 1;
    at[2] = 0.3f * (1 - std::cos(angle));
  };
  std::size_t outside = 0;
  hard.each = [&](scenes::World &world, int frame) {
    float at[3];
    if (frame % 5 == 0) {
      place(frame, at);
      outside += test::outside(world.snapshot().positions, shape(frame), at);
    }
    const float upright[4] = {0, 0, 0, 1};
    place(frame + 1, at);
    scenes::require(loam_collider_move(world.get(), id, at, upright), "move");
    deforming::move(world, id, shape(frame + 1));
  };
  std::uint64_t hash = 0;
  const Outcome outcome = test::run_once(hard, hash);
  test::record(outcome, hard.steps / 60.0);
  EXPECT_EQ(outside, 0u);
}

/* A pile between four walls on a membrane one triangle thick that beats up and down by 2 cm five times a second: at 2 g, so that the pile is thrown and caught. At once: its
 * vertices are placed where they would have been moved to. */
std::size_t below_a_beating_membrane(bool at_once, int frames, Outcome &outcome) {
  const Mesh membrane = meshes::sheet(0.06f, 10);
  scenes::Scene sand = block(scenes::sand(), 4, 0.005f);
  sand.planes = {{{-0.03f, 0, 0}, {1, 0, 0}, 0.2f},
                 {{0.03f, 0, 0}, {-1, 0, 0}, 0.2f},
                 {{0, 0, -0.03f}, {0, 0, 1}, 0.2f},
                 {{0, 0, 0.03f}, {0, 0, -1}, 0.2f}};
  HardCase hard = ten_seconds({sand});
  hard.collider_speed = 1;
  hard.steps = std::min(hard.steps, frames);
  loam_collider_id id = 0;
  hard.prepare = [&](scenes::World &world) { id = deforming::add(world, membrane); };
  const auto height = [](float x, float z, int frame) {
    const double time = frame / 60.0, bulge = 1 - std::pow(double(std::hypot(x, z)) / 0.085, 2);
    return float(0.02 * bulge * std::sin(2 * 3.14159265 * 5 * time));
  };
  std::size_t below = 0;
  hard.each = [&](scenes::World &world, int frame) {
    deforming::move(world, id, deforming::moved(membrane, [&](float *x) { x[1] = height(x[0], x[2], frame + 1); }), at_once);
    if (frame % 5 != 0) return;
    const std::vector<float> positions = world.snapshot().positions;
    for (std::size_t i = 0; i < positions.size(); i += 3)
      below +=
          positions[i + 1] < height(positions[i], positions[i + 2], frame) - 0.002f ? 1 : 0; // facets cut the paraboloid
  };
  std::uint64_t hash = 0;
  outcome = test::run_once(hard, hash);
  test::record(outcome, hard.steps / 60.0);
  return below;
}

TEST(DeformingMesh, AMembraneThatBeatsUnderAPile) {
  test::shows("a membrane one triangle thick beating five times a second by 2 cm under a pile, ten seconds: none below");
  Outcome outcome;
  EXPECT_EQ(below_a_beating_membrane(false, 600, outcome), 0u);
  EXPECT_GT(outcome.peak_speed, 0.6); // it is thrown
}
TEST(DeformingMesh, AMembraneThatJumpsUnderAPileLeavesItBehind) {
  test::shows(
      "the same membrane placed frame by frame instead of moved: a jump carries nothing, and the pile falls through");
  Outcome outcome;
  EXPECT_GT(below_a_beating_membrane(true, 60, outcome), 10u);
}

} // namespace
} // namespace loam
