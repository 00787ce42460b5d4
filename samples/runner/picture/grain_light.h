// Diffuse light on particles: for each particle one function of the normal, shared by all its pixels.
//
// Casting rays into the hemisphere at every pixel would be slow and noisy. A particle is small against everything that darkens it but
// its neighbours, so what arrives from each direction is sampled once at the particle, with the same directions for all particles, and
// kept as nine coefficients of spherical harmonics, already folded with the cosine lobe (Ramamoorthi and Hanrahan 2001).
#pragma once

#include <array>

#include "picture/environment.h"
#include "picture/ray_scene.h"

namespace runner {

struct GrainLight {
  std::array<Vector3, 9> coefficients{};
  Vector3 irradiance(Vector3 normal) const;
};

// `bounce` is the light that comes from where a ray meets matter instead of sky.
GrainLight gather_grain_light(const RayScene &scene, const Environment &environment, Vector3 center, float radius,
                              Vector3 bounce);

} // namespace runner
