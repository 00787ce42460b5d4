/* A block of snow (Stomakhin et al. 2013, its first row of parameters) thrown flat onto the ground is left with the same shape at ten times the
 * substep; with plasticity once at the end of a substep it is not, since then a substep's stress is that of snow which does not yield. Its shape is
 * taken as it flies up again, undisturbed: by how much it rebounds depends on the substep (implicit steps damp waves), and so how it tumbles later. */
#include "granular.h"

#include <gtest/gtest.h>
#include <string>

namespace loam {
namespace {

struct Shape {
  double width, height; // within which the middle 94 % of the particles lie, in spacings

  /* The greatest difference, as a share of the extent. */
  double difference(const Shape &other) const {
    return std::max(std::fabs(width - other.width) / other.width, std::fabs(height - other.height) / other.height);
  }
};

/* After a hit of 6 m/s, in substeps of `substep`: r / substep is 20 m/s at the longest used here. */
Shape thrown(double substep, std::uint32_t plasticity) {
  loam_material_def snow;
  scenes::require(loam_material_def_default(LOAM_LAW_STOMAKHIN_SNOW, &snow, sizeof snow), "loam_material_def_default");
  snow.density = 400;
  snow.youngs_modulus = 5e5f;
  snow.poissons_ratio = 0.2f;
  snow.hardening_factor = 10;
  snow.critical_compression = 0.025f;
  snow.critical_stretch = 0.0075f;
  const float spacing = 0.02f;
  const scenes::Scene scene = scenes::drop_block(snow, 8, spacing / 2, 6, {.spacing = spacing});
  loam_world_def def = scenes::world_def(scene);
  def.plasticity = plasticity;
  constexpr double frame = 0.005;
  def.substeps = std::uint32_t(std::lround(frame / substep));
  scenes::World world(def, scene);
  const auto shape = [&] {
    const std::vector<float> now = world.snapshot().positions;
    const auto extent = [&](std::size_t axis) {
      return (test::quantile(now, axis, 0.97) - test::quantile(now, axis, 0.03)) / double(spacing);
    };
    return Shape{extent(0), extent(1)};
  };
  const auto run = [&](double seconds) {
    for (int k = 0; k < int(std::lround(seconds / frame)); ++k) world.step(float(frame));
  };
  run(0.02);
  const Shape early = shape();
  run(0.01);
  EXPECT_LT(shape().difference(early), 0.02); // nothing yields any more
  EXPECT_EQ(world.statistics().non_finite, 0u);
  return shape();
}

/* Between substeps of 1e-4 and 1e-3 s. */
double difference(std::uint32_t plasticity) {
  const Shape fine = thrown(1e-4, plasticity), coarse = thrown(1e-3, plasticity);
  testing::Test::RecordProperty("height_at_1e_4", std::to_string(fine.height));
  testing::Test::RecordProperty("height_at_1e_3", std::to_string(coarse.height));
  testing::Test::RecordProperty("difference", std::to_string(coarse.difference(fine)));
  EXPECT_LT(fine.height, 0.95 * fine.width); // it was a cube: the hit has crushed it
  return coarse.difference(fine);
}

TEST(Snow, KeepsItsShapeAtTenTimesTheSubstep) { EXPECT_LT(difference(LOAM_PLASTICITY_IMPLICIT), 0.05); }

TEST(Snow, WithSemiImplicitPlasticityItsShapeFollowsTheSubstep) { // the control
  EXPECT_GT(difference(LOAM_PLASTICITY_SEMI_IMPLICIT), 0.05);
}

} // namespace
} // namespace loam
