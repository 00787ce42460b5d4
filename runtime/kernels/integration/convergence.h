// How far an iteration still moved the solution of a substep.
#pragma once

#include "math/functions.h"
#include "math/vector.h"

namespace loam {

// Squared changes of velocity in the norm of kinetic energy: by the last iteration, and by all constraints since the free motion.
struct VelocityChanges {
  struct Value {
    double last, all, mass;
  };
  const Row *free, *before, *now;

  LOAM_FN static Value identity() { return {0, 0, 0}; }
  LOAM_FN Value operator()(int i) const {
    const Row v = now[i];
    if (!(v.w > 0.0f)) return identity();
    const Vec3<float> last = xyz(v) - xyz(before[i]), all = xyz(v) - xyz(free[i]);
    const double mass = 1.0 / v.w;
    return {mass * dot(last, last), mass * dot(all, all), mass};
  }
  LOAM_FN static Value combine(const Value &a, const Value &b) { return {a.last + b.last, a.all + b.all, a.mass + b.mass}; }
};

} // namespace loam
