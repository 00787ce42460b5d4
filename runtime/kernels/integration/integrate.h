// The per-particle stages at both ends of a substep: forces at its start; the speed limit and the move at its end.
#pragma once

#include "math/atomics.h"
#include "math/vector.h"

namespace loam {

// Slows a velocity down to `greatest`; one that is not finite becomes 0. Answers whether it was too fast.
LOAM_FN bool slow_down(Row &v, float greatest) {
  const float squared = v.x * v.x + (v.y * v.y + v.z * v.z);
  if (squared <= greatest * greatest) return false;
  if (is_finite(xyz(v))) {
    // by the largest component first, so that squares do not overflow
    const float largest = maximum(maximum(absolute(v.x), absolute(v.y)), absolute(v.z));
    const Vec3<float> u = (1.0f / largest) * xyz(v);
    const float scale = greatest / (largest * length(u));
    v.x *= scale;
    v.y *= scale;
    v.z *= scale;
  } else {
    v.x = v.y = v.z = 0.0f;
  }
  return true;
}

// Nothing goes into the iterations faster than this many times the speed that it could leave them with, whatever the host or a field gave it: squares of
// strains would overflow. Gravity is the same for all, and strains nothing.
constexpr float greatest_start = 4.0f;
constexpr float unlimited_speed = 3.402823466e+38f; // of cloth, which may fall as fast as it will

// v <- v + h g
struct ApplyForces {
  Row *velocities;
  Vec3<float> velocity_change;
  float greatest_speed;
  int *limited; // counter
  LOAM_FN void operator()(int i) const {
    Row v = velocities[i];
    if (v.w == 0.0f) return; // pinned
    if (slow_down(v, greatest_speed)) atomic_add(limited, 1);
    v.x += velocity_change.x;
    v.y += velocity_change.y;
    v.z += velocity_change.z;
    velocities[i] = v;
  }
};

// Slows particles down to `greatest_speed`, r / h: beyond about that, matter would jump over its neighbours and over thin colliders.
struct LimitSpeed {
  Row *velocities;
  float greatest_speed;
  int *limited; // counter
  LOAM_FN void operator()(int i) const {
    Row v = velocities[i];
    if (!slow_down(v, greatest_speed)) return;
    velocities[i] = v;
    atomic_add(limited, 1);
  }
};

// x <- x + h v, and the true volume from its logarithm, bounded to a factor of two either way where it weighs gradients.
struct Advance {
  Row *positions;
  const Row *velocities;
  const float *log_volumes;
  const float *rest_volumes;
  float substep;
  LOAM_FN void operator()(int i) const {
    Row x = positions[i];
    const Row v = velocities[i];
    const Vec3<float> moved = xyz(x) + substep * xyz(v);
    if (is_finite(moved)) {
      x.x = moved.x;
      x.y = moved.y;
      x.z = moved.z;
    }
    x.w = true_volume(rest_volumes[i], log_volumes[i]);
    positions[i] = x;
  }
  LOAM_FN static float true_volume(float rest_volume, float log_volume) {
    return rest_volume * volume_factor(minimum(maximum(log_volume, -0.7f), 0.7f));
  }
  // exp(j) for |j| <= 0.7, without a library call whose bits differ between machines
  LOAM_FN static float volume_factor(float j) {
    float sum = 1.0f / 40320;
    const float inverse_factorial[8] = {1.0f / 5040, 1.0f / 720, 1.0f / 120, 1.0f / 24, 1.0f / 6, 0.5f, 1.0f, 1.0f};
    for (int k = 0; k < 8; ++k) sum = sum * j + inverse_factorial[k];
    return sum;
  }
};

// The origin moves to `by`.
struct ShiftPositions {
  Row *positions;
  Vec3<float> by;
  LOAM_FN void operator()(int i) const {
    const Row x = positions[i];
    positions[i] = {x.x - by.x, x.y - by.y, x.z - by.z, x.w};
  }
};

// True volumes again, from what they were made of.
struct RestoreVolumes {
  Row *positions;
  const float *log_volumes;
  const float *rest_volumes;
  LOAM_FN void operator()(int i) const { positions[i].w = Advance::true_volume(rest_volumes[i], log_volumes[i]); }
};

} // namespace loam
