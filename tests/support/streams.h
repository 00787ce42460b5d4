/* Worlds with streams in them. */
#pragma once

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "support/scenes.h"

namespace loam::streams {

/* A disc at a height of 1 m that matter falls from. */
inline loam_emitter_def disc(loam_material_id material, float radius) {
  loam_emitter_def def;
  EXPECT_EQ(loam_emitter_def_default(&def, sizeof def), LOAM_OK);
  def.material = material;
  def.radius = radius;
  def.position[1] = 1;
  return def;
}

/* Instruction sets that the machine and the library have. */
inline std::vector<std::uint32_t> instruction_sets() {
  std::vector<std::uint32_t> sets;
  for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set) {
    loam_world_def def;
    scenes::require(loam_world_def_default(&def, sizeof def), "default");
    def.backend = LOAM_BACKEND_CPU;
    def.instruction_set = set;
    loam_world *world = nullptr;
    if (loam_world_create(&def, &world) == LOAM_OK) sets.push_back(set);
    (void)loam_world_destroy(world);
  }
  return sets;
}

/* A world of sand without anything in it. */
struct EmptyWorld {
  explicit EmptyWorld(std::uint64_t capacity, std::uint32_t threads = 1, std::uint32_t solver = LOAM_SOLVER_GAUSS_SEIDEL,
                      std::uint32_t instruction_set = LOAM_INSTRUCTION_SET_AUTO)
      : world([&] {
          loam_world_def def;
          scenes::require(loam_world_def_default(&def, sizeof def), "default");
          def.backend = LOAM_BACKEND_CPU;
          def.kernel_radius = 0.01f;
          def.substeps = 4;
          def.iterations = 3;
          def.thread_count = threads;
          def.instruction_set = instruction_set;
          def.solver = solver;
          def.particle_capacity = capacity;
          return def;
        }()) {
    const loam_material_def sand = scenes::sand();
    scenes::require(loam_material_create(world.get(), &sand, &material), "material");
  }
  loam_emitter_id add(const loam_emitter_def &def) {
    loam_emitter_id id = 0;
    EXPECT_EQ(loam_emitter_create(world.get(), &def, &id), LOAM_OK) << loam_last_error();
    return id;
  }
  loam_emitter_report report(loam_emitter_id id) const {
    loam_emitter_report report = {};
    report.struct_size = sizeof report;
    EXPECT_EQ(loam_emitter_get_report(world.get(), id, &report), LOAM_OK);
    return report;
  }
  template <class F> void look(F &&f) const {
    loam_particle_view view = {};
    view.struct_size = sizeof view;
    ASSERT_EQ(loam_particles_map(world.get(), &view), LOAM_OK);
    f(view);
    ASSERT_EQ(loam_particles_unmap(world.get()), LOAM_OK);
  }
  double least_distance() const {
    double least = 1e9;
    look([&](const loam_particle_view &view) {
      for (std::uint64_t i = 0; i < view.count; ++i)
        for (std::uint64_t j = 0; j < i; ++j) {
          double squared = 0;
          for (int k = 0; k < 3; ++k) {
            const double d = double(view.positions[4 * i + k]) - double(view.positions[4 * j + k]);
            squared += d * d;
          }
          least = std::min(least, std::sqrt(squared));
        }
    });
    return least;
  }
  scenes::World world;
  loam_material_id material = 0;
};

} // namespace loam::streams
