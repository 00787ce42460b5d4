// 3x3 matrices, general and symmetric, over any arithmetic type.
#pragma once

#include "math/vector.h"

namespace loam {

template <class T> struct Mat3 {
  T m[3][3]; // m[row][column]
};

template <class T> struct Sym3 { T xx, yy, zz, xy, xz, yz; };

template <class T> LOAM_FN Mat3<T> zero_matrix() {
  const T z(0.0f);
  return {{{z, z, z}, {z, z, z}, {z, z, z}}};
}
template <class T> LOAM_FN Sym3<T> zero_symmetric() {
  const T z(0.0f);
  return {z, z, z, z, z, z};
}
template <class T> LOAM_FN Mat3<T> outer(Vec3<T> a, Vec3<T> b) {
  return {{{a.x * b.x, a.x * b.y, a.x * b.z}, {a.y * b.x, a.y * b.y, a.y * b.z}, {a.z * b.x, a.z * b.y, a.z * b.z}}};
}
template <class T> LOAM_FN void add_outer(Mat3<T> &sum, Vec3<T> a, Vec3<T> b) {
  sum.m[0][0] = sum.m[0][0] + a.x * b.x;
  sum.m[0][1] = sum.m[0][1] + a.x * b.y;
  sum.m[0][2] = sum.m[0][2] + a.x * b.z;
  sum.m[1][0] = sum.m[1][0] + a.y * b.x;
  sum.m[1][1] = sum.m[1][1] + a.y * b.y;
  sum.m[1][2] = sum.m[1][2] + a.y * b.z;
  sum.m[2][0] = sum.m[2][0] + a.z * b.x;
  sum.m[2][1] = sum.m[2][1] + a.z * b.y;
  sum.m[2][2] = sum.m[2][2] + a.z * b.z;
}
// sum += scale * a a^T
template <class T> LOAM_FN void add_square(Sym3<T> &sum, T scale, Vec3<T> a) {
  const Vec3<T> b = scale * a;
  sum.xx = sum.xx + b.x * a.x;
  sum.yy = sum.yy + b.y * a.y;
  sum.zz = sum.zz + b.z * a.z;
  sum.xy = sum.xy + b.x * a.y;
  sum.xz = sum.xz + b.x * a.z;
  sum.yz = sum.yz + b.y * a.z;
}

template <class T> LOAM_FN Mat3<T> operator+(const Mat3<T> &a, const Mat3<T> &b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][j] + b.m[i][j];
  return c;
}
template <class T> LOAM_FN Mat3<T> operator-(const Mat3<T> &a, const Mat3<T> &b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][j] - b.m[i][j];
  return c;
}
template <class T> LOAM_FN Mat3<T> operator*(T s, const Mat3<T> &a) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = s * a.m[i][j];
  return c;
}
template <class T> LOAM_FN Mat3<T> operator*(const Mat3<T> &a, const Mat3<T> &b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][0] * b.m[0][j] + (a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j]);
  return c;
}
template <class T> LOAM_FN Vec3<T> operator*(const Mat3<T> &a, Vec3<T> v) {
  return {a.m[0][0] * v.x + (a.m[0][1] * v.y + a.m[0][2] * v.z), a.m[1][0] * v.x + (a.m[1][1] * v.y + a.m[1][2] * v.z),
          a.m[2][0] * v.x + (a.m[2][1] * v.y + a.m[2][2] * v.z)};
}
template <class T> LOAM_FN Vec3<T> operator*(const Sym3<T> &a, Vec3<T> v) {
  return {a.xx * v.x + (a.xy * v.y + a.xz * v.z), a.xy * v.x + (a.yy * v.y + a.yz * v.z),
          a.xz * v.x + (a.yz * v.y + a.zz * v.z)};
}
template <class T> LOAM_FN Mat3<T> transpose(const Mat3<T> &a) {
  return {{{a.m[0][0], a.m[1][0], a.m[2][0]}, {a.m[0][1], a.m[1][1], a.m[2][1]}, {a.m[0][2], a.m[1][2], a.m[2][2]}}};
}
// a b^T
template <class T> LOAM_FN Mat3<T> multiply_transposed(const Mat3<T> &a, const Mat3<T> &b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][0] * b.m[j][0] + (a.m[i][1] * b.m[j][1] + a.m[i][2] * b.m[j][2]);
  return c;
}
template <class T> LOAM_FN T determinant(const Mat3<T> &a) {
  return a.m[0][0] * (a.m[1][1] * a.m[2][2] - a.m[1][2] * a.m[2][1]) -
         a.m[0][1] * (a.m[1][0] * a.m[2][2] - a.m[1][2] * a.m[2][0]) +
         a.m[0][2] * (a.m[1][0] * a.m[2][1] - a.m[1][1] * a.m[2][0]);
}

template <class T> LOAM_FN Mat3<T> full(const Sym3<T> &s) {
  return {{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
}
template <class T> LOAM_FN Sym3<T> symmetric_part(const Mat3<T> &a) {
  const T half(0.5f);
  return {a.m[0][0],
          a.m[1][1],
          a.m[2][2],
          half * (a.m[0][1] + a.m[1][0]),
          half * (a.m[0][2] + a.m[2][0]),
          half * (a.m[1][2] + a.m[2][1])};
}
template <class T> LOAM_FN Sym3<T> operator+(const Sym3<T> &a, const Sym3<T> &b) {
  return {a.xx + b.xx, a.yy + b.yy, a.zz + b.zz, a.xy + b.xy, a.xz + b.xz, a.yz + b.yz};
}
template <class T> LOAM_FN Sym3<T> operator*(T s, const Sym3<T> &a) {
  return {s * a.xx, s * a.yy, s * a.zz, s * a.xy, s * a.xz, s * a.yz};
}
template <class T> LOAM_FN Sym3<T> add_diagonal(const Sym3<T> &a, T d) {
  return {a.xx + d, a.yy + d, a.zz + d, a.xy, a.xz, a.yz};
}
template <class T> LOAM_FN T trace(const Sym3<T> &a) { return a.xx + (a.yy + a.zz); }
template <class T> LOAM_FN T frobenius_squared(const Sym3<T> &a) {
  const T diagonal = a.xx * a.xx + (a.yy * a.yy + a.zz * a.zz);
  const T off = a.xy * a.xy + (a.xz * a.xz + a.yz * a.yz);
  return diagonal + (off + off);
}
template <class T> LOAM_FN T determinant(const Sym3<T> &a) {
  return a.xx * (a.yy * a.zz - a.yz * a.yz) - a.xy * (a.xy * a.zz - a.yz * a.xz) + a.xz * (a.xy * a.yz - a.yy * a.xz);
}
template <class T> LOAM_FN Sym3<T> square(const Sym3<T> &a) {
  return {a.xx * a.xx + (a.xy * a.xy + a.xz * a.xz), a.xy * a.xy + (a.yy * a.yy + a.yz * a.yz),
          a.xz * a.xz + (a.yz * a.yz + a.zz * a.zz), a.xy * (a.xx + a.yy) + a.xz * a.yz,
          a.xz * (a.xx + a.zz) + a.xy * a.yz,        a.yz * (a.yy + a.zz) + a.xy * a.xz};
}
// c0 I + c1 a + c2 a2, with a2 the square of a
template <class T> LOAM_FN Sym3<T> quadratic(T c0, T c1, const Sym3<T> &a, T c2, const Sym3<T> &a2) {
  return {c1 * a.xx + (c2 * a2.xx + c0), c1 * a.yy + (c2 * a2.yy + c0), c1 * a.zz + (c2 * a2.zz + c0),
          c1 * a.xy + c2 * a2.xy,        c1 * a.xz + c2 * a2.xz,        c1 * a.yz + c2 * a2.yz};
}
// Product of two symmetric matrices that commute, which is symmetric.
template <class T> LOAM_FN Sym3<T> multiply_commuting(const Sym3<T> &a, const Sym3<T> &b) {
  return {a.xx * b.xx + (a.xy * b.xy + a.xz * b.xz), a.xy * b.xy + (a.yy * b.yy + a.yz * b.yz),
          a.xz * b.xz + (a.yz * b.yz + a.zz * b.zz), a.xx * b.xy + (a.xy * b.yy + a.xz * b.yz),
          a.xx * b.xz + (a.xy * b.yz + a.xz * b.zz), a.xy * b.xz + (a.yy * b.yz + a.yz * b.zz)};
}
template <class M, class T> LOAM_FN Sym3<T> select(M mask, const Sym3<T> &a, const Sym3<T> &b) {
  return {select(mask, a.xx, b.xx), select(mask, a.yy, b.yy), select(mask, a.zz, b.zz),
          select(mask, a.xy, b.xy), select(mask, a.xz, b.xz), select(mask, a.yz, b.yz)};
}
template <class M, class T> LOAM_FN Mat3<T> select(M mask, const Mat3<T> &a, const Mat3<T> &b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = select(mask, a.m[i][j], b.m[i][j]);
  return c;
}
// Inverse of a symmetric matrix that is known to be regular.
template <class T> LOAM_FN Sym3<T> inverse(const Sym3<T> &a) {
  const T xx = a.yy * a.zz - a.yz * a.yz, yy = a.xx * a.zz - a.xz * a.xz, zz = a.xx * a.yy - a.xy * a.xy;
  const T xy = a.xz * a.yz - a.xy * a.zz, xz = a.xy * a.yz - a.xz * a.yy, yz = a.xy * a.xz - a.xx * a.yz;
  const T reciprocal = T(1.0f) / (a.xx * xx + (a.xy * xy + a.xz * xz));
  return reciprocal * Sym3<T>{xx, yy, zz, xy, xz, yz};
}

} // namespace loam
