// NACC, non-associated Cam-Clay: snow, clay, brittle candy. Wolper, Fang, Li, Lu, Gao, Jiang 2019, "CD-MPM: Continuum Damage Material Point Methods
// for Dynamic Fracture Animation".
//
// With the pressure p = -K tr e and q = sqrt(3/2) 2 mu |dev e|, stress stays within the ellipse
//
//   (1 + 2 beta) q^2 + M^2 (p + beta p0)(p - p0) <= 0,     p0 = K (1e-5 + sinh(xi max(-alpha, 0)))
//
// alpha, the history, is the logarithm of the plastic volume change: compaction lowers it and hardens, opening raises it and softens, until at 0 the
// matter bears no tension any more. Trial stresses are mapped in three cases:
//
//   p > p0        to the compressive tip. The tip moves away meanwhile: solved together with alpha, or hardening would overshoot
//   p < -beta p0  to the tensile tip; alpha takes the volume
//   otherwise     at constant p onto the ellipse, which keeps the volume; alpha takes the distance in p to where the line from the ellipse's centre
//                 to the trial stress crosses the ellipse
//
// Bounded for stability: xi max(-alpha, 0) to 2, where p0 = 3.6 K lies beyond every strain that StrainLimit admits, and alpha to 1.
#pragma once

#include "kernels/materials/law.h"
#include "math/functions.h"

namespace loam {

struct Nacc : Isotropic {
  static constexpr bool plastic = true;
  static constexpr bool has_history = true; // alpha
  static constexpr double greatest_strain = 0.5;
  static constexpr float greatest_argument = 2.0f, least_size = 1e-5f;
  float start;           // alpha of new particles
  float cohesion;        // beta
  float hardening;       // xi
  float hardens;         // 1, or 0: alpha never changes
  float shear_ratio;     // q / K over |dev e|: sqrt(3/2) 2 mu / K
  float slope_squared;   // M^2 / (1 + 2 beta)
  float inverse_squared; // (1 + 2 beta) / M^2

  LOAM_FN float initial_history() const { return start; }

  template <class T> LOAM_FN Mapped<T> map(T trace, T deviator_norm, T alpha, Flow<T> flow) const {
    // All pressures over K.
    const T zero(0.0f), one(1.0f), half(0.5f);
    const T size = T(least_size) + sinh_to_two(minimum(T(hardening) * maximum(zero - alpha, zero), T(greatest_argument)));
    const T tension = T(cohesion) * size, pressure = zero - trace, shear = T(shear_ratio) * deviator_norm;

    const T limit = square_root(T(slope_squared) * maximum((pressure + tension) * (size - pressure), zero));
    const auto beyond_side = shear > limit;
    T scale = select(beyond_side, limit / maximum(shear, T(1e-30f)), one);
    const T offset = pressure - half * (size - tension), half_axis = half * (size + tension);
    const T reach = half_axis / square_root(maximum(offset * offset + T(inverse_squared) * (shear * shear), T(1e-30f)));
    T change = select(beyond_side, (minimum(reach, one) - one) * offset, zero);

    const auto torn = pressure < zero - tension;
    T projected = select(torn, tension, trace);
    change = select(torn, trace - tension, change);
    const auto crushed = pressure > size;
    scale = select(either(torn, crushed), zero, scale);
    T history = alpha + T(hardens) * change;

    if (any(crushed)) {
      T crushed_trace = zero - size, crushed_history = alpha;
      if (hardens > 0.0f) {
        // With a = -xi alpha: sinh(a) + r a = rest, r = share / xi. Convex and increasing, started above its root; where a stays below 0
        // there is no strength yet, and the start is the root.
        const T r = flow.volumetric * T(1.0f / hardening);
        const T load = pressure - T(least_size), rest = load - flow.volumetric * alpha;
        T a = minimum(load, rest / maximum(r, T(1e-20f)));
        for (int step = 0; step < 3; ++step) {
          const T positive = minimum(maximum(a, zero), T(greatest_argument));
          const T sine = sinh_to_two(positive);
          const T down = ((sine + r * a) - rest) / (square_root(one + sine * sine) + r);
          a = select(a > zero, a - down, a);
        }
        crushed_trace = zero - (T(least_size) + sinh_to_two(minimum(maximum(a, zero), T(greatest_argument))));
        crushed_history = a * T(-1.0f / hardening);
      }
      projected = select(crushed, crushed_trace, projected);
      history = select(crushed, crushed_history, history);
    }
    history = minimum(maximum(history, T(-greatest_argument / hardening)), one);
    return {projected, scale, history};
  }
};

} // namespace loam
