// What acts on matter through space. See include/loam/field.h.
#pragma once

#include <cstdint>

#include "kernels/integration/integrate.h"
#include "math/functions.h"
#include "math/vector.h"

namespace loam {

enum class FieldKind : std::uint32_t { wind, attractor, blast };

// In a step, as kernels see it.
struct FieldView {
  FieldKind kind;
  int substep; // blast: when
  Vec3<float> centre, velocity;
  float radius; // blast, wind: beyond it nothing acts; 0: no bound
  float
      strength; // wind: the share of the difference that goes in a substep; attractor: m^3/s^2 times the substep; blast: m/s
  float softening; // squared
};

struct ApplyFields {
  const Row *positions;
  Row *velocities;
  const FieldView *fields;
  int count, substep;
  bool winds; // whether those are for these
  float greatest_speed;
  int *limited; // counter

  LOAM_FN void operator()(int i) const {
    Row row = velocities[i];
    if (row.w == 0.0f) return; // pinned
    const Vec3<float> x = xyz(positions[i]);
    Vec3<float> v = xyz(row);
    for (int k = 0; k < count; ++k) {
      const FieldView &field = fields[k];
      const Vec3<float> d = x - field.centre;
      const float squared = dot(d, d);
      if (field.radius > 0.0f && !(squared <= field.radius * field.radius)) continue;
      switch (field.kind) {
      case FieldKind::wind:
        if (winds) v = v + field.strength * (field.velocity - v);
        break;
      case FieldKind::attractor: {
        const float root = square_root(squared + field.softening);
        v = v - (field.strength / root / root / root) * d;
        break;
      }
      case FieldKind::blast: {
        const float distance = square_root(squared);
        // In the centre no direction is away from it.
        if (field.substep == substep && distance > 0.0f)
          v = v + (field.strength * (1.0f - distance / field.radius) / distance) * d;
        break;
      }
      }
    }
    row.x = v.x;
    row.y = v.y;
    row.z = v.z;
    if (slow_down(row, greatest_speed)) atomic_add(limited, 1);
    velocities[i] = row;
  }
};

} // namespace loam
