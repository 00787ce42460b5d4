// What is known of a particle's distance to the colliders, so that it is not asked for in every substep.
//
// A query finds out how far a particle is from every collider, at least. From then on the particle and the colliders can only come nearer by
// what they move; as long as the rest of that distance is more than a query looks out for, the query would find nothing and is left out.
// The distance never decides a result: it is a lower bound, with room for rounding, and states are the same bits with it and without.
#pragma once

#include "kernels/contact/collider_view.h"

namespace loam {

struct FreeDistances {
  float *values; // one a particle: no collider is nearer; 0: nothing is known. Null: none are kept
  float enough;  // beyond it no collider is found in this substep

  LOAM_FN bool suffices(int particle) const { return values != nullptr && values[particle] > enough; }
  LOAM_FN void keep(int particle, float free) const {
    if (values != nullptr) values[particle] = free;
  }
  // How far a query looks for a bound, squared: as far as it takes, since it follows nearest boxes only and tests no triangle there.
  LOAM_FN float look_squared() const { return values != nullptr ? 1e30f : 0.0f; }

  // A bound on the rounding errors of a distance, with the transformation to the collider's frame.
  LOAM_FN static float rounding(const ColliderView &collider, Vec3<float> x, Vec3<float> local) {
    return 4e-6f * (size(x) + (size(collider.start.position) + size(local)));
  }
  LOAM_FN static float size(Vec3<float> v) { return absolute(v.x) + (absolute(v.y) + absolute(v.z)); }
};

// At the end of a substep, before the particles move.
struct SpendFreeDistances {
  float *values;
  const Row *positions;
  const Row *velocities;
  float substep;
  float collider_motion; // the most that a point of any collider moves in the substep

  LOAM_FN void operator()(int i) const {
    const float motion = substep * length(xyz(velocities[i])) + 1.5e-7f * FreeDistances::size(xyz(positions[i]));
    values[i] = 0.999999f * (values[i] - (motion + collider_motion));
  }
};

} // namespace loam
