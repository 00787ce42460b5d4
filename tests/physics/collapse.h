/* Runs a granular column or slab until it rests. */
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/course.h"

namespace loam::test {

struct Collapse {
  scenes::Scene scene;
  loam_world_def def;
  double substep = 5e-4, seconds = 0.6;

  explicit Collapse(scenes::Scene of) : scene(std::move(of)), def(scenes::world_def(scene)) {
    def.gravity[1] = -9.8f;
    def.iterations = 5;
    def.thread_count = 2;
  }
  struct Result {
    double run_out, virial, mean_speed, nearest, lowest;
  };
  Result run(const Course &course = {}) {
    const double step = std::max(0.02, substep);
    def.substeps = std::uint32_t(std::lround(step / substep));
    course.change(def);
    scenes::World world(def, scene);
    for (int k = 0; k < int(std::lround(seconds / step)); ++k) course.step(world, float(step));
    const scenes::Snapshot now = world.snapshot();
    const loam_statistics statistics = world.statistics();
    if (statistics.non_finite > 0) throw std::runtime_error("particles are not finite");
    double lowest = 1;
    for (std::size_t i = 1; i < now.positions.size(); i += 3) lowest = std::min(lowest, double(now.positions[i]));
    return {scenes::run_out(now.positions, scene), statistics.virial, statistics.mean_speed, nearest(now.positions), lowest};
  }

  /* The least distance between two particles, in spacings. */
  double nearest(const std::vector<float> &positions) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < positions.size(); i += 3) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return positions[a] < positions[b]; });
    double least = 1;
    for (std::size_t a = 0; a < order.size(); ++a)
      for (std::size_t b = a + 1; b < order.size(); ++b) {
        const float *x = &positions[order[a]], *y = &positions[order[b]];
        const double dx = double(y[0] - x[0]) / double(scene.spacing);
        if (dx >= least) break;
        least = std::min(
            least, std::hypot(dx, double(y[1] - x[1]) / double(scene.spacing), double(y[2] - x[2]) / double(scene.spacing)));
      }
    return least;
  }
};

} // namespace loam::test
