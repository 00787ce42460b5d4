/* Meshes that deform, for tests: colliders, and where their vertices go. */
#pragma once

#include <functional>

#include "support/meshes.h"
#include "support/scenes.h"

namespace loam::deforming {

/* A collider of a mesh that deforms. */
inline loam_collider_id add(const scenes::World &world, const meshes::Mesh &mesh, float friction = 0.6f,
                            std::uint32_t reaction = 0, std::uint32_t deforms = 1) {
  loam_collider_def def;
  scenes::require(loam_collider_def_default(&def, sizeof def), "default");
  def.kind = LOAM_COLLIDER_MESH;
  def.mesh = mesh.view();
  def.friction = friction;
  def.reaction = reaction;
  def.deforms = deforms;
  loam_collider_id id = 0;
  scenes::require(loam_collider_create(world.get(), &def, &id), "collider");
  return id;
}

/* The mesh with each vertex where `place` puts it: place(float x[3]) in place. */
template <class Place> meshes::Mesh moved(meshes::Mesh mesh, Place &&place) {
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) place(&mesh.positions[i]);
  return mesh;
}

inline void move(const scenes::World &world, loam_collider_id id, const meshes::Mesh &to, bool at_once = false) {
  const auto count = std::uint32_t(to.positions.size() / 3);
  scenes::require(at_once ? loam_collider_place_vertices(world.get(), id, to.positions.data(), count)
                          : loam_collider_move_vertices(world.get(), id, to.positions.data(), count),
                  "vertices");
}

/* Squashed along y by a share of its height and as much wider, and twisted about y by so much a metre. */
inline meshes::Mesh squashed(const meshes::Mesh &mesh, float share, float twist) {
  const float high = 1 - share, wide = 1 / std::sqrt(high);
  return moved(mesh, [&](float *x) {
    const float turn = twist * x[1], c = wide * std::cos(turn), s = wide * std::sin(turn);
    const float from[3] = {x[0], x[1], x[2]};
    x[0] = c * from[0] + s * from[2];
    x[1] = high * from[1];
    x[2] = c * from[2] - s * from[0];
  });
}

} // namespace loam::deforming
