// Small vectors of the runner: floats for pictures, doubles for geometry that must be exact.
#pragma once

#include <cmath>

namespace runner {

template <class T> struct Vector {
  T x = 0, y = 0, z = 0;

  Vector &operator+=(Vector b) { return *this = {x + b.x, y + b.y, z + b.z}; }
  T operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  T &operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
};

using Vector3 = Vector<float>;
using Vector3d = Vector<double>;

template <class T> Vector<T> operator+(Vector<T> a, Vector<T> b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T> Vector<T> operator-(Vector<T> a, Vector<T> b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T> Vector<T> operator-(Vector<T> a) { return {-a.x, -a.y, -a.z}; }
template <class T> Vector<T> operator*(T s, Vector<T> a) { return {s * a.x, s * a.y, s * a.z}; }
// Component by component: a colour that filters another.
template <class T> Vector<T> operator*(Vector<T> a, Vector<T> b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
template <class T> T dot(Vector<T> a, Vector<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> Vector<T> cross(Vector<T> a, Vector<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> T length(Vector<T> a) { return std::sqrt(dot(a, a)); }
template <class T> Vector<T> normalized(Vector<T> a) { return (T(1) / length(a)) * a; }
template <class T> Vector<T> mix(Vector<T> a, Vector<T> b, T share) { return a + share * (b - a); }
template <class T> Vector<T> reflect(Vector<T> direction, Vector<T> normal) {
  return direction - (T(2) * dot(direction, normal)) * normal;
}
template <class T> Vector<T> minimum(Vector<T> a, Vector<T> b) {
  return {std::fmin(a.x, b.x), std::fmin(a.y, b.y), std::fmin(a.z, b.z)};
}
template <class T> Vector<T> maximum(Vector<T> a, Vector<T> b) {
  return {std::fmax(a.x, b.x), std::fmax(a.y, b.y), std::fmax(a.z, b.z)};
}
inline Vector3d to_double(Vector3 a) { return {a.x, a.y, a.z}; }
inline Vector3 to_float(Vector3d a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }

// Two directions that complete a unit vector to a right-handed frame.
struct Frame {
  Vector3 tangent, bitangent;
  explicit Frame(Vector3 normal) {
    const Vector3 aside = std::fabs(normal.x) < 0.7f ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    tangent = normalized(cross(aside, normal));
    bitangent = cross(normal, tangent);
  }
};

} // namespace runner
