// What every constitutive law offers to the kernels.
//
// All laws share the energy psi = mu |e|^2 + lambda/2 tr(e)^2 of the Hencky strain e. A law derives from Isotropic, which holds the moduli and
// the defaults, and adds a return mapping:
//
//   plastic             false: there is no mapping
//   has_history         the law keeps one number a particle between substeps; kernels read it at the start of a substep and advance it at its end
//   greatest_strain     bound on the trial's principal Hencky strains; a stability guard, see StrainLimit
//   resists_zero_energy_modes   see non_affine.h
//   principal           false: the mapping moves only the trace of e and scales its deviator, and is given by these two invariants:
//                         Mapped<T> map(T trace, T deviator_norm, T history, Flow<T> flow) const     trial in, projected out
//                       true: it moves the principal strains one by one:
//                         T map_principal(T (&strain)[3], T history, Flow<T> flow) const   trial in, projected out; the history at the end
//                         may_move(T lower, T upper)   a mask: whether it may move a strain between these bounds
//   initial_history()               the history of particles when they are made
//   elastic_trace(trace, history)   the trace that causes stress; what map() is given
//   stiffness(history)              factor on both moduli
#pragma once

#include "math/qualifiers.h"

namespace loam {

struct LameParameters {
  float mu;     // shear modulus, Pa
  float lambda; // first Lame parameter, Pa
};

// The projected strain: (trace / 3) I + scale * (trial deviator), and the history at the end of the substep.
template <class T> struct Mapped { T trace, scale, history; };

// How a mapping is used. Inside the iterations the stress of a constraint answers to plastic strain with only a share of the modulus, because part
// of what it gives way moves the neighbours; at the end of a substep the shares are 1. Mappings in which plastic strain appears by itself
// (a viscosity, a hardening) divide by the share.
template <class T> struct Flow {
  float substep; // s
  T deviatoric, volumetric;
};

struct Isotropic {
  static constexpr bool plastic = false;
  static constexpr bool has_history = false;
  static constexpr bool principal = false;
  static constexpr bool resists_zero_energy_modes = true;
  LameParameters lame;

  LOAM_FN float initial_history() const { return 0.0f; }
  template <class T> LOAM_FN T elastic_trace(T trace, T) const { return trace; }
  template <class T> LOAM_FN T stiffness(T) const { return T(1.0f); }
  LOAM_FN float twice_mu() const { return 2.0f * lame.mu; }
  LOAM_FN float bulk() const { return lame.lambda + 2.0f / 3.0f * lame.mu; }
};

} // namespace loam
