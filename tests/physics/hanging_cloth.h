/* Cloth that hangs, against closed forms. */
#pragma once

#include "support/cloths.h"
#include "support/course.h"

namespace loam::test {

using cloths::Cloth;
using cloths::Grid;

/* Substeps of a frame of 1/60 s. */
struct Accuracy {
  std::uint32_t iterations, substeps;
};

inline void run(scenes::World &world, float seconds, const Course &course = {}) {
  for (int frame = 0; frame < static_cast<int>(60 * seconds); ++frame) course.step(world, 1.0f / 60);
}

inline std::vector<std::uint32_t> column(const Grid &grid, std::uint32_t i) {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t j = 0; j <= grid.rows; ++j) vertices.push_back(grid.at(i, j));
  return vertices;
}
inline std::vector<std::uint32_t> row(const Grid &grid, std::uint32_t j) {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t i = 0; i <= grid.columns; ++i) vertices.push_back(grid.at(i, j));
  return vertices;
}

/* How far the lower edge of a sheet 1 m long hangs below its upper one. */
inline double hanging_length(const Accuracy &accuracy, float stiffness, float greatest_stretch, const Course &course = {}) {
  const Grid grid(16, 16, 1.0f / 16, true);
  loam_world_def world_def = cloths::world_def(accuracy.iterations, accuracy.substeps);
  course.change(world_def);
  scenes::World world(world_def);
  loam_cloth_def def = cloths::definition(grid);
  def.stretch_stiffness = stiffness;
  def.damping = greatest_stretch > 0 ? 1e-3f : 0.05f; // without threads it swings
  def.greatest_stretch = greatest_stretch;
  const Cloth cloth(world.get(), def);
  cloth.attach(row(grid, 0));
  cloth.set_wind(0, 0, 0, 1, 0);
  run(world, 2, course);
  return -double(cloth.vertices().lowest());
}

/* A strip of 1 m between points 0.7 m apart: 2 a sinh(0.35 / a) = 1, sag a (cosh(0.35 / a) - 1) = 0.3196 m. */
inline double sag(const Accuracy &accuracy, const Course &course = {}) {
  const Grid grid(32, 3, 1.0f / 32);
  loam_world_def world_def = cloths::world_def(accuracy.iterations, accuracy.substeps);
  course.change(world_def);
  scenes::World world(world_def);
  const Cloth cloth(world.get(), cloths::definition(grid));
  std::vector<std::uint32_t> held = column(grid, 0);
  std::vector<float> points;
  const std::vector<std::uint32_t> other = column(grid, grid.columns);
  held.insert(held.end(), other.begin(), other.end());
  for (std::size_t i = 0; i < held.size(); ++i) {
    const float z = grid.positions[3 * held[i] + 2];
    points.insert(points.end(), {i < other.size() ? -0.35f : 0.35f, 0.0f, z});
  }
  cloth.attach(held, points);
  cloth.set_wind(0, 0, 0, 4, 0);
  run(world, 4, course);
  return -double(cloth.vertices().lowest());
}

} // namespace loam::test
