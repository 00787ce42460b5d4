// Von Mises: the Frobenius norm of the deviatoric Kirchhoff stress, 2 mu |dev e|, is bounded. Radial return, for example Simo and Hughes,
// "Computational Inelasticity", chapter 3. The uniaxial yield stress is sqrt(3/2) times the bound.
#pragma once

#include "kernels/materials/law.h"
#include "math/scalar.h"

namespace loam {

struct VonMises : Isotropic {
  static constexpr bool plastic = true;
  static constexpr double greatest_strain = 0.5;
  float greatest_deviator; // |dev e| at yield: sqrt(2/3) yield_stress / (2 mu)

  template <class T> LOAM_FN Mapped<T> map(T trace, T deviator_norm, T history, Flow<T>) const {
    const T limit(greatest_deviator);
    return {trace, select(deviator_norm > limit, limit / maximum(deviator_norm, limit), T(1.0f)), history};
  }
};

} // namespace loam
