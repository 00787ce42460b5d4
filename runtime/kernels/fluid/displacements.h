// Around the solve for displacements (density_constraint.h): where they start, and what walls do to them.
#pragma once

#include "kernels/contact/collider_view.h"
#include "math/random_of_id.h"
#include "math/vector.h"

namespace loam {

// u = v. Only fluid is displaced: the strain of other matter follows its velocity, and what sleeps stays where it is.
struct StartDisplacements {
  const Row *velocities;
  const std::uint32_t *materials;
  const float *is_fluid; // of each material: 1 or 0
  const float *rests;    // null: nothing sleeps
  Row *displacements;    // over the substep; fourth component: the inverse mass, 0 for what is not displaced

  LOAM_FN void operator()(int i) const {
    Row v = velocities[i];
    v.w = v.w * is_fluid[materials[i]];
    if (rests != nullptr && rests[i] < 0.0f) v.w = 0.0f;
    displacements[i] = v;
  }
};

// They stay small beside a particle's neighbourhood, and within what contacts were looked for. Particles in one place have no direction to part in: where it is
// as crowded as it hardly is otherwise, each goes a little in one of its own.
struct LimitDisplacements {
  const Row *velocities;
  const float *strains; // 1 / compression - 1, see prepare_fluid.h
  const std::uint32_t *ids;
  Row *displacements;
  float most;                                            // beyond the velocity
  float greatest_speed;                                  // r / h, as for velocities
  static constexpr float crowded = -0.8f, nudge = 1e-3f; // the latter of the greatest speed

  LOAM_FN void operator()(int i) const {
    Row row = displacements[i];
    if (row.w == 0.0f) return;
    const Vec3<float> v = xyz(velocities[i]);
    Vec3<float> change = xyz(row) - v;
    const float size = length(change);
    if (size > most) change = (most / size) * change;
    if (strains[6 * static_cast<long>(i)] < crowded)
      change = change + (nudge * greatest_speed) *
                            Vec3<float>{random_of_id(0, ids[i], 0), random_of_id(0, ids[i], 1), random_of_id(0, ids[i], 2)};
    Vec3<float> u = v + change;
    const float speed = length(u), greatest = maximum(greatest_speed, length(v));
    if (speed > greatest) u = (greatest / speed) * u;
    displacements[i] = {u.x, u.y, u.z, row.w};
  }
};

// Displacements keep to the same planes as velocities; here nothing is accumulated, for no collider feels them.
struct KeepDisplacementsOut {
  const Contact *contacts;
  Row *displacements;
  float substep;

  LOAM_FN void operator()(int index) const {
    const Contact &contact = contacts[index];
    Row row = displacements[contact.particle];
    if (row.w == 0.0f) return;
    Vec3<float> u = xyz(row);
    for (int i = contact.plane_count - 1; i >= 0; --i) {
      const ContactPlane &plane = contact.planes[i];
      const float missing = 0.0f - (dot(plane.normal, u) + plane.gap / substep);
      if (missing > 0.0f) u = u + missing * plane.normal;
    }
    displacements[contact.particle] = {u.x, u.y, u.z, row.w};
  }
};

} // namespace loam
