/* The elastica: an inextensible, unshearable beam bent far, clamped level at one end (Euler 1744; Love, A Treatise on the Mathematical Theory of
 * Elasticity, 1927, section 262). With t the slope at the arc length s of a beam of length 1, under its own weight and a force at its end, both across
 * the beam as it was at first,
 *   t'' = -(own_weight (1 - s) + tip_load) cos t,   t(0) = 0,   t'(1) = 0. */
#pragma once

namespace loam::reference {

/* Over the beam's length, and in radians. */
struct Elastica {
  double drop, shortening, end_slope;
};

/* `own_weight` = q L^3 / (E I) with q the weight a length, `tip_load` = P L^2 / (E I); both at least 0. Exact to about 1e-9. */
Elastica elastica(double own_weight, double tip_load = 0);

} // namespace loam::reference
