// What matter did to a collider: the momentum that its contacts took from particles and vertices of cloth, counted in whole units so that the order of
// summation changes nothing.
#pragma once

#include "kernels/contact/collider_view.h"
#include "math/atomics.h"

namespace loam {

// Of one collider. Fills a cache line, so that colliders do not disturb each other.
struct alignas(64) ReactionSums {
  long long impulse[3]; // units of mass times speed
  long long torque[3];  // the same times a length
  long long contacts;
};

struct Reactions {
  ReactionSums *sums;   // null: nobody asks
  const int *index;     // into the sums, by collider; -1: not asked for
  double impulse_units; // in 1 kg m/s
  double torque_units;  // in 1 kg m^2/s
  const Row *positions; // of the matter, at the start of the substep
  const ColliderView *colliders;
  bool count; // contacts are those of the last substep

  // A change of velocity that a collider gave to a particle or vertex. Its lever is where that is.
  LOAM_FN void add(int collider, int particle, float inverse_mass, Vec3<float> change, bool presses) const {
    if (sums == nullptr || index[collider] < 0) return;
    ReactionSums &sum = sums[index[collider]];
    const Vec3<float> lever = xyz(positions[particle]) - colliders[collider].start.position;
    const Vec3<float> moment = cross(lever, change);
    const double mass = 1.0 / static_cast<double>(inverse_mass), linear = mass * impulse_units,
                 angular = mass * torque_units;
    // Matter's loss is the collider's gain.
    add(sum.impulse[0], 0.0 - linear * static_cast<double>(change.x));
    add(sum.impulse[1], 0.0 - linear * static_cast<double>(change.y));
    add(sum.impulse[2], 0.0 - linear * static_cast<double>(change.z));
    add(sum.torque[0], 0.0 - angular * static_cast<double>(moment.x));
    add(sum.torque[1], 0.0 - angular * static_cast<double>(moment.y));
    add(sum.torque[2], 0.0 - angular * static_cast<double>(moment.z));
    if (presses && count) atomic_add(&sum.contacts, 1ll);
  }

private:
  LOAM_FN static void add(long long &sum, double units) {
    constexpr double most = 1e17; // a contribution beyond would not leave room for others
    if (units > -most && units < most) atomic_add(&sum, static_cast<long long>(units));
  }
};

// What the units are made from.
struct LeastInverseMass {
  using Value = float;
  const Row *velocities;
  LOAM_FN static Value identity() { return 1e30f; }
  LOAM_FN Value operator()(int i) const { return velocities[i].w > 0.0f ? velocities[i].w : identity(); }
  LOAM_FN static Value combine(Value a, Value b) { return minimum(a, b); }
};

// Before the sweep, which adds its own: what the planes gave in the substep.
struct AddReactions {
  const Contact *contacts;
  const Row *velocities;
  Reactions reactions;

  LOAM_FN void operator()(int i) const {
    const Contact &contact = contacts[i];
    const float inverse_mass = velocities[contact.particle].w;
    for (int k = 0; k < contact.plane_count; ++k) {
      const Vec3<float> change = contact.normal_change[k] * contact.planes[k].normal + contact.friction_change[k];
      reactions.add(contact.planes[k].collider, contact.particle, inverse_mass, change, contact.normal_change[k] != 0.0f);
    }
  }
};

} // namespace loam
