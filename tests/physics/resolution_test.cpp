/* The same column of sand at several resolutions (figure 16 of the paper): it comes to rest in the same shape. */
#include "figure.h"

namespace loam {
namespace {

/* The root mean square distance of its matter from the axis, metres, of a column 0.08 m in radius and height. */
double spread(int layers, float friction_degrees = 30, std::uint32_t plasticity = LOAM_PLASTICITY_IMPLICIT) {
  scenes::Lattice lattice;
  lattice.spacing = 0.08f / float(layers);
  const scenes::Scene column = scenes::axisymmetric_column(scenes::sand(friction_degrees), layers, 1, 0.6f, lattice);
  loam_world_def def = scenes::world_def(column);
  def.substeps = 10;
  def.plasticity = plasticity;
  scenes::World world(def, column);
  for (int frame = 0; frame < 40; ++frame) world.step(0.01f);
  const scenes::Snapshot now = world.snapshot();
  double sum = 0;
  for (std::size_t i = 0; i < now.positions.size(); i += 3)
    sum += double(now.positions[i]) * double(now.positions[i]) + double(now.positions[i + 2]) * double(now.positions[i + 2]);
  return std::sqrt(sum / double(now.count()));
}

TEST(Resolution, AColumnComesToRestInTheSameShape) {
  const double coarse = spread(6), medium = spread(8), fine = spread(12); // 624, 1664, 5376 particles
  RecordProperty("spread", std::to_string(coarse) + " " + std::to_string(medium) + " " + std::to_string(fine));
  EXPECT_NEAR(medium, fine, 0.04 * fine);
  EXPECT_NEAR(coarse, fine, 0.08 * fine);
  EXPECT_LT(std::fabs(fine - medium), std::fabs(medium - coarse)); // and the differences fall
  // The controls: they are smaller than what another matter or method makes.
  const double smoother = spread(8, 25), jelly = spread(8, 30, LOAM_PLASTICITY_SEMI_IMPLICIT);
  RecordProperty("controls", std::to_string(smoother) + " " + std::to_string(jelly));
  EXPECT_GT(smoother, 1.04 * medium);
  EXPECT_LT(jelly, 0.85 * fine);
}

} // namespace
} // namespace loam
