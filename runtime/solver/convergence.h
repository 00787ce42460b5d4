// How far the iterations of a substep have come, for a step that iterates to a tolerance.
//
// With the changes d_k of the velocities in iteration k, relative to what all constraints together have changed, the iterations still to come
// change d_k (q + q^2 + ...) where they shrink by q = d_k / d_k-1 each: that is the estimate of the error. In Gauss-Seidel it is within a factor of two
// of the true one where elastic waves cross less than about five kernel radii. Damped Jacobi soon has fast modes behind it and slow ones still hidden,
// so q counts as 0.9 at least. Matter and each cloth are asked apart, for they hardly feel each other's iterations; the greatest counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernels/integration/convergence.h"

namespace loam {

template <class Executor> class Convergence {
public:
  Convergence(Executor &executor, bool jacobi)
      : executor_(executor), least_ratio_(jacobi ? 0.9 : 0), free_(executor.template array<Row>()),
        before_(executor.template array<Row>()) {}

  // May throw Error OUT_OF_MEMORY.
  void reserve(std::size_t rows) {
    free_.reserve(rows);
    before_.reserve(rows);
  }
  void free() {
    free_.free();
    before_.free();
  }
  std::uint64_t bytes() const { return free_.bytes() + before_.bytes(); }

  // Each of these walks the bodies: for_each(f) calls f(count, velocities) for each, always in the same order. `fall` is the speed that gravity gives in
  // a substep.
  template <class ForEach> void begin(const ForEach &for_each) {
    copy(for_each, free_.data());
    bodies_.clear();
    iterations_ = 0;
    error_ = 1;
  }
  template <class ForEach> void begin_iteration(const ForEach &for_each) { copy(for_each, before_.data()); }
  template <class ForEach> void end_iteration(const ForEach &for_each, double fall) {
    std::size_t at = 0, body = 0;
    error_ = 0;
    ++iterations_;
    for_each([&](int count, const Row *velocities) {
      const VelocityChanges::Value changes =
          executor_.reduce(count, VelocityChanges{free_.data() + at, before_.data() + at, velocities});
      // What falls freely has changes of rounding only: a hundredth of its weight counts at least.
      const double whole = changes.all + 1e-4 * changes.mass * fall * fall;
      const double change = whole > 0 ? std::sqrt(changes.last / whole) : 0;
      if (body == bodies_.size()) bodies_.push_back(change);
      error_ = std::max(error_, estimate(bodies_[body], change));
      bodies_[body] = change;
      at += static_cast<std::size_t>(count);
      ++body;
    });
    if (iterations_ < 2) error_ = 1;
  }
  double error() const { return error_; }

private:
  double estimate(double before, double change) const {
    if (!(change > 0)) return 0;
    const double q = std::clamp(before > 0 ? change / before : 1, least_ratio_, 0.995);
    return change * q / (1 - q);
  }
  template <class ForEach> void copy(const ForEach &for_each, Row *to) {
    for_each([&](int count, const Row *velocities) {
      executor_.copy(to, velocities, static_cast<std::size_t>(count));
      to += count;
    });
  }

  template <class T> using Array = typename Executor::template Array<T>;
  Executor &executor_;
  double least_ratio_;
  Array<Row> free_, before_;   // velocities
  std::vector<double> bodies_; // the last change of each
  int iterations_ = 0;
  double error_ = 1;
};

} // namespace loam
