// Particles against a cloth's triangles, both ways.
//
// Once a substep each particle near the cloth finds up to four points of it that it must keep away from, as half spaces relative to the cloth's motion. In the iterations
// a particle goes through its own in turn, with accumulated impulses clipped as in kernels/contact/solve_contacts.h, and hands the vertices their share by the
// point's barycentric weights. Many particles meet at a vertex: each sees it lighter by their number (mass splitting, Tonge et al. 2012), so that all of their
// impulses together do not overshoot. For cloth that nothing holds, those that push it count, so that soon both move as one and keep their momentum. Cloth that is held
// would give way too far like that, for what holds it is felt through the iterations of its own constraints only: there all count that might push.
//
// Impulses on vertices are summed in whole multiples of a quantum of velocity, by integer additions: the sum does not depend on their order. And the particle receives
// the opposite of what its vertices really get, so no momentum is lost to the rounding.
#pragma once

#include "kernels/contact/closest_point_on_triangle.h"
#include "kernels/contact/find_contacts.h"
#include "kernels/neighbours/cell_grid.h"
#include "math/atomics.h"

namespace loam {

struct ClothContactPoint {
  int vertices[3];
  float weights[3]; // of the vertices in the point
  Vec3<float> normal;
  float gap;      // as a ContactPlane's
  float distance; // at the start of the substep
  float impulse;  // along the normal, N s
  Vec3<float> friction;
};

struct ClothContact {
  static constexpr int max_points = 4;
  int particle;
  int count;
  ClothContactPoint points[max_points]; // closest first
};

// The middle of each triangle, and in w how far its vertices are from it.
struct BoundTriangles {
  const Row *positions;
  const int *triangles;
  Row *bounds;
  LOAM_FN void operator()(int i) const {
    const int *t = triangles + 3 * static_cast<long>(i);
    const Vec3<float> a = xyz(positions[t[0]]), b = xyz(positions[t[1]]), c = xyz(positions[t[2]]);
    const Vec3<float> middle = (1.0f / 3.0f) * (a + (b + c));
    const float squared =
        maximum(dot(a - middle, a - middle), maximum(dot(b - middle, b - middle), dot(c - middle, c - middle)));
    bounds[i] = {middle.x, middle.y, middle.z, 1.00001f * square_root(squared)};
  }
};

struct GreatestRadius {
  using Value = float;
  const Row *bounds;
  LOAM_FN static Value identity() { return 0.0f; }
  LOAM_FN Value operator()(int i) const { return is_finite(bounds[i].w) ? bounds[i].w : 0.0f; }
  LOAM_FN static Value combine(Value a, Value b) { return maximum(a, b); }
};

// The triangles by cells: those of cell c are order[starts[c]] up to order[starts[c + 1]].
struct TriangleGrid {
  CellGrid grid;
  int lower[3], upper[3]; // the cells that hold triangles
  const int *starts;
  const std::uint32_t *order;
};

struct FindClothContacts {
  const Row *particles, *particle_velocities;
  const Row *positions, *velocities; // of the vertices
  const int *triangles;
  const Row *bounds;
  TriangleGrid grid;
  float substep;
  float stand_off;               // the distance to keep
  float least_reach, most_reach; // how far beyond it a point is looked for: what the particle and the cloth may move
  ClothContact *contacts;
  int capacity;
  int *count; // as in FindContacts

  LOAM_FN void operator()(int particle) const {
    const Vec3<float> x = xyz(particles[particle]);
    if (!is_finite(x)) return;
    const int cell[3] = {grid.grid.coordinate(x.x), grid.grid.coordinate(x.y), grid.grid.coordinate(x.z)};
    for (int k = 0; k < 3; ++k)
      if (cell[k] < grid.lower[k] - 1 || cell[k] > grid.upper[k] + 1) return;
    ClothContact contact;
    contact.particle = particle;
    contact.count = 0;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const CellGrid &g = grid.grid;
          const int c = g.index(g.wrap(cell[0] + dx, 0), g.wrap(cell[1] + dy, 1), g.wrap(cell[2] + dz, 2));
          for (int k = grid.starts[c]; k < grid.starts[c + 1]; ++k) consider(static_cast<int>(grid.order[k]), x, contact);
        }
    if (contact.count == 0) return;
    const int slot = atomic_add(count, 1);
    if (slot < capacity) contacts[slot] = contact;
  }

private:
  LOAM_FN void consider(int triangle, Vec3<float> x, ClothContact &contact) const {
    const Row bound = bounds[triangle];
    const Vec3<float> apart = x - xyz(bound);
    const float far = bound.w + stand_off + most_reach;
    if (!(dot(apart, apart) < far * far)) return;
    const int *t = triangles + 3 * static_cast<long>(triangle);
    const Vec3<float> a = xyz(positions[t[0]]) - x, b = xyz(positions[t[1]]) - x, c = xyz(positions[t[2]]) - x;
    const Vec3<float> area = cross(b - a, c - a);
    const float twice = length(area);
    if (!(twice > 1e-12f * bound.w * bound.w)) return; // a line; its neighbours have its edges
    const Vec3<float> own_normal = (1.0f / twice) * area;
    const ClosestPoint<float> closest = closest_point_on_triangle(a, b, c, own_normal);
    const float distance = square_root(closest.distance_squared);
    const Vec3<float> cloth_velocity =
        (1.0f / 3.0f) * (xyz(velocities[t[0]]) + (xyz(velocities[t[1]]) + xyz(velocities[t[2]])));
    const float motion = substep * length(xyz(particle_velocities[contact.particle]) - cloth_velocity);
    if (!(distance < stand_off + minimum(most_reach, least_reach + 1.5f * motion))) return;

    ClothContactPoint point;
    for (int k = 0; k < 3; ++k) point.vertices[k] = t[k];
    const Vec3<float> q = closest.point;
    const float u = maximum(0.0f, dot(own_normal, cross(c - b, q - b)) / twice);
    const float v = maximum(0.0f, dot(own_normal, cross(a - c, q - c)) / twice);
    const float w = maximum(0.0f, dot(own_normal, cross(b - a, q - a)) / twice);
    const float sum = u + (v + w);
    point.weights[0] = u / sum;
    point.weights[1] = v / sum;
    point.weights[2] = w / sum;
    if (distance > 0.02f * stand_off)
      point.normal = (-1.0f / distance) * closest.point;
    else
      point.normal = dot(own_normal, a) > 0.0f ? -1.0f * own_normal : own_normal;
    const float missing = stand_off - distance, recovery = minimum(contact_recovery_share, substep / contact_recovery_time);
    point.gap = missing > 0.0f ? 0.0f - recovery * missing : 0.0f - missing;
    point.distance = distance;
    point.impulse = 0.0f;
    point.friction = {0.0f, 0.0f, 0.0f};
    insert(point, contact);
  }

  // Of points in nearly the same direction only the closest stays, of more than four the closest four. Points are met in a fixed order.
  LOAM_FN static void insert(const ClothContactPoint &point, ClothContact &contact) {
    constexpr float parallel = 0.98f;
    for (int i = contact.count - 1; i >= 0; --i) {
      if (!(dot(contact.points[i].normal, point.normal) > parallel)) continue;
      if (contact.points[i].distance <= point.distance) return;
      --contact.count;
      for (int k = i; k < contact.count; ++k) contact.points[k] = contact.points[k + 1];
    }
    int at = contact.count;
    while (at > 0 && point.distance < contact.points[at - 1].distance) --at;
    if (at == ClothContact::max_points) return;
    if (contact.count < ClothContact::max_points) ++contact.count;
    for (int i = contact.count - 1; i > at; --i) contact.points[i] = contact.points[i - 1];
    contact.points[at] = point;
  }
};

// Impulses on the cloth, in quanta.
struct ClothImpulses {
  const Row *velocities; // of the vertices; not written here
  int *changes;          // 3 a vertex: velocity in quanta
  float quantum;

  // Gives the vertices minus the impulse; answers with what the particle is to have for it.
  LOAM_FN Vec3<float> hand_over(const ClothContactPoint &p, Vec3<float> impulse) const {
    Vec3<float> received = {0.0f, 0.0f, 0.0f};
    for (int j = 0; j < 3; ++j) {
      const float w = velocities[p.vertices[j]].w;
      if (!(w > 0.0f)) {
        received = received + p.weights[j] * impulse;
        continue;
      }
      const float share = p.weights[j] * w;
      const int x = quanta(share * impulse.x), y = quanta(share * impulse.y), z = quanta(share * impulse.z);
      int *change = changes + 3 * static_cast<long>(p.vertices[j]);
      if (x != 0) atomic_add(change, -x);
      if (y != 0) atomic_add(change + 1, -y);
      if (z != 0) atomic_add(change + 2, -z);
      const float mass = quantum / w;
      received =
          received + Vec3<float>{mass * static_cast<float>(x), mass * static_cast<float>(y), mass * static_cast<float>(z)};
    }
    return received;
  }

private:
  LOAM_FN int quanta(float change) const {
    const float q = change / quantum;
    return static_cast<int>(floorf(minimum(maximum(q, -1e8f), 1e8f) + 0.5f));
  }
};

// What there is between a particle and a point of the cloth.
struct ClothApproach {
  Vec3<float> slip; // the particle's velocity past the point
  float along;      // of it, along the normal
  LOAM_FN ClothApproach(const ClothContactPoint &p, Vec3<float> v, const Row *vertices) {
    Vec3<float> u = {0.0f, 0.0f, 0.0f};
    for (int j = 0; j < 3; ++j) u = u + p.weights[j] * xyz(vertices[p.vertices[j]]);
    slip = v - u;
    along = dot(p.normal, slip);
  }
};

// The velocity by which a point falls short, over 0 where it pushes. In the iterations what is too near parts slowly, and impulses may be taken back; at the end of a substep
// nothing passes a point, and nothing is taken back.
struct ClothShortfall {
  float substep;
  float margin; // to keep at the end, a small share of the stand-off; under 0: in the iterations
  LOAM_FN float operator()(const ClothContactPoint &p, float along) const {
    const float gap = margin < 0.0f ? p.gap : p.distance - minimum(margin, p.distance);
    return 0.0f - (along + gap / substep);
  }
  LOAM_FN bool pushes(const ClothContactPoint &p, float along) const {
    return (margin < 0.0f && p.impulse > 0.0f) || (*this)(p, along) > 0.0f;
  }
};

// By how many points each vertex is pushed, or may be.
struct CountClothContacts {
  const ClothContact *contacts;
  const Row *particle_velocities, *velocities;
  ClothShortfall shortfall;
  bool all; // what may
  int *touches;
  LOAM_FN void operator()(int i) const {
    const ClothContact &contact = contacts[i];
    const Vec3<float> v = xyz(particle_velocities[contact.particle]);
    for (int k = 0; k < contact.count; ++k) {
      const ClothContactPoint &p = contact.points[k];
      if (!all && !shortfall.pushes(p, ClothApproach(p, v, velocities).along)) continue;
      for (int j = 0; j < 3; ++j)
        if (p.weights[j] > 0.0f) atomic_add(touches + p.vertices[j], 1);
    }
  }
};

struct SolveClothContacts {
  ClothContact *contacts;
  Row *particle_velocities;
  ClothImpulses cloth;
  const int *touches;
  ClothShortfall shortfall;
  float friction;

  LOAM_FN void operator()(int index) const {
    ClothContact &contact = contacts[index];
    Row &row = particle_velocities[contact.particle];
    Vec3<float> v = xyz(row);
    // The closest point comes last: where points contradict each other, it wins.
    for (int k = contact.count - 1; k >= 0; --k) {
      ClothContactPoint &p = contact.points[k];
      const ClothApproach approach(p, v, cloth.velocities);
      if (!shortfall.pushes(p, approach.along)) continue;
      float weight = row.w;
      for (int j = 0; j < 3; ++j) {
        const int vertex = p.vertices[j];
        weight +=
            p.weights[j] * p.weights[j] * cloth.velocities[vertex].w * maximum(1.0f, static_cast<float>(touches[vertex]));
      }
      if (!(weight > 0.0f)) continue;
      v = v + row.w * cloth.hand_over(p, answer(p, approach, weight));
    }
    row.x = v.x;
    row.y = v.y;
    row.z = v.z;
  }

private:
  LOAM_FN Vec3<float> answer(ClothContactPoint &p, const ClothApproach &approach, float weight) const {
    const float more = shortfall(p, approach.along) / weight;
    if (!(shortfall.margin < 0.0f)) return more * p.normal;
    const float impulse = maximum(0.0f, p.impulse + more);
    const Vec3<float> change = (impulse - p.impulse) * p.normal;
    p.impulse = impulse;
    Vec3<float> wanted = p.friction - (1.0f / weight) * (approach.slip - approach.along * p.normal);
    const float size = length(wanted), limit = friction * impulse;
    if (size > limit) wanted = (limit / size) * wanted;
    const Vec3<float> rubbed = wanted - p.friction;
    p.friction = wanted;
    return change + rubbed;
  }
};

struct ApplyClothChanges {
  Row *velocities;
  int *changes;
  int *touches; // to be counted anew; null: they stay
  float quantum;
  LOAM_FN void operator()(int i) const {
    int *change = changes + 3 * static_cast<long>(i);
    Row &v = velocities[i];
    v.x += quantum * static_cast<float>(change[0]);
    v.y += quantum * static_cast<float>(change[1]);
    v.z += quantum * static_cast<float>(change[2]);
    change[0] = change[1] = change[2] = 0;
    if (touches != nullptr) touches[i] = 0;
  }
};

} // namespace loam
