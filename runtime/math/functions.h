// Elementary functions over floats and packs, with the same bits on every machine: polynomials, and the exponent bits of a float. The bounds of
// error are those of tests/unit/functions_test.cpp.
#pragma once

#include "math/scalar.h"

namespace loam {

// The natural logarithm; absolute error 6e-8 + 1e-7 |result|. The argument is clamped to [1.2e-38, 1e38]; NaN counts as the least.
template <class T> LOAM_FN T logarithm(T a) {
  const T y = minimum(maximum(a, T(1.2e-38f)), T(1e38f));
  const T e = binary_exponent(y), m = y * power_of_two(T(0.0f) - e);
  // log m = 2 atanh(s), s = (m - 1) / (m + 1); a minimax fit of atanh(s) / s in s^2
  const T s = (m - T(1.0f)) / (m + T(1.0f)), z = s * s;
  const T r = (s + s) * (T(1.0f) + z * (T(0.3333340798f) + z * (T(0.1998739748f) + z * T(0.1496282472f))));
  return e * T(0.693145751953125f) + (r + e * T(1.42860682e-6f));
}

// The exponential; relative error 2e-7. The argument is clamped to [-87, 88]; NaN counts as the least.
template <class T> LOAM_FN T exponential(T a) {
  const T x = minimum(maximum(a, T(-87.0f)), T(88.0f));
  const T magic(12582912.0f); // adding 1.5 2^23 rounds to an integer
  const T n = (x * T(1.44269504f) + magic) - magic;
  const T r = (x - n * T(0.693145751953125f)) - n * T(1.42860682e-6f), r2 = r * r;
  const T high = (T(4.166822681e-2f) + r * T(8.374832304e-3f)) + r2 * T(1.383682535e-3f);
  const T low = (T(1.0f) + r) + r2 * (T(0.5f) + r * T(1.666641997e-1f));
  return (low + (r2 * r2) * high) * power_of_two(n);
}

// The hyperbolic sine on [0, 2], relative error 3e-7.
template <class T> LOAM_FN T sinh_to_two(T x) {
  const T z = x * x;
  return x *
         (T(1.0f) + z * (T(1.666661142e-1f) + z * (T(8.334516314e-3f) + z * (T(1.975468657e-4f) + z * T(3.009276764e-6f)))));
}

// cos(acos(x) / 3) for x in [0, 1], the largest root c of 4 c^3 - 3 c = x: a minimax cubic and a step of Newton's method; relative error 2e-7.
template <class T> LOAM_FN T cosine_of_third(T x) {
  const T c = T(0.8660557669f) + x * (T(0.1655159884f) + x * (T(-0.04118154338f) + x * T(0.009644848394f)));
  const T four = T(4.0f) * (c * c);
  return c - (c * (four - T(3.0f)) - x) / (T(3.0f) * (four - T(1.0f)));
}

} // namespace loam
