// The record that an inelastic constraint keeps during a substep, as fields of a team's item. On the CPU a record is spread over a batch
// (field by field, a lane each); on CUDA it is contiguous.
#pragma once

namespace loam {

struct Record {
  enum Field : int {
    strain = 0,          // 6: b - I at the start of the substep
    gradient_square = 6, // 6: M = sum_b w_b G_b G_b^T
    gradient_sum = 12,   // 3: s = sum_b G_b
    inverse_mass = 15,   // of the particle as the constraint sees it: split among constraints for Jacobi
    inverse_volume = 16, // 1 / V0
    history = 17,        // of the law, at the start of the substep
    close_count = 18,    // how many neighbours, first in the list, position correction looks at
    pair_moment = 19,    // sum of (impulse . up)(distance . up) of position correction: its share of the virial
    multiplier = 20,     // state of the multiplier form: 1 float for the scalar form
    field_count = 21
  };
};

} // namespace loam
