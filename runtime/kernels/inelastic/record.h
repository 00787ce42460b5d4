// The record that an inelastic constraint keeps during a substep, as fields of a team's item. On the CPU a record is spread over a batch
// (field by field, a lane each); on CUDA it is contiguous. How many fields there are depends on the multiplier form: a world keeps no more than it needs.
#pragma once

namespace loam {

struct Record {
  enum Field : int {
    strain = 0,            // 6: b - I at the start of the substep
    gradient_square = 6,   // 6: M = sum_b w_b G_b G_b^T
    gradient_sum = 12,     // 3: s = sum_b G_b
    inverse_mass = 15,     // of the particle as the constraint sees it: split among constraints for Jacobi
    inverse_volume = 16,   // 1 / V0
    history = 17,          // of the law, at the start of the substep
    close_count = 18,      // how many neighbours, first in the list, position correction looks at
    pair_moment = 19,      // sum of (impulse . up)(distance . up) of position correction: its share of the virial
    unknown = 20,          // 3: directions in which nothing is known of the gradient, see kinematics.h
    multiplier = 23,       // state of the multiplier form: 1 float for the scalar form, 9 for the tensor
    drift_multiplier = 32, // 3: non-affine displacement that the impulses have answered, see non_affine.h
    drift = 35,            // 3: non-affine displacement at the start of the substep
    weight_moment = 38,    // 3: m
    weight_scale = 41,     // kappa
    drift_response = 42,   // nu
    field_count = 44       // with one to spare
  };
};

// Fields of a record that holds `multiplier` and, if asked for, what resists zero-energy modes.
constexpr int record_size(int multiplier_state, bool non_affine) {
  return non_affine ? static_cast<int>(Record::field_count) : Record::multiplier + multiplier_state;
}

} // namespace loam
