// Cloth against itself and against other cloth: pairs of vertices that keep a distance.
//
// Once a substep every two vertices that may come within their distance d are found, but for those that were that near at rest. Each pair is a half space along the line
// between them at the start of the substep,
//
//   C = |x_a - x_b| + h n . (v_a - v_b) - d >= 0,
//
// with Coulomb friction across it. Where d is at least the length of an edge, no vertex fits between those of a triangle, and no edge through another.
//
// All pairs are solved at once; a vertex in t pairs that push shares its mass among them, so that together they do not push too far. Impulses are summed in whole multiples of
// a quantum of velocity: the sum does not depend on their order.
#pragma once

#include "kernels/contact/find_contacts.h"
#include "kernels/neighbours/cell_grid.h"
#include "math/atomics.h"

namespace loam {

struct SelfContact {
  int a, b;
  Vec3<float> normal; // from b to a
  float distance;     // at the start of the substep, m
  float wanted;       // the distance to keep, m
  float impulse;      // along the normal, N s
  Vec3<float> friction;
};

// The vertices of all cloths that take part, one after the other.
struct SelfVertices {
  Row *positions;  // w: the distance to keep, half
  Row *velocities; // w: the inverse mass
  Row *rest;       // in the mesh's frame; w: the number of the cloth
};

struct GatherSelfVertices {
  const Row *positions, *velocities;
  SelfVertices to; // of this cloth
  float half_distance;
  LOAM_FN void operator()(int i) const {
    const Row x = positions[i];
    to.positions[i] = {x.x, x.y, x.z, half_distance};
    to.velocities[i] = velocities[i];
  }
};

struct NumberRestVertices {
  const Row *from;
  Row *to;
  float number; // of the cloth
  LOAM_FN void operator()(int i) const {
    const Row x = from[i];
    to[i] = {x.x, x.y, x.z, number};
  }
};

struct SumVelocities {
  struct Value {
    double x, y, z;
  };
  const Row *velocities;
  LOAM_FN static Value identity() { return {0, 0, 0}; }
  LOAM_FN Value operator()(int i) const {
    const Vec3<float> v = xyz(velocities[i]);
    if (!is_finite(v)) return identity();
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }
  LOAM_FN static Value combine(Value a, Value b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
};

struct GreatestSpeedBeside {
  using Value = float;
  const Row *velocities;
  Vec3<float> mean;
  LOAM_FN static Value identity() { return 0.0f; }
  LOAM_FN Value operator()(int i) const {
    const Vec3<float> v = xyz(velocities[i]);
    return is_finite(v) ? length(v - mean) : 0.0f;
  }
  LOAM_FN static Value combine(Value a, Value b) { return maximum(a, b); }
};

struct FindSelfContacts {
  SelfVertices vertices;
  CellGrid grid;
  const int *starts;
  const std::uint32_t *order;
  float substep;
  float most_reach; // beyond the distance
  SelfContact *contacts;
  int capacity;
  int *count; // as in FindContacts

  LOAM_FN void operator()(int a) const {
    const Row own = vertices.positions[a];
    const Vec3<float> x = xyz(own);
    if (!is_finite(x)) return;
    const int cell[3] = {grid.coordinate(x.x), grid.coordinate(x.y), grid.coordinate(x.z)};
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const int c = grid.index(grid.wrap(cell[0] + dx, 0), grid.wrap(cell[1] + dy, 1), grid.wrap(cell[2] + dz, 2));
          for (int k = starts[c]; k < starts[c + 1]; ++k)
            if (const int b = static_cast<int>(order[k]); b < a) consider(a, own, b);
        }
  }

private:
  LOAM_FN void consider(int a, Row own, int b) const {
    const Row other = vertices.positions[b];
    const Vec3<float> apart = xyz(own) - xyz(other);
    const float wanted = own.w + other.w, far = wanted + most_reach, squared = dot(apart, apart);
    if (!(squared < far * far)) return;
    const Row rest_a = vertices.rest[a], rest_b = vertices.rest[b];
    const Vec3<float> at_rest = xyz(rest_a) - xyz(rest_b);
    if (rest_a.w == rest_b.w && dot(at_rest, at_rest) < wanted * wanted) return;
    const Row va = vertices.velocities[a], vb = vertices.velocities[b];
    if (!(va.w + vb.w > 0.0f)) return;
    const float distance = square_root(squared);
    const float motion = substep * length(xyz(va) - xyz(vb));
    if (!(distance < wanted + minimum(most_reach, 0.25f * wanted + 1.5f * motion))) return;
    SelfContact contact;
    contact.a = a;
    contact.b = b;
    // In one place there is no direction; any will part them.
    contact.normal = distance > 1e-6f * wanted ? (1.0f / distance) * apart : Vec3<float>{0.0f, 1.0f, 0.0f};
    contact.distance = distance;
    contact.wanted = wanted;
    contact.impulse = 0.0f;
    contact.friction = {0.0f, 0.0f, 0.0f};
    const int slot = atomic_add(count, 1);
    if (slot < capacity) contacts[slot] = contact;
  }
};

// How the pairs of a pass are solved. In the iterations what is too near parts slowly, and impulses may be taken back; at the end of a substep nothing is taken back.
struct SelfContactPass {
  float substep;
  float recovery;    // the share of what a distance is short of that is made good in this substep
  float kept;        // of the distance that must be kept: 1, or less at the end
  bool accumulating; // impulses may be taken back, and there is friction

  LOAM_FN float gap(const SelfContact &c) const {
    const float missing = kept * c.wanted - c.distance;
    return missing > 0.0f ? 0.0f - recovery * missing : 0.0f - missing;
  }
  LOAM_FN bool pushes(const SelfContact &c, float along) const {
    return (accumulating && c.impulse > 0.0f) || along * substep + gap(c) < 0.0f;
  }
};

// In how many pairs that push each vertex is.
struct CountSelfContacts {
  const SelfContact *contacts;
  const Row *velocities;
  SelfContactPass pass;
  int *touches;
  LOAM_FN void operator()(int i) const {
    const SelfContact &c = contacts[i];
    if (!pass.pushes(c, dot(c.normal, xyz(velocities[c.a]) - xyz(velocities[c.b])))) return;
    atomic_add(touches + c.a, 1);
    atomic_add(touches + c.b, 1);
  }
};

struct SolveSelfContacts {
  SelfContact *contacts;
  const Row *velocities;
  const Row *rest;
  const float *frictions; // by number of the cloth
  SelfContactPass pass;
  const int *touches;
  int *changes; // 3 a vertex: velocity in quanta
  float quantum;

  LOAM_FN void operator()(int i) const {
    SelfContact &c = contacts[i];
    const Row a = velocities[c.a], b = velocities[c.b];
    const Vec3<float> slip = xyz(a) - xyz(b);
    const float along = dot(c.normal, slip);
    if (!pass.pushes(c, along)) return;
    const float weight = a.w * static_cast<float>(touches[c.a]) + b.w * static_cast<float>(touches[c.b]);
    const float more = 0.0f - (along + pass.gap(c) / pass.substep) / weight;
    if (!pass.accumulating) {
      give(c, a.w, b.w, more * c.normal);
      return;
    }
    const float impulse = maximum(0.0f, c.impulse + more);
    Vec3<float> change = (impulse - c.impulse) * c.normal;
    c.impulse = impulse;
    Vec3<float> wanted = c.friction - (1.0f / weight) * (slip - along * c.normal);
    const float friction = 0.5f * (frictions[static_cast<int>(rest[c.a].w)] + frictions[static_cast<int>(rest[c.b].w)]);
    const float size = length(wanted), limit = friction * impulse;
    if (size > limit) wanted = (limit / size) * wanted;
    change = change + (wanted - c.friction);
    c.friction = wanted;
    give(c, a.w, b.w, change);
  }

private:
  LOAM_FN void give(const SelfContact &c, float inverse_mass_a, float inverse_mass_b, Vec3<float> impulse) const {
    add(c.a, inverse_mass_a * impulse);
    add(c.b, (0.0f - inverse_mass_b) * impulse);
  }
  LOAM_FN void add(int vertex, Vec3<float> velocity) const {
    int *change = changes + 3 * static_cast<long>(vertex);
    atomic_add(change, quanta(velocity.x));
    atomic_add(change + 1, quanta(velocity.y));
    atomic_add(change + 2, quanta(velocity.z));
  }
  LOAM_FN int quanta(float velocity) const {
    const float q = velocity / quantum;
    return static_cast<int>(floorf(minimum(maximum(q, -1e8f), 1e8f) + 0.5f));
  }
};

struct ApplySelfChanges {
  Row *velocities;
  int *changes, *touches;
  float quantum;
  LOAM_FN void operator()(int i) const {
    if (touches[i] == 0) return;
    int *change = changes + 3 * static_cast<long>(i);
    Row &v = velocities[i];
    v.x += quantum * static_cast<float>(change[0]);
    v.y += quantum * static_cast<float>(change[1]);
    v.z += quantum * static_cast<float>(change[2]);
    change[0] = change[1] = change[2] = touches[i] = 0;
  }
};

struct ScatterSelfVelocities {
  const Row *from;
  Row *to;
  LOAM_FN void operator()(int i) const { to[i] = from[i]; }
};

} // namespace loam
