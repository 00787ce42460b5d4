// Von Mises: the Frobenius norm of the deviatoric Kirchhoff stress, 2 mu |dev e|, is bounded. Radial return, for example Simo and Hughes,
// "Computational Inelasticity", chapter 3. The uniaxial yield stress is sqrt(3/2) times the bound.
//
// With linear isotropic hardening the yield stress grows with the equivalent plastic strain p, p' = sqrt(2/3) |plastic strain rate|:
//
//   2 mu |dev e| <= sqrt(2/3) (yield_stress + modulus p)
//
// and the radial return stays a closed form. Matter without hardening has a law of its own, which needs no history.
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

struct VonMisesHardening : Isotropic {
  static constexpr bool plastic = true;
  static constexpr bool has_history = true; // the equivalent plastic strain
  static constexpr double greatest_strain = 0.5;
  float first_deviator; // |dev e| at first yield: sqrt(2/3) yield_stress / (2 mu)
  float growth;         // of that with the equivalent plastic strain: sqrt(2/3) modulus / (2 mu)

  template <class T> LOAM_FN Mapped<T> map(T trace, T deviator_norm, T history, Flow<T> flow) const {
    const T zero(0.0f), root(0.81649658f); // sqrt(2/3)
    const T limit = T(first_deviator) + T(growth) * history;
    const T over = maximum(deviator_norm - limit, zero);
    // A plastic strain of norm x lowers |dev e| by share x and raises the limit by growth sqrt(2/3) x.
    const T plastic_strain = over / (flow.deviatoric + T(growth) * root);
    const T norm = deviator_norm - flow.deviatoric * plastic_strain;
    const T scale = select(over > zero, norm / maximum(deviator_norm, T(1e-30f)), T(1.0f));
    return {trace, scale, history + root * plastic_strain};
  }
};

} // namespace loam
