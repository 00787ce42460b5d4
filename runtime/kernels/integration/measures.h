// Reductions over particles and contacts: what the statistics report, and the hash of the state.
#pragma once

#include <cstdint>

#include "kernels/contact/collider_view.h"
#include "kernels/inelastic/measure_constraint.h"
#include "kernels/neighbours/sort_stages.h"

namespace loam {

struct SumCounts {
  using Value = long long;
  const int *counts;
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const { return counts[i]; }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

struct MotionMeasure {
  struct Value {
    double kinetic_energy, speed_sum, momentum[3];
    float max_speed;
    long long non_finite;
  };
  const Row *positions;
  const Row *velocities;
  const float *strains;

  LOAM_FN static Value identity() { return {0, 0, {0, 0, 0}, 0, 0}; }
  LOAM_FN Value operator()(int i) const {
    Value value = identity();
    const Row v = velocities[i], x = positions[i];
    bool finite = is_finite(xyz(v)) && is_finite(xyz(x));
    for (int k = 0; k < 6; ++k) finite = finite && is_finite(strains[6 * static_cast<long>(i) + k]);
    if (!finite) {
      value.non_finite = 1;
      return value;
    }
    const float speed = length(xyz(v));
    value.speed_sum = speed;
    value.max_speed = speed;
    if (v.w > 0.0f) {
      const double mass = 1.0 / v.w;
      value.kinetic_energy = 0.5 * mass * speed * speed;
      value.momentum[0] = mass * v.x;
      value.momentum[1] = mass * v.y;
      value.momentum[2] = mass * v.z;
    }
    return value;
  }
  LOAM_FN static Value combine(const Value &a, const Value &b) {
    return {a.kinetic_energy + b.kinetic_energy,
            a.speed_sum + b.speed_sum,
            {a.momentum[0] + b.momentum[0], a.momentum[1] + b.momentum[1], a.momentum[2] + b.momentum[2]},
            maximum(a.max_speed, b.max_speed),
            a.non_finite + b.non_finite};
  }
};

// The moment of the weight about the origin, along gravity.
struct WeightMoment {
  using Value = double;
  const Row *positions;
  const Row *velocities;
  Vec3<float> gravity;
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const {
    const Row x = positions[i];
    const float w = velocities[i].w;
    if (!(w > 0.0f) || !is_finite(xyz(x))) return 0;
    return (0.0 - (static_cast<double>(gravity.x) * x.x + static_cast<double>(gravity.y) * x.y +
                   static_cast<double>(gravity.z) * x.z)) /
           w;
  }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

// The moment of the contact forces about the origin, along `up`: sum of (f . up)(x . up), times the substep.
struct ContactMoment {
  using Value = double;
  const Contact *contacts;
  const Row *positions;
  const Row *velocities;
  Vec3<float> up;
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const {
    const Contact &c = contacts[i];
    const float w = velocities[c.particle].w;
    if (!(w > 0.0f)) return 0;
    Vec3<float> change = {0.0f, 0.0f, 0.0f};
    for (int k = 0; k < c.plane_count; ++k) change = change + c.normal_change[k] * c.planes[k].normal + c.friction_change[k];
    return static_cast<double>(dot(change, up)) * dot(xyz(positions[c.particle]), up) / w;
  }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

// Contact planes, and the deepest contact.
struct MeasureContacts {
  struct Value {
    long long planes;
    float depth; // m
  };
  const Contact *contacts;
  LOAM_FN static Value identity() { return {0, 0}; }
  LOAM_FN Value operator()(int i) const { return {contacts[i].plane_count, contacts[i].depth}; }
  LOAM_FN static Value combine(const Value &a, const Value &b) { return {a.planes + b.planes, maximum(a.depth, b.depth)}; }
};

// Of fluids: density over rest density less 1, where it is more. A fluid keeps 1 / density - 1 for its strain.
struct MeanCompression {
  struct Value {
    double sum;
    long long count;
  };
  const float *is_fluid; // of each material: 1 or 0
  const std::uint32_t *materials;
  const float *strains;
  LOAM_FN static Value identity() { return {0, 0}; }
  LOAM_FN Value operator()(int i) const {
    if (!(is_fluid[materials[i]] > 0.0f)) return identity();
    const float compression = 1.0f / (1.0f + strains[6 * static_cast<long>(i)]) - 1.0f;
    return {compression > 0.0f && is_finite(compression) ? compression : 0.0, 1};
  }
  LOAM_FN static Value combine(const Value &a, const Value &b) { return {a.sum + b.sum, a.count + b.count}; }
};

struct SumTerms {
  struct Value {
    double term[ConstraintTerms::term_count];
  };
  const float *terms;
  LOAM_FN static Value identity() { return {{0, 0, 0, 0}}; }
  LOAM_FN Value operator()(int i) const {
    const float *t = terms + static_cast<long>(i) * ConstraintTerms::term_count;
    return {{t[0], t[1], t[2], t[3]}};
  }
  LOAM_FN static Value combine(const Value &a, const Value &b) {
    return {{a.term[0] + b.term[0], a.term[1] + b.term[1], a.term[2] + b.term[2], a.term[3] + b.term[3]}};
  }
};

// A sum of one mixed word a particle: independent of how the sum is cut up, dependent on the particle's place in the order, which decides the future too.
struct StateHash {
  using Value = std::uint64_t;
  ParticleArrays particles;

  LOAM_FN static std::uint64_t mix(std::uint64_t h, std::uint64_t word) {
    h = (h ^ word) * 0x9E3779B97F4A7C15ull;
    return h ^ (h >> 29);
  }
  // Plus and minus zero act alike, so they count alike.
  LOAM_FN static std::uint64_t bits(float value) {
    union {
      float f;
      std::uint32_t u;
    } pun;
    pun.f = value + 0.0f;
    return pun.u;
  }
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const {
    std::uint64_t h = mix(0x243F6A8885A308D3ull, static_cast<std::uint64_t>(i));
    const Row x = particles.positions[i], v = particles.velocities[i];
    const float rows[8] = {x.x, x.y, x.z, x.w, v.x, v.y, v.z, v.w};
    for (int k = 0; k < 8; ++k) h = mix(h, bits(rows[k]));
    for (int k = 0; k < 6; ++k) h = mix(h, bits(particles.strains[6 * static_cast<long>(i) + k]));
    // What no material asks for is 0 where it is held, and counts the same where it is not.
    h = mix(h, particles.histories != nullptr ? bits(particles.histories[i]) : 0);
    for (int k = 0; k < 3; ++k)
      h = mix(h, particles.drifts != nullptr ? bits(particles.drifts[3 * static_cast<long>(i) + k]) : 0);
    h = mix(h, particles.displacements != nullptr ? bits(particles.displacements[i]) : 0);
    if (particles.stresses != nullptr) {
      for (int k = 0; k < 6; ++k) h = mix(h, bits(particles.stresses[6 * static_cast<long>(i) + k]));
      for (int k = 0; k < 3; ++k)
        h = mix(h, particles.answered_drifts != nullptr ? bits(particles.answered_drifts[3 * static_cast<long>(i) + k]) : 0);
    }
    h = mix(h, bits(particles.log_volumes[i]));
    h = mix(h, bits(particles.rest_volumes[i]));
    if (particles.rests != nullptr) h = mix(h, bits(particles.rests[i]));
    if (particles.ages != nullptr) h = mix(h, bits(particles.ages[i]));
    h = mix(h, particles.ids[i]);
    return mix(h, particles.materials[i]);
  }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

struct HashRows {
  using Value = std::uint64_t;
  const Row *rows;
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const {
    std::uint64_t h = StateHash::mix(0x13198A2E03707344ull, static_cast<std::uint64_t>(i));
    const Row r = rows[i];
    h = StateHash::mix(h, StateHash::bits(r.x));
    h = StateHash::mix(h, StateHash::bits(r.y));
    h = StateHash::mix(h, StateHash::bits(r.z));
    return StateHash::mix(h, StateHash::bits(r.w));
  }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

// Densities for the mapped view.
struct ComputeDensities {
  const Row *positions, *velocities;
  float *densities;
  LOAM_FN void operator()(int i) const {
    const float w = velocities[i].w;
    densities[i] = w > 0.0f ? 1.0f / (w * positions[i].w) : 0.0f;
  }
};

} // namespace loam
