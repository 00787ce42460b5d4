// How matter behaves on a collider's surface.
#pragma once

#include "math/functions.h"
#include "math/vector.h"

namespace loam {

struct ContactLaw {
  float friction;    // Coulomb's coefficient
  float restitution; // share of the speed of approach that is given back, 0 to 1
  float stick;       // Pa: the tension that the surface holds; pressed on by so much, it rubs as well
};

// What a particle brings to a contact.
struct ContactParticle {
  Vec3<float> velocity; // with the substep's forces
  float inverse_mass, volume;
  float substep;
  float rest_speed; // an approach slower than this does not bounce: m/s
};

// The gap of a plane with restitution: least such that dot(normal, v) + gap / substep >= 0 lets the particle leave with its share of the speed that it
// would hit the surface with in this substep.
LOAM_FN float gap_with_bounce(const ContactLaw &law, const ContactParticle &particle, Vec3<float> normal, float gap,
                              Vec3<float> surface_velocity) {
  const float substep = particle.substep, own = dot(normal, surface_velocity);
  const float approach = own - dot(normal, particle.velocity);
  const bool hits = substep * dot(normal, particle.velocity) + gap < 0.0f;
  if (!(law.restitution > 0.0f) || !hits || !(approach > particle.rest_speed)) return gap;
  // Down to the rest speed the share falls to nothing, or the smallest hops would go on for ever.
  const float counted = approach - particle.rest_speed * (particle.rest_speed / approach);
  return minimum(gap, 0.0f - substep * (own + law.restitution * counted));
}

// The most that the surface can hold a particle back by in a substep, as a velocity change: its stress on the face of a cube of the particle's volume.
// It holds what touches it, and lets go a tenth of the stand-off beyond.
LOAM_FN float greatest_hold(const ContactLaw &law, const ContactParticle &particle, float distance, float stand_off) {
  if (!(law.stick > 0.0f) || distance > 1.1f * stand_off) return 0.0f;
  const float area = exponential((2.0f / 3.0f) * logarithm(particle.volume));
  return law.stick * area * particle.substep * particle.inverse_mass;
}

} // namespace loam
