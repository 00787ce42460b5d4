// 3-vectors over any arithmetic type: float, double, a SIMD pack.
#pragma once

#include "math/scalar.h"

namespace loam {

// Four floats in one 16-byte row: how positions (x, y, z, volume) and velocities (x, y, z, inverse mass) are stored, so that a
// neighbour costs one load.
struct alignas(16) Row {
  float x, y, z, w;
};

template <class T> struct Vec3 { T x, y, z; };

template <class T> struct Vec4 {
  T x, y, z, w;
  LOAM_FN Vec3<T> xyz() const { return {x, y, z}; }
};

template <class T> LOAM_FN Vec3<T> operator+(Vec3<T> a, Vec3<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> LOAM_FN Vec3<T> operator-(Vec3<T> a, Vec3<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> LOAM_FN Vec3<T> operator*(T s, Vec3<T> a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T> LOAM_FN T dot(Vec3<T> a, Vec3<T> b) { return a.x * b.x + (a.y * b.y + a.z * b.z); }
template <class T> LOAM_FN Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> LOAM_FN T length(Vec3<T> a) { return square_root(dot(a, a)); }
template <class M, class T> LOAM_FN Vec3<T> select(M mask, Vec3<T> a, Vec3<T> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}

LOAM_FN Vec3<float> xyz(const Row &row) { return {row.x, row.y, row.z}; }
LOAM_FN bool is_finite(Vec3<float> a) { return is_finite(a.x) && is_finite(a.y) && is_finite(a.z); }

// Rotates by the unit quaternion (x, y, z, w).
template <class T> LOAM_FN Vec3<T> rotate(Vec4<T> q, Vec3<T> v) {
  const Vec3<T> u = q.xyz();
  const Vec3<T> t = cross(u, v);
  const Vec3<T> twice = t + t;
  return v + q.w * twice + cross(u, twice);
}
template <class T> LOAM_FN Vec4<T> conjugate(Vec4<T> q) { return {T(0) - q.x, T(0) - q.y, T(0) - q.z, q.w}; }
template <class T> LOAM_FN Vec4<T> multiply(Vec4<T> a, Vec4<T> b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

} // namespace loam
