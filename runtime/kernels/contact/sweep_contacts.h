// Last in a substep, after everything that changes velocities: no particle crosses a surface.
//
// The planes are linear and four at most; what gets past them is stopped here. In the frame of the moving collider the particle
// goes straight from its place at the start to its place at the end. Off a convex solid it is kept by the half space beyond the point that was nearest at
// the start. Along any other surface it advances along that line by conservative advancement
// (Mirtich 1996): from a point at distance D of the mesh it can go D without touching anything. There is no crossing test, hence no edge
// to leak through and no grazing case; the answer is conservative to rounding.
//
// A mesh whose vertices move is passed triangle by triangle: see sweep_moving_mesh.h.
//
// A particle keeps a small margin from every surface, or the distance that it has if that is less; so it is always on a definite side,
// and pressing it against a wall for ever does not bring it nearer.
#pragma once

#include "kernels/contact/collider_view.h"
#include "kernels/contact/mesh_query.h"
#include "kernels/contact/reaction.h"
#include "kernels/contact/sweep_moving_mesh.h"

namespace loam {

// `Deforms`: there is a mesh whose vertices move.
template <bool Deforms> struct SweepContactsOf {
  const Contact *contacts;
  const Row *positions; // at the start of the substep
  Row *velocities;
  const ColliderView *colliders;
  int collider_count;
  float substep;
  float margin; // a small share of the stand-off
  Reactions reactions = {};

  LOAM_FN void operator()(int index) const {
    const Contact &contact = contacts[index];
    const Vec3<float> x = xyz(positions[contact.particle]);
    Row &row = velocities[contact.particle];
    Vec3<float> motion = substep * xyz(row);
    if (!is_finite(motion))
      motion = {0.0f, 0.0f, 0.0f};
    else if (length(motion) + margin <= contact.clearance)
      return;

    // Shortening a motion for one moving collider may lead into another: try again a few times. Colliders at rest come last: between a
    // piston and a wall, matter stays on its side of the wall.
    bool cut = false, changed = true;
    for (int round = 0; round < 4 && changed; ++round) {
      changed = false;
      for (int pass = 0; pass < 2; ++pass) {
        for (int i = 0; i < collider_count; ++i) {
          const ColliderView &collider = colliders[i];
          if ((at_rest(collider) && !deforms(collider)) != (pass == 1)) continue;
          const Vec3<float> before = motion;
          const bool shortened = is_convex(collider.shape) ? keep_beyond(collider, x, motion)
                                 : deforms(collider)       ? keep_side_of(collider, x, motion)
                                                           : keep_off(collider, x, motion);
          if (shortened) reactions.add(i, contact.particle, row.w, (1.0f / substep) * (motion - before), false);
          changed = changed || shortened;
        }
      }
      cut = cut || changed;
    }
    if (!cut && is_finite(xyz(row))) return;
    row.x = motion.x / substep;
    row.y = motion.y / substep;
    row.z = motion.z / substep;
  }

private:
  LOAM_FN static bool deforms(const ColliderView &collider) {
    return Deforms && is_mesh(collider.shape) && collider.shape.mesh.end_packets != nullptr;
  }

  // Solid: a particle inside may come out but not go deeper.
  LOAM_FN bool keep_beyond(const ColliderView &collider, Vec3<float> x, Vec3<float> &motion) const {
    const Vec3<float> start = to_local(collider.start, x), end = to_local(collider.end, x + motion);
    const float reach = margin + length(end - start);
    const Surface surface = surface_of(collider.shape, start, reach);
    if (surface.distance > reach) return false;
    const float missing = minimum(margin, surface.distance) - (surface.distance + dot(surface.normal, end - start));
    if (!(missing > 1e-3f * margin)) return false;
    motion = motion + missing * rotate(collider.end.rotation, surface.normal);
    return true;
  }

  LOAM_FN bool keep_off(const ColliderView &collider, Vec3<float> x, Vec3<float> &motion) const {
    const Vec3<float> start = to_local(collider.start, x);
    const Vec3<float> way = to_local(collider.end, x + motion) - start;
    const float way_length = length(way);
    if (!(way_length > 0.0f)) return false;
    const float share = free_share(collider.shape, start, way, way_length);
    if (share >= 1.0f) return false;
    motion = at_rest(collider) ? share * motion : to_world(collider.end, start + share * way) - x;
    return true;
  }

  LOAM_FN bool keep_side_of(const ColliderView &collider, Vec3<float> x, Vec3<float> &motion) const {
    const Vec3<float> start = to_local(collider.start, x), wanted = to_local(collider.end, x + motion) - start;
    Vec3<float> way = wanted;
    if (!SweepMovingMesh{collider.shape.mesh, start, {margin}}(way)) return false;
    motion = motion + rotate(collider.end.rotation, way - wanted);
    return true;
  }

  LOAM_FN static float free_distance(const Shape &shape, Vec3<float> point, float limit) {
    if (is_mesh(shape)) return distance_to_mesh(shape.mesh.nodes, shape.mesh.packets, point, limit);
    return minimum(limit, certain_distance(shape, surface_of(shape, point, limit)));
  }

  // How much of the way can be gone: on it the particle keeps half of `keep`, at its end all of it.
  LOAM_FN float free_share(const Shape &shape, Vec3<float> start, Vec3<float> way, float way_length) const {
    constexpr int max_advances = 32;
    const float horizon = way_length + margin;
    float distance = free_distance(shape, start, horizon);
    if (distance >= horizon) return 1.0f;
    if (!is_mesh(shape) && distance <= 0.0f) // solid: out, but not deeper
      return free_distance(shape, start + way, horizon) >= distance - 1e-3f * margin ? 1.0f : 0.0f;
    const float keep = minimum(margin, distance);
    // Half a margin is given to a particle in the surface itself, which has no side yet, to get out on the one it is pushed to.
    float advance = distance > 1e-3f * margin ? distance - 0.5f * keep : 0.5f * margin;
    float share = 0.0f, good = 0.0f;
    for (int i = 0; i < max_advances && advance > 1e-3f * keep; ++i) {
      share = minimum(1.0f, share + advance / way_length);
      distance = free_distance(shape, start + share * way, horizon);
      if (distance >= keep) good = share;
      if (share >= 1.0f) break;
      advance = distance - 0.5f * keep;
    }
    return good;
  }
};

using SweepContacts = SweepContactsOf<false>;

} // namespace loam
