// What every constitutive law offers to the kernels.
//
// All laws share the energy psi = mu |e|^2 + lambda/2 tr(e)^2 of the Hencky strain e. A law adds a return mapping; for the isotropic laws here
// it moves only the trace of e and scales its deviator, so it is given as a function of these two invariants:
//
//   Mapped<T> map(T trace, T deviator_norm, T history) const   trial strain in, projected strain out
//   plastic           false: map() is the identity and is left out
//   has_history       the law keeps one number a particle between substeps
//   greatest_strain   bound on the trial's principal Hencky strains; a stability guard, see StrainLimit
#pragma once

#include "math/qualifiers.h"

namespace loam {

struct LameParameters {
  float mu;     // shear modulus, Pa
  float lambda; // first Lame parameter, Pa
};

// The projected strain: (trace / 3) I + scale * (trial deviator), and the history at the end of the substep.
template <class T> struct Mapped { T trace, scale, history; };

} // namespace loam
