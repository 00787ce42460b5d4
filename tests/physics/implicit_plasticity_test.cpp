/* A notched block of damp sand (figure 9 of the paper): what is over the notch breaks off and comes down. With plasticity outside of the iterations the stress of
 * a substep is the elastic one, so that the matter holds together, the more so the stiffer it is. */
#include "figure.h"

namespace loam {
namespace {

using test::Points;
using test::Solid;

struct Fall {
  double drop;    // of what is over the notch, in spacings
  double severed; // share of the pairs of neighbours that are apart now
};

Fall fall(float youngs_modulus, std::uint32_t plasticity) {
  const float spacing = 0.01f;
  Points points;
  points.flush[2] = true;
  const std::vector<float> start = test::cut(points.box({0, 0, 0}, {16, 22, 3}), spacing,
                                             [](float x, float y, float) { return x < 8 || y < 4 || y > 9; });
  loam_material_def material = scenes::sand(35, youngs_modulus);
  material.cohesion = 400;
  Solid block(material, start);
  block.scene.planes = {{{0, 0, 0}, {0, 1, 0}, 0.7f}, {{0, 0, 0}, {0, 0, 1}, 0}, {{0, 0, 3 * spacing}, {0, 0, -1}, 0}};
  block.def.gravity[1] = -9.81f;
  block.def.substeps = 20;
  block.def.plasticity = plasticity;
  scenes::World world = block.make();
  for (int frame = 0; frame < 30; ++frame) world.step(0.01f);

  const scenes::Snapshot now = world.snapshot();
  const auto distance = [&](const std::vector<float> &at, std::size_t a, std::size_t b) {
    return std::hypot(at[3 * a] - at[3 * b], at[3 * a + 1] - at[3 * b + 1], at[3 * a + 2] - at[3 * b + 2]);
  };
  double drop = 0, over = 0, severed = 0, pairs = 0;
  for (std::size_t a = 0; a < now.count(); ++a) {
    if (start[3 * a] > 8 * spacing && start[3 * a + 1] > 9 * spacing) {
      drop += double(start[3 * a + 1] - now.positions[3 * a + 1]) / double(spacing);
      ++over;
    }
    for (std::size_t b = a + 1; b < now.count(); ++b) {
      if (distance(start, a, b) > 1.3f * spacing) continue;
      ++pairs;
      severed += distance(now.positions, a, b) > 2 * spacing ? 1 : 0;
    }
  }
  return {drop / over, severed / pairs};
}

TEST(NotchedBlock, BreaksAlikeHoweverStiffItIs) {
  const Fall soft = fall(2e5f, LOAM_PLASTICITY_IMPLICIT), stiff = fall(2e6f, LOAM_PLASTICITY_IMPLICIT);
  for (const Fall &block : {soft, stiff}) {
    EXPECT_GT(block.drop, 9);
    EXPECT_GT(block.severed, 0.05);
  }
  RecordProperty("drop", std::to_string(soft.drop) + " " + std::to_string(stiff.drop));
  RecordProperty("severed", std::to_string(soft.severed) + " " + std::to_string(stiff.severed));
  EXPECT_NEAR(stiff.drop / soft.drop, 1, 0.05);
}

TEST(NotchedBlock, WithSemiImplicitPlasticityItHangsTogether) {
  const Fall soft = fall(2e5f, LOAM_PLASTICITY_SEMI_IMPLICIT), stiff = fall(2e6f, LOAM_PLASTICITY_SEMI_IMPLICIT);
  RecordProperty("drop", std::to_string(soft.drop) + " " + std::to_string(stiff.drop));
  RecordProperty("severed", std::to_string(soft.severed) + " " + std::to_string(stiff.severed));
  EXPECT_LT(stiff.severed, 0.01);
  EXPECT_LT(stiff.drop, 0.75 * soft.drop);
}

} // namespace
} // namespace loam
