// In every iteration: a particle's velocity made to agree with its contact planes, with Coulomb friction.
//
// Both velocity changes of a plane are accumulated over the iterations and it is the sums that are clipped (Guendelman et al. 2003; Catto
// 2005): a contact takes back what it gave too much, and friction is bounded by the whole normal impulse of the substep. A sticky surface also pulls, up to its hold,
// and rubs as if it were pressed on by that much more.
#pragma once

#include "kernels/contact/collider_view.h"
#include "math/atomics.h"

namespace loam {

struct SolveContacts {
  Contact *contacts;
  Row *velocities;
  float substep;

  LOAM_FN void operator()(int index) const {
    Contact &contact = contacts[index];
    Row &row = velocities[contact.particle];
    set(row, solved(contact, xyz(row)));
  }

protected:
  LOAM_FN static void set(Row &row, const Vec3<float> &v) {
    row.x = v.x;
    row.y = v.y;
    row.z = v.z;
  }
  LOAM_FN Vec3<float> solved(Contact &contact, Vec3<float> v) const {
    // The closest plane comes last: where planes contradict each other, it wins.
    for (int i = contact.plane_count - 1; i >= 0; --i) {
      const ContactPlane &plane = contact.planes[i];
      const float missing = 0.0f - (dot(plane.normal, v) + plane.gap / substep);
      const float normal_change = maximum(0.0f - plane.hold, contact.normal_change[i] + missing);
      v = v + (normal_change - contact.normal_change[i]) * plane.normal;
      contact.normal_change[i] = normal_change;

      const Vec3<float> slip = v - plane.surface_velocity;
      const Vec3<float> tangential = slip - dot(plane.normal, slip) * plane.normal;
      Vec3<float> friction_change = contact.friction_change[i] - tangential;
      const float size = length(friction_change);
      const float limit = plane.friction * (normal_change + plane.hold);
      if (size > limit) friction_change = (limit / size) * friction_change;
      v = v + (friction_change - contact.friction_change[i]);
      contact.friction_change[i] = friction_change;
    }
    return v;
  }
};

// The last time, after the speed limit. What contacts take back now was given against velocities that the limit has cut since; so this pass keeps to
// the limit itself, above the speed of the surfaces.
struct SolveContactsWithinLimit : SolveContacts {
  float greatest_speed;
  int *limited; // counter

  LOAM_FN void operator()(int index) const {
    Contact &contact = contacts[index];
    Row &row = velocities[contact.particle];
    Vec3<float> v = solved(contact, xyz(row));
    float most = 0.0f;
    for (int i = 0; i < contact.plane_count; ++i) most = maximum(most, length(contact.planes[i].surface_velocity));
    most = most + greatest_speed;
    const float squared = dot(v, v);
    if (squared > most * most) {
      v = (most / square_root(squared)) * v;
      atomic_add(limited, 1);
    }
    set(row, v);
  }
};

} // namespace loam
