// What is beyond a wall counts as fluid of the rest density, or particles would crowd along it: half a kernel of neighbours is missing there.
//
// The kernel's integral over the half space at the distance D, with t = 1 - D / 2r:  3.5 t^6 - 4.5 t^7 + 1.5 t^8;  its derivative by -D is
// the integral over the plane, (21 / 2r) t^5 (1 - 1.5 t + 4/7 t^2).
#pragma once

#include "kernels/contact/collider_view.h"

namespace loam {

struct CountWalls {
  const Contact *contacts;
  Row *walls; // of each particle: the gradient of the density by its own motion, and the density
  float stand_off, half_inverse_radius;
  float value_share,
      slope_share; // of the integrals, so that a lattice at the stand-off counts as it does beside more of itself

  LOAM_FN void operator()(int index) const {
    const Contact &contact = contacts[index];
    Vec3<float> gradient = {0.0f, 0.0f, 0.0f};
    float total = 0.0f;
    for (int i = 0; i < contact.plane_count; ++i) {
      const ContactPlane &plane = contact.planes[i];
      bool again = false; // a curved wall shows several planes
      for (int j = 0; j < i; ++j) again = again || dot(plane.normal, contact.planes[j].normal) > 0.8f;
      if (again) continue;
      const float t = minimum(1.0f, 1.0f - (plane.gap + stand_off) * half_inverse_radius);
      if (!(t > 0.0f)) continue;
      const float t2 = t * t, t5 = t2 * t2 * t;
      const float density = value_share * t5 * t * (3.5f + t * (1.5f * t - 4.5f));
      const float slope = slope_share * 21.0f * half_inverse_radius * t5 * (1.0f + t * ((4.0f / 7.0f) * t - 1.5f));
      // where half spaces cross, as independent shares
      gradient = (1.0f - density) * gradient - ((1.0f - total) * slope) * plane.normal;
      total = total + density - total * density;
    }
    walls[contact.particle] = {gradient.x, gradient.y, gradient.z, total};
  }
};

} // namespace loam
