/* Cloth for tests: meshes, and a world with one cloth in it. */
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <loam/loam.h>

#include "support/scenes.h"

namespace loam::cloths {

/* A grid of `columns` by `rows` squares of `spacing`, its middle at the origin, in the plane y = 0 (columns along x, rows along z) or, hanging, with the top row at y = 0 in
 * the plane z = 0. Diagonals alternate or are parallel. */
struct Grid {
  std::vector<float> positions;
  std::vector<std::uint32_t> indices;
  std::uint32_t columns, rows;

  Grid(std::uint32_t columns, std::uint32_t rows, float spacing, bool hanging = false, bool parallel = false)
      : columns(columns), rows(rows) {
    for (std::uint32_t j = 0; j <= rows; ++j)
      for (std::uint32_t i = 0; i <= columns; ++i) {
        const float x = (static_cast<float>(i) - 0.5f * static_cast<float>(columns)) * spacing;
        const float across = static_cast<float>(j) * spacing, middle = 0.5f * static_cast<float>(rows) * spacing;
        positions.insert(positions.end(), {x, hanging ? -across : 0.0f, hanging ? 0.0f : across - middle});
      }
    for (std::uint32_t j = 0; j < rows; ++j)
      for (std::uint32_t i = 0; i < columns; ++i) {
        const std::uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
        if (!parallel && (i + j) % 2 != 0)
          indices.insert(indices.end(), {a, d, b, b, d, c});
        else
          indices.insert(indices.end(), {a, c, b, a, d, c});
      }
  }
  std::uint32_t at(std::uint32_t column, std::uint32_t row) const { return row * (columns + 1) + column; }
  loam_mesh view() const {
    return {positions.data(), indices.data(), static_cast<std::uint32_t>(positions.size() / 3),
            static_cast<std::uint32_t>(indices.size() / 3)};
  }
};

inline loam_cloth_def definition(const Grid &grid) {
  loam_cloth_def def;
  scenes::require(loam_cloth_def_default(&def, sizeof def), "loam_cloth_def_default");
  def.mesh = grid.view();
  return def;
}

/* A world of the CPU and one thread. */
inline loam_world_def world_def(std::uint32_t iterations, std::uint32_t substeps) {
  loam_world_def def;
  scenes::require(loam_world_def_default(&def, sizeof def), "loam_world_def_default");
  def.backend = LOAM_BACKEND_CPU;
  def.thread_count = 1;
  def.iterations = iterations;
  def.substeps = substeps;
  def.particle_capacity = 1;
  return def;
}

struct Cloth {
  loam_world *world;
  loam_cloth_id id = 0;

  Cloth(loam_world *world, const loam_cloth_def &def) : world(world) {
    scenes::require(loam_cloth_create(world, &def, &id), "loam_cloth_create");
  }
  void attach(const std::vector<std::uint32_t> &vertices, const std::vector<float> &points = {}, float compliance = 0,
              loam_collider_id collider = 0) const {
    loam_cloth_attachment_def def;
    scenes::require(loam_cloth_attachment_def_default(&def, sizeof def), "loam_cloth_attachment_def_default");
    def.count = static_cast<std::uint32_t>(vertices.size());
    def.vertices = vertices.data();
    def.points = points.empty() ? nullptr : points.data();
    def.compliance = compliance;
    def.collider = collider;
    scenes::require(loam_cloth_attach(world, id, &def), "loam_cloth_attach");
  }
  void set_wind(float x, float y, float z, float drag, float lift) const {
    const float velocity[3] = {x, y, z};
    scenes::require(loam_cloth_set_wind(world, id, velocity, drag, lift), "loam_cloth_set_wind");
  }

  struct Vertices {
    std::vector<float> positions, velocities, inverse_masses, normals;
    std::size_t count() const { return inverse_masses.size(); }
    float lowest() const {
      float y = 1e30f;
      for (std::size_t i = 0; i < count(); ++i) y = std::fmin(y, positions[3 * i + 1]);
      return y;
    }
    float fastest() const {
      float squared = 0;
      for (std::size_t i = 0; i < count(); ++i) {
        const float *v = &velocities[3 * i];
        squared = std::fmax(squared, v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      }
      return std::sqrt(squared);
    }
    bool finite() const {
      for (std::size_t i = 0; i < positions.size(); ++i)
        if (!std::isfinite(positions[i]) || !std::isfinite(velocities[i])) return false;
      return true;
    }
  };
  Vertices vertices() const {
    loam_cloth_view view = {};
    view.struct_size = sizeof view;
    scenes::require(loam_cloth_map(world, id, &view), "loam_cloth_map");
    Vertices result;
    for (std::uint32_t i = 0; i < view.vertex_count; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        result.positions.push_back(view.positions[4 * i + k]);
        result.velocities.push_back(view.velocities[4 * i + k]);
        result.normals.push_back(view.normals[4 * i + k]);
      }
      result.inverse_masses.push_back(view.velocities[4 * i + 3]);
    }
    scenes::require(loam_cloth_unmap(world, id), "loam_cloth_unmap");
    return result;
  }
};

} // namespace loam::cloths
