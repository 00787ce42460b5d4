// How far the colliders move in a substep, as a bound for free distances (kernels/contact/free_distance.h).
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "kernels/contact/collider_view.h"

namespace loam {

class ColliderMotion {
public:
  // `extent`: the greatest distance of a point of its surface from its origin; infinite for a plane. `own`: the most that such a point moves in the
  // collider's frame.
  void include(const ColliderView &collider, float extent, float own = 0) {
    if (at_rest(collider)) {
      include(own, 0);
      return;
    }
    const float spin = spin_of(collider);
    include(own + (spin > 0.0f ? shift_of(collider) + spin * extent : shift_of(collider)), spin);
  }

  // The most that a point of any collider moves.
  float greatest() const { return greatest_; }

  // A query looks `range` far, and farther by what the collider would carry the particle along. That grows with the distance D from the mesh,
  // by less than D times the spin: a particle that is free by this much is not found.
  float enough(float range) const {
    return spin_ < 0.5f ? 1.00001f * (range + greatest_) / (1.0f - spin_) : std::numeric_limits<float>::infinity();
  }

private:
  void include(float motion, float spin) {
    greatest_ = std::max(greatest_, motion);
    spin_ = std::max(spin_, spin);
  }
  static float shift_of(const ColliderView &collider) {
    const Vec3<float> &a = collider.start.position, &b = collider.end.position;
    // Positions are rounded; a little more than they say.
    return 1.00001f * length(b - a) + 1e-6f * (length(a) + length(b));
  }
  // A bound on |R_end p - R_start p| / |p|: twice the sine of half the angle, which is less than twice the distance of the quaternions.
  static float spin_of(const ColliderView &collider) {
    const Vec4<float> &p = collider.start.rotation, &q = collider.end.rotation;
    if (p.x == q.x && p.y == q.y && p.z == q.z && p.w == q.w) return 0.0f;
    const auto distance = [&](float sign) {
      const float x = q.x - sign * p.x, y = q.y - sign * p.y, z = q.z - sign * p.z, w = q.w - sign * p.w;
      return square_root(x * x + y * y + (z * z + w * w));
    };
    return 2.0001f * std::min(distance(1.0f), distance(-1.0f)) + 1e-6f;
  }

  float greatest_ = 0, spin_ = 0;
};

// Whether these are the same colliders in the same order, gone on from where they were.
inline bool go_on(const std::vector<ColliderView> &before, const std::vector<ColliderView> &now) {
  return std::equal(before.begin(), before.end(), now.begin(), now.end(), [](const ColliderView &a, const ColliderView &b) {
    ColliderView between = a;
    between.start = a.end;
    between.end = b.start;
    return a.shape.kind == b.shape.kind && at_rest(between);
  });
}

} // namespace loam
