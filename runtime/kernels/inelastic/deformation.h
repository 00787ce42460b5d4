// The deformation of a substep and its inverse.
#pragma once

#include "math/matrix.h"

namespace loam {

// D = I + H and D^-T, by cofactors; both the identity where D is close to inverting the neighbourhood, where its inverse would say nothing.
template <class T> struct Deformation { Mat3<T> gradient, inverse_transpose; };
template <class T> LOAM_FN Deformation<T> deformation(const Mat3<T> &H) {
  const T one(1.0f), zero(0.0f);
  Mat3<T> D = H;
  for (int i = 0; i < 3; ++i) D.m[i][i] = D.m[i][i] + one;
  Mat3<T> cofactor;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      cofactor.m[i][j] = D.m[a][c] * D.m[b][d] - D.m[a][d] * D.m[b][c];
    }
  const T det = D.m[0][0] * cofactor.m[0][0] + (D.m[0][1] * cofactor.m[0][1] + D.m[0][2] * cofactor.m[0][2]);
  const auto regular = det > T(0.05f);
  const Mat3<T> identity = {{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}};
  return {select(regular, D, identity), select(regular, (one / select(regular, det, one)) * cofactor, identity)};
}

} // namespace loam
