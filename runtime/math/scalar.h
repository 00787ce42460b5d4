// Scalar counterparts of the operations that the kernels use on packs, so that one text serves float, double and SIMD packs.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "math/qualifiers.h"

namespace loam {

LOAM_FN float square_root(float a) { return sqrtf(a); }
LOAM_FN double square_root(double a) { return ::sqrt(a); }
LOAM_FN float absolute(float a) { return fabsf(a); }
LOAM_FN double absolute(double a) { return ::fabs(a); }
LOAM_FN float minimum(float a, float b) { return a < b ? a : b; }
LOAM_FN double minimum(double a, double b) { return a < b ? a : b; }
LOAM_FN float maximum(float a, float b) { return a > b ? a : b; }
LOAM_FN double maximum(double a, double b) { return a > b ? a : b; }
LOAM_FN float select(bool mask, float a, float b) { return mask ? a : b; }
LOAM_FN double select(bool mask, double a, double b) { return mask ? a : b; }
LOAM_FN bool any(bool mask) { return mask; }
LOAM_FN bool both(bool a, bool b) { return a && b; }
LOAM_FN bool either(bool a, bool b) { return a || b; }
LOAM_FN bool opposite(bool a) { return !a; }

// 2^n for an integer n from -126 to 127.
LOAM_FN float power_of_two(float n) {
  const std::int32_t bits = (static_cast<std::int32_t>(n) + 127) * (1 << 23);
  float result;
  memcpy(&result, &bits, sizeof result);
  return result;
}
// The integer e for which a / 2^e lies between the square roots of 1/2 and of 2; a is positive and normal.
LOAM_FN float binary_exponent(float a) {
  std::int32_t bits;
  memcpy(&bits, &a, sizeof bits);
  return static_cast<float>((bits - 0x3f3504f3) >> 23);
}

// True for neither infinity nor NaN, whatever the compiler assumes about arithmetic.
LOAM_FN bool is_finite(float a) { return fabsf(a) <= 3.402823466e+38f; }

} // namespace loam
