// Particles that leave a nozzle: until then they are pinned and move at its speed.
#pragma once

#include "math/random_of_id.h"
#include "math/vector.h"

namespace loam {

struct ReleaseParticles {
  Row *velocities;
  const std::uint32_t *ids;
  std::uint32_t first_id, count; // consecutive
  float inverse_mass, velocity_jitter;
  std::uint32_t seed;
  LOAM_FN void operator()(int i) const {
    const std::uint32_t id = ids[i];
    if (id - first_id >= count) return; // also where the difference wraps around
    Row v = velocities[i];
    v.x += velocity_jitter * random_of_id(seed, id, 0);
    v.y += velocity_jitter * random_of_id(seed, id, 1);
    v.z += velocity_jitter * random_of_id(seed, id, 2);
    v.w = inverse_mass;
    velocities[i] = v;
  }
};

} // namespace loam
