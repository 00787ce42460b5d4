// Snow of Stomakhin, Schroeder, Chai, Teran, Selle 2013, "A material point method for snow simulation": the principal stretches stay within
// [1 - theta_c, 1 + theta_s], and both moduli are multiplied by exp(xi (1 - J_p)) with J_p the plastic volume change: packed snow is hard, torn snow
// soft. The energy is that of all laws here, not the paper's corotated one; within stretches of a few percent they agree.
//
// Bounded for stability: the exponent to [-3, 3] (moduli between 1/20 and 20 times those given), J_p to [0.1, 10].
#pragma once

#include "kernels/materials/law.h"
#include "math/functions.h"
#include "math/tensor_functions.h"

namespace loam {

struct StomakhinSnow : Isotropic {
  static constexpr bool plastic = true;
  static constexpr bool has_history = true; // J_p - 1
  static constexpr bool principal = true;
  static constexpr double greatest_strain = 0.5;
  float least, most; // principal Hencky strain: log(1 - theta_c), log(1 + theta_s)
  float hardening;   // xi

  template <class T> LOAM_FN T stiffness(T history) const {
    return exponential(minimum(maximum(T(-hardening) * history, T(-3.0f)), T(3.0f)));
  }

  // Whether a principal strain between these two bounds may be moved.
  template <class T> LOAM_FN auto may_move(T lower, T upper) const { return either(lower<T(least), upper> T(most)); }

  template <class T> LOAM_FN T map_principal(T (&strain)[3], T history, Flow<T>) const {
    T moved(0.0f);
    for (T &e : strain) {
      const T clamped = minimum(maximum(e, T(least)), T(most));
      moved = moved + (e - clamped);
      e = clamped;
    }
    const T change = history + (history + T(1.0f)) * expm1_series(moved);
    return minimum(maximum(change, T(-0.9f)), T(9.0f));
  }
};

} // namespace loam
