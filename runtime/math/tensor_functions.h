// Functions of symmetric tensors: logarithm, exponential, eigen-decomposition, over floats and packs.
//
// The isotropic laws here need no eigenvectors in their common case: log and exp are polynomials, which the theorem of Cayley and Hamilton
// reduces to c0 I + c1 Q + c2 Q^2. Where a strain is too large for the polynomials' range, the affected lanes fall back to an
// eigen-decomposition by Jacobi rotations. All of it is built from + - * / and square roots, so that results have the same bits on every
// machine.
#pragma once

#include "math/functions.h"
#include "math/matrix.h"

namespace loam {

// log(1 + x) / x for x in [-0.35, 0.45], relative error 6e-9 before rounding (minimax fit).
template <class T> LOAM_FN T log1p_over_x_coefficient(int i) {
  constexpr float k[10] = {1.000000005e+00f,  -4.999996106e-01f, 3.333312818e-01f,  -2.500388613e-01f, 2.001378737e-01f,
                           -1.656617288e-01f, 1.395796580e-01f,  -1.336425723e-01f, 1.421294707e-01f,  -8.830662971e-02f};
  return T(k[i]);
}
template <class T> LOAM_FN T log1p_over_x(T x) {
  T sum = log1p_over_x_coefficient<T>(9);
  for (int i = 8; i >= 0; --i) sum = sum * x + log1p_over_x_coefficient<T>(i);
  return sum;
}

// log(y) for any y, which is clamped to [1e-8, 1e8] first: six square roots bring it into the polynomial's range. Absolute error about 4e-6: for
// the rare paths only.
template <class T> LOAM_FN T log_by_roots(T y) {
  y = minimum(maximum(y, T(1e-8f)), T(1e8f));
  for (int i = 0; i < 6; ++i) y = square_root(y);
  const T x = y - T(1.0f);
  return T(64.0f) * (x * log1p_over_x(x));
}

// log(1 + x), x clamped to [-0.9, 9].
template <class T> LOAM_FN T log1p_bounded(T x) {
  T result = x * log1p_over_x(x);
  const auto outside = either(x<T(-0.35f), x> T(0.45f));
  if (any(outside)) result = select(outside, log_by_roots(minimum(maximum(x, T(-0.9f)), T(9.0f)) + T(1.0f)), result);
  return result;
}

// exp(x) - 1 by its Taylor series; relative error 3e-8 for |x| <= 1, 1e-4 at |x| = 2.
template <class T> LOAM_FN T expm1_series(T x) {
  constexpr float inverse_factorial[11] = {1.0f / 39916800, 1.0f / 3628800, 1.0f / 362880, 1.0f / 40320,
                                           1.0f / 5040,     1.0f / 720,     1.0f / 120,    1.0f / 24,
                                           1.0f / 6,        0.5f,           1.0f};
  T sum = T(inverse_factorial[0]);
  for (int i = 1; i < 11; ++i) sum = sum * x + T(inverse_factorial[i]);
  return sum * x;
}

// exp(X) - I of a traceless symmetric X with eigenvalues within [-1, 1], to order 8. The powers follow from X^3 = -x2 X + x3 I with
// x2 = -|X|^2 / 2 and x3 = det X.
template <class T> LOAM_FN Sym3<T> expm1_traceless(const Sym3<T> &X) {
  const Sym3<T> X2 = square(X);
  const T x2 = T(-0.5f) * trace(X2), x3 = determinant(X);
  // Horner over the powers: (c0, c1, c2) <- coefficient + X * (c0, c1, c2)
  constexpr float inverse_factorial[8] = {1.0f / 40320, 1.0f / 5040, 1.0f / 720, 1.0f / 120,
                                          1.0f / 24,    1.0f / 6,    0.5f,       1.0f};
  T c0 = T(inverse_factorial[0]), c1 = T(0.0f), c2 = T(0.0f);
  for (int i = 1; i < 8; ++i) {
    const T n0 = c2 * x3 + T(inverse_factorial[i]), n1 = c0 - c2 * x2;
    c2 = c1;
    c1 = n1;
    c0 = n0;
  }
  return quadratic(c2 * x3, c0 - c2 * x2, X, c1, X2); // once more times X, without the final 1
}

template <class T> struct Eigen3 {
  T values[3];
  Mat3<T> vectors; // columns
};

// Cyclic Jacobi rotations, five sweeps: float accuracy for any symmetric matrix.
template <class T> LOAM_FN Eigen3<T> eigen_decomposition(const Sym3<T> &a) {
  const T zero(0.0f), one(1.0f);
  T m[3][3] = {{a.xx, a.xy, a.xz}, {a.xy, a.yy, a.yz}, {a.xz, a.yz, a.zz}};
  Mat3<T> v = {{{one, zero, zero}, {zero, one, zero}, {zero, zero, one}}};
  for (int sweep = 0; sweep < 5; ++sweep) {
    for (int pair = 0; pair < 3; ++pair) {
      const int p = pair == 2 ? 1 : 0, q = pair == 0 ? 1 : 2, o = 3 - p - q;
      // tangent of the rotation angle, the smaller root; 0 where the entry vanishes already
      const T twice = m[p][q] + m[p][q], difference = m[q][q] - m[p][p];
      const T root = square_root(difference * difference + twice * twice);
      const T denominator = select(difference < zero, difference - root, difference + root);
      const auto turn = absolute(denominator) > T(1e-30f);
      const T t = select(turn, twice / select(turn, denominator, one), zero);
      const T c = one / square_root(one + t * t), s = t * c;
      const T mpp = m[p][p] - t * m[p][q], mqq = m[q][q] + t * m[p][q];
      const T mpo = c * m[p][o] - s * m[q][o], mqo = s * m[p][o] + c * m[q][o];
      m[p][p] = mpp;
      m[q][q] = mqq;
      m[p][q] = m[q][p] = zero;
      m[p][o] = m[o][p] = mpo;
      m[q][o] = m[o][q] = mqo;
      for (int i = 0; i < 3; ++i) {
        const T vip = v.m[i][p], viq = v.m[i][q];
        v.m[i][p] = c * vip - s * viq;
        v.m[i][q] = s * vip + c * viq;
      }
    }
  }
  return {{m[0][0], m[1][1], m[2][2]}, v};
}

// V diag(f) V^T
template <class T> LOAM_FN Sym3<T> from_eigen(const Mat3<T> &v, const T f[3]) {
  Sym3<T> sum = zero_symmetric<T>();
  for (int k = 0; k < 3; ++k) add_square(sum, f[k], Vec3<T>{v.m[0][k], v.m[1][k], v.m[2][k]});
  return sum;
}

// The spectrum of a traceless symmetric tensor without its eigenvectors: values[0] is the eigenvalue farthest from 0, which is also the one that no
// other comes close to, so that the projector onto its direction is well conditioned. Across it, the tensor is its mean plus `difference`, of
// eigenvalues +-half_gap. No rotations: closed forms only.
template <class T> struct Spectrum {
  T values[3];
  Sym3<T> projector, difference;
  T half_gap;
};
template <class T> LOAM_FN Spectrum<T> spectrum_of_traceless(const Sym3<T> &a) {
  const T zero(0.0f), one(1.0f), half(0.5f);
  // In the scale of its norm, so that the determinant cannot underflow.
  const T norm = square_root(frobenius_squared(a));
  const auto some = norm > T(1e-18f);
  const Sym3<T> A = (one / select(some, norm, one)) * a;
  const Sym3<T> A2 = square(A);
  // The eigenvalues are 2 sqrt(J2 / 3) cos of a third of an angle whose cosine is |det| / (2 sqrt(J2 / 3)^3), here with J2 = 1/2.
  const T det = determinant(A);
  const T cosine = minimum(absolute(det) * T(7.34846923f), one); // sqrt(54)
  const T size = T(0.81649658f) * cosine_of_third(cosine);       // sqrt(2/3)
  const T first = select(det < zero, zero - size, size);
  // (A - l1)(A - l2) / ((l0 - l1)(l0 - l2)), with l1 + l2 = -l0 and l1 l2 = l0^2 - J2
  const T square_of_first = first * first, inverse = one / (T(3.0f) * square_of_first - half);
  Spectrum<T> result;
  result.projector = quadratic(inverse * (square_of_first - half), inverse * first, A, inverse, A2);
  const Sym3<T> rest = A + (zero - T(1.5f) * first) * result.projector;
  result.difference = norm * add_diagonal(rest, half * first); // A - l0 P + (l0 / 2)(I - P)
  result.half_gap = square_root(half * frobenius_squared(result.difference));
  const T scaled = norm * first;
  result.values[0] = scaled;
  result.values[1] = result.half_gap - half * scaled;
  result.values[2] = zero - result.half_gap - half * scaled;
  return result;
}
// The tensor with the same directions and the eigenvalues f. Where f[1] - f[2] does not vanish with the gap the result is wrong; a function of one
// value that is Lipschitz is fine.
template <class T> LOAM_FN Sym3<T> with_values(const Spectrum<T> &s, const T f[3]) {
  const T half(0.5f), mean = half * (f[1] + f[2]);
  const T ratio = half * (f[1] - f[2]) / maximum(s.half_gap, T(1e-20f));
  return add_diagonal((f[0] - mean) * s.projector + ratio * s.difference, mean);
}

// A Hencky strain, split: strain = (trace / 3) I + deviator.
template <class T> struct HenckyStrain {
  T trace;
  Sym3<T> deviator;
};

// The eigenvalues of b - I that belong to Hencky strains of -limit and +limit.
struct StrainLimit {
  float least, most;
};
inline StrainLimit strain_limit(double limit) {
  return {static_cast<float>(std::expm1(-2.0 * limit)), static_cast<float>(std::expm1(2.0 * limit))};
}

// log(I + S) / 2 for S = b - I. Principal strains beyond the limit are clamped, and then S is changed to match and `limited` set. The
// limit is 0.4 or more, so that the polynomials' range lies within it. A NaN ends at the lower limit.
// `decomposed` is set where the polynomials' range was left for an eigen-decomposition.
template <class T, class Mask>
LOAM_FN HenckyStrain<T> hencky_strain(Sym3<T> &S, StrainLimit limit, Mask &limited, Mask &decomposed) {
  const T third(1.0f / 3.0f), half(0.5f), one(1.0f);
  // b = (1 + t)(I + Q) with Q traceless
  const T t = trace(S) * third;
  const T s = one / (one + t);
  const Sym3<T> Q = {(S.xx - t) * s, (S.yy - t) * s, (S.zz - t) * s, S.xy * s, S.xz * s, S.yz * s};
  const Sym3<T> Q2 = square(Q);
  const T q2 = T(-0.5f) * trace(Q2), q3 = determinant(Q); // Q^3 = -q2 Q + q3 I
  T c0 = log1p_over_x_coefficient<T>(9), c1(0.0f), c2(0.0f);
  for (int i = 8; i >= 0; --i) {
    const T n0 = c2 * q3 + log1p_over_x_coefficient<T>(i), n1 = c0 - c2 * q2;
    c2 = c1;
    c1 = n1;
    c0 = n0;
  }
  // log(I + Q) = Q p(Q); its trace is log det(I + Q) = log(1 + q2 + q3)
  const T determinant_part = q2 + q3;
  const T trace_q = half * determinant_part * log1p_over_x(determinant_part);
  HenckyStrain<T> result;
  result.trace = T(1.5f) * t * log1p_over_x(t) + trace_q;
  Sym3<T> e = quadratic(half * (c2 * q3), half * (c0 - c2 * q2), Q, half * c1, Q2);
  result.deviator = add_diagonal(e, T(-1.0f) * third * trace(e));
  // |eigenvalue of Q| <= sqrt(2/3) |Q|; the comparison is written so that NaN counts as outside
  const auto inside = both(both(t > T(-0.35f), t < T(0.45f)), frobenius_squared(Q) < T(0.18f));
  const auto outside = opposite(inside);
  limited = both(outside, inside);
  decomposed = outside;
  if (any(outside)) {
    const Eigen3<T> eigen = eigen_decomposition(S);
    const T least(limit.least), most(limit.most);
    T clamped[3], logarithm[3];
    auto moved = eigen.values[0] < least;
    for (int k = 0; k < 3; ++k) {
      clamped[k] = minimum(maximum(eigen.values[k], least), most);
      moved = either(moved, either(eigen.values[k]<least, eigen.values[k]> most));
      logarithm[k] = half * log_by_roots(one + clamped[k]);
    }
    moved = both(moved, outside);
    S = select(moved, from_eigen(eigen.vectors, clamped), S);
    e = from_eigen(eigen.vectors, logarithm);
    const T sum = logarithm[0] + (logarithm[1] + logarithm[2]);
    result.trace = select(outside, sum, result.trace);
    result.deviator = select(outside, add_diagonal(e, T(-1.0f) * third * sum), result.deviator);
    limited = moved;
  }
  return result;
}
template <class T, class Mask> LOAM_FN HenckyStrain<T> hencky_strain(Sym3<T> &S, StrainLimit limit, Mask &limited) {
  Mask decomposed = limited;
  return hencky_strain(S, limit, limited, decomposed);
}

} // namespace loam
