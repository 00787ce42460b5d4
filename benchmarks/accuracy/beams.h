/* The beams of the study, and where the exact solvers have them. They are of one shape, bent by one share of their length: gravity is the stronger the stiffer they
 * are, and so is what a substep asks of the iterations. */
#pragma once

#include <string>
#include <vector>

#include "physics/exact_beam.h"

namespace loam::accuracy {

struct Beam {
  std::string name;
  test::Cantilever cantilever;
};

/* E of 1e4, 1e5 and 1e6 Pa; quick: the middle one. */
std::vector<Beam> beams(bool quick);

/* The equilibrium of the particles of all of them, found once. The scalar multiplier has no control of zero-energy modes, so its own is without. */
const reference::Vectors &settled_beam(std::uint32_t multiplier);

double exact_drop(std::uint32_t multiplier);

/* Of the continuous body, by finite elements. */
double finite_element_drop(const test::Cantilever &beam);

} // namespace loam::accuracy
