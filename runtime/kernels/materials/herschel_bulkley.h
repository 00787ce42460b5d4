// Herschel-Bulkley: a fluid with a yield stress, which thins (exponent below 1), is Bingham's (1) or thickens (above 1); Yue, Smith, Batty, Zheng,
// Grinspun 2015, "Continuum Foam". In simple shear at the rate g the stress is t + k g^n. With the plastic strain rate's Frobenius norm,
// d = g / sqrt(2), the deviatoric Kirchhoff stress flows at
//
//   |s| = sqrt(2) t + eta d^n,     eta = 2^((n+1)/2) k
//
// Over a substep h of which `share` relaxes the strain, |dev e| over its yield value, x, splits into viscous stress and plastic strain:
//
//   x = y + share h d,   y = (eta / 2 mu) d^n
//
// For n = 1 that is linear. For other exponents both are of the form z + A z^k = 1 with k = max(n, 1/n): z is the share of y in x for n < 1, and of
// share h d for n > 1.
#pragma once

#include "kernels/materials/law.h"
#include "math/functions.h"

namespace loam {

template <class T> struct PowerBalance { T z, power; };

// z + power = 1 with power = exp(a) z^k, for z in (0, 1] and k from 1 to 10. Two steps of Halley's method from where one of the two is 1, which is
// to the right of the root of an increasing convex function: the steps go down to it. Relative error of z, of power: 2e-6, 1e-5 up to k = 3.4;
// 3e-5, 2e-4 at k = 10. Neither loses digits where it is small.
template <class T> LOAM_FN PowerBalance<T> solve_power_balance(T a, float k) {
  const T one(1.0f), two(2.0f);
  const auto weak = a <= T(0.0f);
  const T start = exponential(select(weak, a, a * T(-1.0f / k)));
  T z = select(weak, one, start), power = select(weak, start, one), rest = select(weak, T(0.0f), one - start); // 1 - z
  for (int step = 0; step < 2; ++step) {
    if (step > 0) power = exponential(a + T(k) * logarithm(z));
    const T value = power - rest, slope = z + T(k) * power; // the slope times z
    const T down = z * (two * value * slope / (two * (slope * slope) - value * (T(k * (k - 1.0f)) * power)));
    z = z - down;
    rest = rest + down;
  }
  return {z, rest};
}

struct HerschelBulkley : Isotropic {
  static constexpr bool plastic = true;
  static constexpr double greatest_strain = 0.5;
  float yield_deviator; // |dev e| at yield: sqrt(2) t / (2 mu)
  float viscosity;      // eta / (2 mu), s^n
  float exponent;       // n

  template <class T> LOAM_FN Mapped<T> map(T trace, T deviator_norm, T history, Flow<T> flow) const {
    const T one(1.0f), limit(yield_deviator);
    const auto flows = deviator_norm > limit;
    T scale = one;
    if (any(flows)) {
      const T over = maximum(deviator_norm - limit, T(1e-12f)), eta(viscosity);
      const T step = maximum(flow.deviatoric * T(flow.substep), T(1e-12f));
      T viscous; // the share of `over` that remains
      if (exponent == 1.0f) {
        viscous = eta / (eta + step);
      } else {
        const T by_viscosity = logarithm(over / eta), by_step = logarithm(over / step);
        if (exponent < 1.0f) {
          const float k = 1.0f / exponent;
          viscous = solve_power_balance(T(k) * by_viscosity - by_step, k).z;
        } else {
          viscous = solve_power_balance(T(exponent) * by_step - by_viscosity, exponent).power;
        }
      }
      scale = select(flows, (limit + viscous * over) / maximum(deviator_norm, limit), one);
    }
    return {trace, scale, history};
  }
};

} // namespace loam
