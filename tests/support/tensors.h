/* Random tensors in double precision, and the way between them and the library's. For tests of the insides. */
#pragma once

#include <Eigen/Dense>
#include <random>

#include "math/matrix.h"

namespace loam::test {

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

inline Sym3<float> narrow(const Matrix &m) {
  return {float(m(0, 0)), float(m(1, 1)), float(m(2, 2)), float(m(0, 1)), float(m(0, 2)), float(m(1, 2))};
}
inline Mat3<float> narrow_full(const Matrix &m) {
  Mat3<float> result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result.m[i][j] = float(m(i, j));
  return result;
}
template <class T> Matrix widen(const Sym3<T> &s) {
  Matrix m;
  m << double(s.xx), double(s.xy), double(s.xz), double(s.xy), double(s.yy), double(s.yz), double(s.xz), double(s.yz),
      double(s.zz);
  return m;
}
template <class T> Matrix widen(const Mat3<T> &a) {
  Matrix m;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = double(a.m[i][j]);
  return m;
}
/* f of the eigenvalues, in the same eigenvectors. */
template <class F> Matrix apply(const Matrix &symmetric, F &&f) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(symmetric);
  return eigen.eigenvectors() * eigen.eigenvalues().unaryExpr(f).asDiagonal() * eigen.eigenvectors().transpose();
}
inline Matrix deviator(const Matrix &m) { return m - m.trace() / 3 * Matrix::Identity(); }

class RandomTensors {
public:
  explicit RandomTensors(unsigned seed) : generator_(seed) {}
  /* Uniform; mt19937's own numbers, for the standard distributions differ between machines. */
  double between(double low, double high) { return low + (high - low) * (double(generator_()) / 4294967296.0); }
  Vector vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
  Matrix matrix(double size) {
    Matrix m;
    m << vector(size), vector(size), vector(size);
    return m;
  }
  Matrix rotation() {
    Eigen::Quaterniond q;
    do q = Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), between(-1, 1));
    while (q.norm() < 0.1 || q.norm() > 1);
    return q.normalized().toRotationMatrix();
  }
  Matrix symmetric(const Vector &eigenvalues) {
    const Matrix q = rotation();
    return q * eigenvalues.asDiagonal() * q.transpose();
  }

private:
  std::mt19937 generator_;
};

} // namespace loam::test
