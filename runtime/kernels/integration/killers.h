// Which particles killers take. See include/loam/killer.h.
#pragma once

#include <cstdint>

#include "kernels/contact/pose.h"
#include "math/atomics.h"
#include "math/functions.h"

namespace loam {

enum class KillerKind : std::uint32_t { box, sphere, age };

struct KillerView {
  KillerKind kind;
  int material; // -1: any
  Pose pose;
  Vec3<float> half_extents;
  float radius, age;
  bool outside;

  LOAM_FN bool takes(Vec3<float> x, std::uint32_t of, float old) const {
    if (material >= 0 && of != static_cast<std::uint32_t>(material)) return false;
    if (kind == KillerKind::age) return old >= age;
    bool inside;
    if (kind == KillerKind::sphere) {
      const Vec3<float> d = x - pose.position;
      inside = dot(d, d) <= radius * radius;
    } else {
      const Vec3<float> d = to_local(pose, x);
      inside = absolute(d.x) <= half_extents.x && absolute(d.y) <= half_extents.y && absolute(d.z) <= half_extents.z;
    }
    return inside != outside;
  }
};

struct AgeParticles {
  float *ages;
  float seconds;
  LOAM_FN void operator()(int i) const { ages[i] += seconds; }
};

// Lists those that go, in any order, with the number of the first killer that claims them.
struct FindKilled {
  const Row *positions;
  const std::uint32_t *materials;
  const float *ages; // null: no killer asks
  const KillerView *killers;
  int killer_count;
  std::uint32_t *places, *killer_of;
  int *count;
  LOAM_FN void operator()(int i) const {
    const Vec3<float> x = xyz(positions[i]);
    const float age = ages != nullptr ? ages[i] : 0.0f;
    for (int k = 0; k < killer_count; ++k)
      if (killers[k].takes(x, materials[i], age)) {
        const int at = atomic_add(count, 1);
        places[at] = static_cast<std::uint32_t>(i);
        killer_of[at] = static_cast<std::uint32_t>(k);
        return;
      }
  }
};

// Who they are.
struct NameKilled {
  const std::uint32_t *places, *ids, *materials;
  std::uint32_t *killed_ids, *killed_materials;
  LOAM_FN void operator()(int i) const {
    killed_ids[i] = ids[places[i]];
    killed_materials[i] = materials[places[i]];
  }
};

} // namespace loam
