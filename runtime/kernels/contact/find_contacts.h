// Once a substep: which planes hold a particle back.
//
// A particle keeps the stand-off from every collider. For a convex solid that is the half space beyond the nearest point, facing the particle, which keeps
// clear of all of the solid. For a mesh it becomes, for one substep, up to four half spaces, each through a
// point of the surface that is closest to the particle, and facing the particle: a mesh is solid on neither side.
//
//        o  x at the start                Which points? Those where the distance to the particle has a local minimum over
//       /|\                               the surface. The floor below gives q alone: at p and s the surface goes on towards q, so
//      / | \                              their planes, tilted, would be bumps that are not there ("ghost collisions at internal
//   __p__q__s___                          edges"). A concave corner has a minimum on each wall, and both are kept.
//
// Whether a point on an edge or a vertex is a minimum is read off the triangles that share it: it is not if one of their far
// vertices (the feature's ring) lies on the particle's side of the plane through the point. One triangle owns each feature and speaks for it; if that
// one is closest elsewhere, it is closer there, and the point was no minimum either.
//
// The half space is placed where the collider will be at the end of the substep. If the particle starts nearer than the stand-off, it
// must not come nearer still, and moves out slowly: at once would be a velocity, and sand would pop instead of rest.
//
// Most particles are far from every collider for many substeps: see free_distance.h.
#pragma once

#include "kernels/contact/free_distance.h"
#include "kernels/contact/mesh_query.h"
#include "math/atomics.h"

namespace loam {

// A particle that is too near moves out by this share of what is missing in a substep, but not faster than in this time (seconds). Against
// gravity g the way out ends without a hop while the stand-off is under g T^2, 2.5 cm on Earth.
constexpr float contact_recovery_share = 0.2f;
constexpr float contact_recovery_time = 0.05f;

// The planes of one particle while they are being collected, least gap first.
struct PlaneList {
  ContactPlane planes[Contact::max_planes];
  int collider[Contact::max_planes];
  int count = 0;
  float depth = 0; // of the deepest that came in: how much is missing to the stand-off

  LOAM_FN void remove(int at) {
    --count;
    for (int i = at; i < count; ++i) {
      planes[i] = planes[i + 1];
      collider[i] = collider[i + 1];
    }
  }

  // Of planes of one collider within eight degrees of each other only the closest stays; of more than four the closest four.
  LOAM_FN void insert(const ContactPlane &plane, int of, float missing) {
    constexpr float parallel = 0.99f;
    for (int i = count - 1; i >= 0; --i) {
      if (collider[i] != of || !(dot(planes[i].normal, plane.normal) > parallel)) continue;
      if (planes[i].gap <= plane.gap) return;
      remove(i);
    }
    int at = count;
    while (at > 0 && plane.gap < planes[at - 1].gap) --at;
    if (at == Contact::max_planes) return;
    if (count < Contact::max_planes) ++count;
    for (int i = count - 1; i > at; --i) {
      planes[i] = planes[i - 1];
      collider[i] = collider[i - 1];
    }
    planes[at] = plane;
    collider[at] = of;
    depth = maximum(depth, missing);
  }
};

// `Deforms`: there is a mesh whose vertices move. Worlds without pay nothing for it.
template <bool Deforms> struct FindContactsOf {
  const Row *positions;  // at the start of the substep
  const Row *velocities; // w is the inverse mass; 0: pinned, has no contacts
  const ColliderView *colliders;
  int collider_count;
  float substep;   // s
  float stand_off; // the distance to keep
  float reach;     // the most that a particle can move in the substep by itself
  Contact *contacts;
  int capacity;
  int *count; // zero before; counts on past the capacity, for the host to make room and run again
  FreeDistances free_distances = {nullptr, 0.0f};
  const std::uint32_t *materials =
      nullptr;              // of the particles; read where a collider has laws of its own for some. Null: of none
  float rest_speed = 0.0f;  // see ContactParticle
  float near_share = 0.25f; // of the reach, within which every plane is collected

  LOAM_FN void operator()(int particle) const {
    if (free_distances.suffices(particle)) return;
    const Vec3<float> x = xyz(positions[particle]);
    if (velocities[particle].w == 0.0f || !is_finite(x)) return;
    PlaneList list;
    float clearance = stand_off + reach, free = 1e30f;
    for (int i = 0; i < collider_count; ++i) {
      if (is_mesh(colliders[i].shape)) {
        find_mesh(i, particle, x, list, clearance, free);
      } else {
        find_solid(i, particle, x, list, clearance, free);
      }
    }
    free_distances.keep(particle, free);
    if (list.count == 0) return;
    const int slot = atomic_add(count, 1);
    if (slot >= capacity) return;
    Contact &contact = contacts[slot];
    contact.particle = particle;
    contact.plane_count = list.count;
    contact.depth = list.depth;
    contact.clearance = clearance;
    for (int i = 0; i < list.count; ++i) {
      contact.planes[i] = list.planes[i];
      contact.normal_change[i] = 0.0f;
      contact.friction_change[i] = {0.0f, 0.0f, 0.0f};
    }
  }

private:
  // Where a point that moves with the collider goes in the substep.
  LOAM_FN static Vec3<float> carried(const ColliderView &collider, Vec3<float> local) {
    if (at_rest(collider)) return {0.0f, 0.0f, 0.0f};
    return (rotate(collider.end.rotation, local) - rotate(collider.start.rotation, local)) +
           (collider.end.position - collider.start.position);
  }

  // Planes are collected as far as the particle is likely to go in the substep, given its speed; how far the collider is at all is found
  // out to the full reach, and a particle that goes further than expected is the sweep's.
  LOAM_FN float expected_reach(int particle) const {
    return minimum(reach, 2.0f * substep * length(xyz(velocities[particle])) + near_share * reach);
  }

  // Of a particle in a collider's frame.
  struct Local {
    int collider, particle;
    Vec3<float> at;
    Vec3<float> shift; // where the collider would carry it
  };

  // The half space of a contact point in the collider's frame, which moves there by `drift` in the substep.
  LOAM_FN ContactPlane plane_at(const Local &local, Vec3<float> point, Vec3<float> normal, float distance,
                                Vec3<float> drift = {0.0f, 0.0f, 0.0f}) const {
    const ColliderView &collider = colliders[local.collider];
    const float missing = minimum(stand_off - distance, stand_off);
    const float recovery = minimum(contact_recovery_share, substep / contact_recovery_time);
    ContactPlane plane;
    plane.collider = local.collider;
    plane.normal = rotate(collider.end.rotation, normal);
    plane.gap = (missing > 0.0f ? 0.0f - recovery * missing : 0.0f - missing) - dot(plane.normal, local.shift);
    plane.surface_velocity = (1.0f / substep) * carried(collider, point);
    if constexpr (Deforms) {
      const Vec3<float> moved = rotate(collider.end.rotation, drift);
      plane.gap = plane.gap - dot(plane.normal, moved);
      plane.surface_velocity = plane.surface_velocity + (1.0f / substep) * moved;
    }
    const ContactLaw &law = collider.of_materials == nullptr || materials == nullptr
                                ? collider.law
                                : collider.of_materials[materials[local.particle]];
    const Row &row = velocities[local.particle];
    const ContactParticle matter = {xyz(row), row.w, positions[local.particle].w, substep, rest_speed};
    plane.friction = law.friction;
    // A particle that is faster than it may go does not hit what is out of its reach.
    if (plane.gap < reach) plane.gap = gap_with_bounce(law, matter, plane.normal, plane.gap, plane.surface_velocity);
    plane.hold = greatest_hold(law, matter, distance, stand_off);
    return plane;
  }

  LOAM_FN Local local_of(int index, int particle, Vec3<float> x) const {
    const Vec3<float> at = to_local(colliders[index].start, x);
    return {index, particle, at, carried(colliders[index], at)};
  }

  LOAM_FN void find_solid(int index, int particle, Vec3<float> x, PlaneList &list, float &clearance, float &free) const {
    const ColliderView &collider = colliders[index];
    const Local local = local_of(index, particle, x);
    const float moved = length(local.shift);
    const Surface surface = surface_of(collider.shape, local.at, stand_off + reach + moved);
    const float certain = certain_distance(collider.shape, surface);
    clearance = minimum(clearance, certain - moved);
    free = minimum(free, certain - FreeDistances::rounding(collider, x, local.at));
    // A solid that is not convex may come from elsewhere than its nearest point: the sweep must look at it.
    const bool by_force = !is_convex(collider.shape) && list.count == 0 && certain - moved < reach;
    if (!insert_solid(local, surface, by_force, list)) return;
    if (!is_convex(collider.shape)) find_walls(local, surface, list);
  }

  // False if it is out of reach.
  LOAM_FN bool insert_solid(const Local &local, const Surface &surface, bool even_if_out_of_reach, PlaneList &list) const {
    const Vec3<float> point = local.at - surface.distance * surface.normal;
    const ContactPlane plane = plane_at(local, point, surface.normal, surface.distance);
    if (!(plane.gap < reach) && !even_if_out_of_reach) return false;
    list.insert(plane, local.collider, stand_off - surface.distance);
    return true;
  }

  // The further walls of a solid that is not convex: one stands where a step to the side leads nearer to the surface than the nearest point is.
  LOAM_FN void find_walls(const Local &local, const Surface &nearest, PlaneList &list) const {
    const Shape &shape = colliders[local.collider].shape;
    const Vec3<float> n = nearest.normal;
    const Vec3<float> across =
        absolute(n.x) < 0.7f ? Vec3<float>{0.0f, n.z, 0.0f - n.y} : Vec3<float>{0.0f - n.z, 0.0f, n.x};
    const Vec3<float> u = (1.0f / length(across)) * across, v = cross(n, u);
    for (int k = 0; k < 4; ++k) {
      float step = (k & 1) != 0 ? stand_off : 0.0f - stand_off;
      const Vec3<float> side = k < 2 ? u : v;
      Surface wall = surface_of(shape, local.at + step * side, stand_off);
      if (!(wall.distance < nearest.distance - 0.3f * stand_off)) continue;
      if (wall.distance < 0.0f) { // deep in a wall that may be thin: not so far
        step = 0.5f * step;
        wall = surface_of(shape, local.at + step * side, stand_off);
      }
      if (dot(wall.normal, n) > 0.9f) continue;
      wall.distance = wall.distance - step * dot(wall.normal, side);
      (void)insert_solid(local, wall, false, list);
    }
  }

  LOAM_FN void find_mesh(int index, int particle, Vec3<float> x, PlaneList &list, float &clearance, float &free) const {
    const ColliderView &collider = colliders[index];
    const Local local = local_of(index, particle, x);
    const float moved = length(local.shift) + (Deforms ? collider.shape.mesh.motion : 0.0f);
    const float near = stand_off + expected_reach(particle) + moved, far = stand_off + reach + moved;
    const float near_squared = near * near;

    ClosestPoint<float> nearest = {{0.0f, 0.0f, 0.0f}, far * far, -1};
    int nearest_packet = 0, nearest_lane = 0;
    bool nearest_is_listed = false;
    float radius_squared = far * far; // shrinks to the nearest point so far, but not below `near`
    float out_of_reach_squared = 1e30f;
    const MeshShape &mesh = collider.shape.mesh;
    BallQuery query(mesh.nodes, local.at, free_distances.look_squared());
    for (int i = query.next(radius_squared); i >= 0; i = query.next(radius_squared)) {
      const TrianglePacket &packet = mesh.packets[i];
      const PacketPoints points = closest_points(packet, local.at);
      const int count = static_cast<int>(packet.count);
      for (int k = 0; k < count; ++k) {
        out_of_reach_squared = minimum(out_of_reach_squared, points.distance_squared[k]);
        if (!(points.distance_squared[k] < radius_squared)) continue;
        const ClosestPoint<float> closest = points.at(k);
        const bool listed = closest.distance_squared < near_squared &&
                            is_minimum(mesh, static_cast<int>(packet.first) + k, closest, local.at);
        if (closest.distance_squared < nearest.distance_squared) {
          nearest = closest;
          nearest_packet = i;
          nearest_lane = k;
          nearest_is_listed = listed;
          radius_squared = maximum(near_squared, closest.distance_squared);
          query.open_squared = 0.0f; // how much farther the next surface is does not matter any more
        }
        if (listed) add(local, i, k, closest, false, list);
      }
    }
    free = minimum(free, square_root(minimum(out_of_reach_squared, query.unvisited_squared)) -
                             FreeDistances::rounding(collider, x, local.at));
    if (nearest.feature < 0) return;
    clearance = minimum(clearance, square_root(nearest.distance_squared) - moved);
    // The nearest point is a minimum whatever rounding made of its feature. And there must be a contact for the sweep to look at, if only of a wall that
    // recedes: a fast mesh may come from where it has no minimum.
    if (!nearest_is_listed || list.count == 0) add(local, nearest_packet, nearest_lane, nearest, true, list);
  }

  LOAM_FN static bool is_minimum(const MeshShape &mesh, int triangle, const ClosestPoint<float> &closest,
                                 Vec3<float> local) {
    const BvhFeatures &features = mesh.features[triangle];
    if ((features.owned >> closest.feature & 1u) == 0) return false;
    if (closest.feature == BvhFeatures::inside) return true;
    constexpr float slope_squared = 1e-6f; // a descent of less than 1 in 1000 may be rounding
    for (std::uint32_t k = features.first[closest.feature]; k < features.first[closest.feature + 1]; ++k) {
      const Vec3<float> along = (mesh.ring[k] - local) - closest.point;
      const float descent = 0.0f - dot(along, closest.point);
      if (descent > 0.0f && descent * descent > slope_squared * (closest.distance_squared * dot(along, along))) return false;
    }
    return true;
  }

  LOAM_FN void add(const Local &local, int packet_index, int lane, const ClosestPoint<float> &closest,
                   bool even_if_out_of_reach, PlaneList &list) const {
    const MeshShape &mesh = colliders[local.collider].shape.mesh;
    const TrianglePacket &packet = mesh.packets[packet_index];
    const float distance = square_root(closest.distance_squared);
    Vec3<float> normal;
    if (distance > 0.05f * stand_off) {
      normal = (-1.0f / distance) * closest.point;
    } else { // too near for a direction: the triangle's own, on the particle's side; in front if it lies in the surface
      const Vec3<float> own = lane_of(packet.normal, lane);
      normal = dot(own, local.at - lane_of(packet.a, lane)) < 0.0f ? -1.0f * own : own;
    }
    Vec3<float> drift = {0.0f, 0.0f, 0.0f};
    if (Deforms && mesh.end_packets != nullptr)
      drift = drift_of(packet, mesh.end_packets[packet_index], lane, local.at + closest.point, closest.feature);
    const ContactPlane plane = plane_at(local, local.at + closest.point, normal, distance, drift);
    if (plane.gap < reach || even_if_out_of_reach) list.insert(plane, local.collider, stand_off - distance);
  }

  // How far a point of a triangle's feature moves with its vertices.
  LOAM_FN static Vec3<float> drift_of(const TrianglePacket &start, const TrianglePacket &end, int lane, Vec3<float> point,
                                      int feature) {
    const Vec3<float> v[3] = {lane_of(start.a, lane), lane_of(start.b, lane), lane_of(start.c, lane)};
    const Vec3<float> moved[3] = {lane_of(end.a, lane) - v[0], lane_of(end.b, lane) - v[1], lane_of(end.c, lane) - v[2]};
    if (feature >= 3 && feature < BvhFeatures::inside) return moved[feature - 3];
    if (feature < 3) {
      const int to = feature < 2 ? feature + 1 : 0;
      const Vec3<float> edge = v[to] - v[feature];
      const float share = minimum(1.0f, maximum(0.0f, dot(point - v[feature], edge) / dot(edge, edge)));
      return moved[feature] + share * (moved[to] - moved[feature]);
    }
    const Vec3<float> normal = lane_of(start.normal, lane);
    float weights[3], sum = 0.0f;
    for (int k = 0; k < 3; ++k) {
      const Vec3<float> from = v[(k + 1) % 3];
      weights[k] = maximum(0.0f, dot(normal, cross(v[(k + 2) % 3] - from, point - from)));
      sum += weights[k];
    }
    if (!(sum > 0.0f)) return moved[0];
    return (1.0f / sum) * (weights[0] * moved[0] + (weights[1] * moved[1] + weights[2] * moved[2]));
  }
};

using FindContacts = FindContactsOf<false>;

} // namespace loam
