// The opening of an emitter: places on a square lattice at right angles to the flow.
#pragma once

#include <vector>

#include <loam/emitter.h>

#include "math/vector.h"

namespace loam {

struct Nozzle {
  std::vector<Vec3<double>> places;  // from the nozzle's position
  Vec3<double> along{}, across[2]{}; // the flow's direction and the lattice's axes, of length 1
  double area = 0;                   // m^2, at right angles to the flow
};

// Throws Error INVALID_ARGUMENT or INVALID_MESH naming the field; CAPACITY if there are more than `most` places.
Nozzle make_nozzle(const loam_emitter_def &def, double spacing, std::uint64_t most);

} // namespace loam
