// Particles that leave a nozzle: until then they are pinned and move at its speed.
#pragma once

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
    v.x += velocity_jitter * random(id, 0);
    v.y += velocity_jitter * random(id, 1);
    v.z += velocity_jitter * random(id, 2);
    v.w = inverse_mass;
    velocities[i] = v;
  }
  // In [-1, 1), from the particle's id: it does not matter where the particle is or who asks. The mixer is SplitMix64's.
  LOAM_FN float random(std::uint32_t id, std::uint32_t axis) const {
    std::uint64_t z = (static_cast<std::uint64_t>(seed) << 34) + (static_cast<std::uint64_t>(id) << 2) + axis;
    z += 0x9E3779B97F4A7C15ull;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ z >> 27) * 0x94D049BB133111EBull;
    z ^= z >> 31;
    return static_cast<float>(static_cast<std::int32_t>(z >> 40) - (1 << 23)) * (1.0f / (1 << 23));
  }
};

} // namespace loam
