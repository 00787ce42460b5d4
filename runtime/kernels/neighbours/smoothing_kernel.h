// The Wendland C2 kernel with support 2r:  W = 21 / (16 pi r^3) (1 - q/2)^4 (1 + 2q),  q = |x| / r.
#pragma once

#include "math/scalar.h"

namespace loam {

struct SmoothingKernel {
  float half_inverse_radius; // 1 / (2r)
  float value_scale;         // 21 / (16 pi r^3)
  float gradient_scale;      // 5 / r^2 times that: dW/dx = - gradient_scale (1 - q/2)^3 x

  static SmoothingKernel make(double r) {
    const double scale = 21.0 / (16.0 * 3.14159265358979323846 * r * r * r);
    return {static_cast<float>(0.5 / r), static_cast<float>(scale), static_cast<float>(5.0 * scale / (r * r))};
  }
  template <class T> LOAM_FN T value(T distance) const {
    const T half_q = distance * T(half_inverse_radius);
    const T u = maximum(T(1.0f) - half_q, T(0.0f)), u2 = u * u;
    return T(value_scale) * (u2 * u2) * (T(1.0f) + T(4.0f) * half_q);
  }
  // Times x_b - x_p: the gradient of W(x_p - x_b) with respect to x_p.
  template <class T> LOAM_FN T gradient_factor(T distance) const {
    const T u = maximum(T(1.0f) - distance * T(half_inverse_radius), T(0.0f));
    return T(gradient_scale) * (u * u * u);
  }
};

} // namespace loam
