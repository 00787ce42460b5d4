#include "elastica.h"

#include <cmath>
#include <gtest/gtest.h>

namespace {

using loam::reference::elastica;

/* Own weight: tables made by others' integration; tip load: Bisshopp and Drucker 1945, by elliptic integrals. */
TEST(Elastica, IsThatOfTheTables) {
  const double loads[] = {0.5, 1, 2, 5, 10}, drops[] = {0.06231, 0.12347, 0.23851, 0.49591, 0.70020},
               shortenings[] = {0.00222, 0.00875, 0.03311, 0.15334, 0.34365};
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(elastica(loads[k]).drop, drops[k], 1e-5);
    EXPECT_NEAR(elastica(loads[k]).shortening, shortenings[k], 1e-5);
  }
  const double tips[] = {1, 2, 5, 10}, tip_drops[] = {0.30172, 0.49346, 0.71379, 0.81061};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(elastica(0, tips[k]).drop, tip_drops[k], 1e-5);
}

TEST(Elastica, BendsByTheLinearTheoryUnderSmallLoads) {
  EXPECT_NEAR(elastica(1e-3).drop, 1e-3 / 8, 1e-9);
  EXPECT_NEAR(elastica(0, 1e-3).drop, 1e-3 / 3, 1e-9);
  EXPECT_NEAR(elastica(0, 1e-3).end_slope, 1e-3 / 2, 1e-9);
}

/* t'^2 / 2 + P sin t does not change along a beam loaded at its tip, and t'(0) = P (1 - shortening) by the balance of moments. */
TEST(Elastica, KeepsItsFirstIntegral) {
  const double load = 7;
  const auto end = elastica(0, load);
  EXPECT_NEAR(std::pow(load * (1 - end.shortening), 2) / 2, load * std::sin(end.end_slope), 1e-7);
}

} // namespace
