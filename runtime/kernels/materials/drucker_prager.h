// Drucker-Prager: a cone around the pressure axis (Klar et al. 2016), its tip shifted by the cohesion, with the volume correction of
// Tampubolon et al. 2017: expansion that the tip discards is remembered and must be undone before pressure builds up again.
//
//   |dev e| <= slope * (tip - tr e)      slope = alpha 3K / (2 mu),  alpha = sqrt(2/3) 2 sin(phi) / (3 - sin(phi))
//                                         tip = c cot(phi) / K
#pragma once

#include "kernels/materials/law.h"
#include "math/scalar.h"

namespace loam {

struct DruckerPrager : Isotropic {
  static constexpr bool plastic = true;
  static constexpr bool has_history = true;                // the volume gained at the tip, as a logarithm
  static constexpr bool resists_zero_energy_modes = false; // grains that move apart are loose
  static constexpr double greatest_strain = 0.5;
  float slope;
  float cohesive_deviator; // slope * tip, given apart because the tip runs to infinity as phi goes to 0
  float tip;

  template <class T> LOAM_FN T elastic_trace(T trace, T history) const { return trace + history; }

  template <class T> LOAM_FN Mapped<T> map(T trace, T deviator_norm, T, Flow<T>) const {
    const T zero(0.0f);
    const T limit = T(cohesive_deviator) - T(slope) * trace;
    const T scale = select(deviator_norm > limit, limit / maximum(deviator_norm, T(1e-30f)), T(1.0f));
    const auto beyond_tip = trace >= T(tip);
    return {select(beyond_tip, T(tip), trace), select(beyond_tip, zero, scale), select(beyond_tip, trace - T(tip), zero)};
  }
};

} // namespace loam
