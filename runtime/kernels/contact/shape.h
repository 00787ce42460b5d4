// The kinds of colliders. A new solid kind is a header with a struct that answers surface(), a member and a case here, and a description for the host
// to give (scene/collider_shape.h).
//
// Solids that are convex have a property that contact rests on: the half space beyond the nearest point, facing the particle, keeps clear of
// all of the solid. A distance grid need not be convex, and a triangle mesh has no inside; find_contacts.h and sweep_contacts.h treat them apart.
#pragma once

#include <loam/collider.h>

#include "kernels/contact/box.h"
#include "kernels/contact/capsule.h"
#include "kernels/contact/convex_hull.h"
#include "kernels/contact/distance_grid.h"
#include "kernels/contact/plane.h"
#include "kernels/contact/sphere.h"
#include "kernels/contact/triangle_mesh.h"

namespace loam {

struct Shape {
  std::uint32_t kind; // LOAM_COLLIDER_*
  union {
    PlaneShape plane;
    SphereShape sphere;
    CapsuleShape capsule;
    BoxShape box;
    HullShape hull;
    GridShape grid;
    MeshShape mesh;
  };
};

LOAM_FN bool is_mesh(const Shape &shape) { return shape.kind == LOAM_COLLIDER_MESH; }
LOAM_FN bool is_convex(const Shape &shape) { return shape.kind != LOAM_COLLIDER_MESH && shape.kind != LOAM_COLLIDER_GRID; }

// Of a solid: not for meshes. Beyond `limit` the distance may be a lower bound.
LOAM_FN Surface surface_of(const Shape &shape, Vec3<float> point, float limit) {
  switch (shape.kind) {
  case LOAM_COLLIDER_SPHERE:
    return shape.sphere.surface(point);
  case LOAM_COLLIDER_CAPSULE:
    return shape.capsule.surface(point);
  case LOAM_COLLIDER_BOX:
    return shape.box.surface(point);
  case LOAM_COLLIDER_HULL:
    return shape.hull.surface(point, limit);
  case LOAM_COLLIDER_GRID:
    return shape.grid.surface(point);
  default:
    return shape.plane.surface(point);
  }
}

// What of a distance is free for certain: all of it, but in a grid whose values change faster than distances do.
LOAM_FN float certain_distance(const Shape &shape, const Surface &surface) {
  const bool shorter = shape.kind == LOAM_COLLIDER_GRID && surface.distance > 0.0f;
  return shorter ? shape.grid.certainty * surface.distance : surface.distance;
}

} // namespace loam
