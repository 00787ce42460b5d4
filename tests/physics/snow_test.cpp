/* A block of snow (Stomakhin et al. 2013, its first row of parameters) thrown flat onto the ground is left with the same shape at ten times the
 * substep; with plasticity once at the end of a substep it is not, since then a substep's stress is that of snow which does not yield. Its shape is
 * taken as it flies up again, undisturbed: by how much it rebounds depends on the substep (implicit steps damp waves), and so how it tumbles later. */
#include "thrown_snow.h"

#include <gtest/gtest.h>
#include <string>

namespace loam {
namespace {

/* Between substeps of 1e-4 and 1e-3 s. */
double difference(std::uint32_t plasticity) {
  const auto thrown = [&](double substep) {
    const test::ThrownSnow snow = test::thrown_snow(substep, plasticity);
    EXPECT_LT(snow.changing, 0.02); // nothing yields any more
    return snow.shape;
  };
  const test::Shape fine = thrown(1e-4), coarse = thrown(1e-3);
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
