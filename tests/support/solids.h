/* A solid collider of each kind, as a host gives it, with its inside in double precision. */
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <loam/loam.h>

#include "meshes.h"

namespace loam::solids {

using Point = std::array<double, 3>;

struct Solid {
  std::string name;
  loam_collider_def def{}; /* what it points to are the arrays below */
  meshes::Mesh mesh;
  std::vector<float> values;
  std::function<double(const Point &)>
      distance; /* signed, in its own frame; for a hull and a mesh 1 outside and -1 inside */

  loam_collider_def definition() const {
    loam_collider_def result = def;
    if (!mesh.indices.empty()) result.mesh = mesh.view();
    if (!values.empty()) result.grid.values = values.data();
    return result;
  }
};

inline Solid begin(const char *name, std::uint32_t kind) {
  Solid solid;
  solid.name = name;
  loam_collider_def_default(&solid.def, sizeof solid.def);
  solid.def.kind = kind;
  return solid;
}

inline Solid plane() {
  Solid solid = begin("plane", LOAM_COLLIDER_PLANE);
  solid.distance = [](const Point &p) { return p[1]; };
  return solid;
}
inline Solid sphere(float radius) {
  Solid solid = begin("sphere", LOAM_COLLIDER_SPHERE);
  solid.def.radius = radius;
  solid.distance = [=](const Point &p) { return std::hypot(p[0], p[1], p[2]) - double(radius); };
  return solid;
}
inline Solid capsule(float radius, float half_height) {
  Solid solid = begin("capsule", LOAM_COLLIDER_CAPSULE);
  solid.def.radius = radius;
  solid.def.half_height = half_height;
  solid.distance = [=](const Point &p) {
    const double along = std::clamp(p[1], -double(half_height), double(half_height));
    return std::hypot(p[0], p[1] - along, p[2]) - double(radius);
  };
  return solid;
}
inline Solid box(float x, float y, float z) {
  Solid solid = begin("box", LOAM_COLLIDER_BOX);
  const float half[3] = {x, y, z};
  std::copy(half, half + 3, solid.def.half_extents);
  solid.distance = [=](const Point &p) {
    return std::max({std::abs(p[0]) - double(x), std::abs(p[1]) - double(y), std::abs(p[2]) - double(z)});
  };
  return solid;
}
inline Solid of_mesh(const char *name, std::uint32_t kind, const meshes::Mesh &mesh) {
  Solid solid = begin(name, kind);
  solid.mesh = mesh;
  solid.distance = [mesh](const Point &p) { return meshes::winding_number(mesh, p.data()) > 0.5 ? -1.0 : 1.0; };
  return solid;
}
inline Solid hull(float x, float y, float z) { /* an ellipsoid of 80 triangles */
  meshes::Mesh mesh = meshes::icosphere(1, 1);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    mesh.positions[i] *= x;
    mesh.positions[i + 1] *= y;
    mesh.positions[i + 2] *= z;
  }
  return of_mesh("hull", LOAM_COLLIDER_HULL, mesh);
}

/* Of exact distances within a cube. */
inline Solid grid(const char *name, double half, int points, const std::function<double(const Point &)> &distance) {
  Solid solid = begin(name, LOAM_COLLIDER_GRID);
  const double spacing = 2 * half / (points - 1);
  for (int z = 0; z < points; ++z)
    for (int y = 0; y < points; ++y)
      for (int x = 0; x < points; ++x)
        solid.values.push_back(float(distance({x * spacing - half, y * spacing - half, z * spacing - half})));
  for (int axis = 0; axis < 3; ++axis) {
    solid.def.grid.origin[axis] = float(-half);
    solid.def.grid.size[axis] = std::uint32_t(points);
  }
  solid.def.grid.spacing = float(spacing);
  solid.distance = distance;
  return solid;
}
inline double torus_distance(const Point &p, double ring, double tube) {
  return std::hypot(std::hypot(p[0], p[2]) - ring, p[1]) - tube;
}

/* One of each kind, about 6 cm across. */
inline std::vector<Solid> of_every_kind() {
  std::vector<Solid> all;
  all.push_back(plane());
  all.push_back(sphere(0.03f));
  all.push_back(capsule(0.02f, 0.025f));
  all.push_back(box(0.035f, 0.02f, 0.03f));
  all.push_back(hull(0.04f, 0.02f, 0.03f));
  all.push_back(grid("grid", 0.045, 46, [](const Point &p) { return torus_distance(p, 0.025, 0.014); }));
  all.push_back(of_mesh("mesh", LOAM_COLLIDER_MESH, meshes::box(0.035f, 0.02f, 0.03f)));
  return all;
}

/* A point of the world in the frame of a collider that stands at `position`, turned by the unit quaternion `rotation`. */
inline Point to_local(const float *point, const float position[3], const float rotation[4]) {
  double v[3], t[3], norm = 0;
  for (int k = 0; k < 4; ++k) norm += double(rotation[k]) * double(rotation[k]);
  norm = std::sqrt(norm);
  const double q[4] = {-rotation[0] / norm, -rotation[1] / norm, -rotation[2] / norm, rotation[3] / norm};
  for (int k = 0; k < 3; ++k) v[k] = double(point[k]) - double(position[k]);
  for (int k = 0; k < 3; ++k) t[k] = 2 * (q[(k + 1) % 3] * v[(k + 2) % 3] - q[(k + 2) % 3] * v[(k + 1) % 3]);
  Point local;
  for (std::size_t k = 0; k < 3; ++k)
    local[k] = v[k] + q[3] * t[k] + q[(k + 1) % 3] * t[(k + 2) % 3] - q[(k + 2) % 3] * t[(k + 1) % 3];
  return local;
}

} // namespace loam::solids
