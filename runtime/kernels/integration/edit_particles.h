// What the host changes in bulk: particles that go, and particles that are put elsewhere.
#pragma once

#include "kernels/neighbours/sort_stages.h"

namespace loam {

// Particles from the end take the places of those that go. Holes and fillers are different places, so all may move at once.
struct FillHoles {
  ParticleArrays particles;
  const std::uint32_t *holes, *fillers;
  LOAM_FN void operator()(int i) const {
    move_particle(particles, static_cast<long>(fillers[i]), particles, static_cast<long>(holes[i]));
  }
};

// New positions, new velocities or both; null: they stay. Volume and inverse mass stay.
struct SetMotion {
  ParticleArrays particles;
  const std::uint32_t *places;
  const Row *positions, *velocities;
  LOAM_FN void operator()(int i) const {
    const auto to = static_cast<long>(places[i]);
    if (positions != nullptr) {
      const Row x = positions[i];
      particles.positions[to] = {x.x, x.y, x.z, particles.positions[to].w};
      if (particles.free_distances != nullptr) particles.free_distances[to] = 0.0f;
    }
    if (velocities != nullptr) {
      const Row v = velocities[i];
      particles.velocities[to] = {v.x, v.y, v.z, particles.velocities[to].w};
    }
  }
};

} // namespace loam
