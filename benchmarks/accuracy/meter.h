/* What the frames of an experiment cost. */
#pragma once

#include <algorithm>
#include <ctime>
#include <vector>

#include "setting.h"
#include "support/course.h"

namespace loam::accuracy {

/* Times in seconds of the processor, so that what else the machine does counts little; the median of the frames is taken, for the same reason. */
class Meter {
public:
  explicit Meter(const Setting &setting) : setting_(setting) {}

  /* For the experiment; the meter has to outlive it. */
  test::Course course() {
    test::Course course;
    course.change = [this](loam_world_def &def) { setting_.apply(def); };
    course.step = [this](scenes::World &world, float seconds) {
      const std::clock_t begin = std::clock();
      world.step(seconds);
      costs_.push_back(double(std::clock() - begin) / CLOCKS_PER_SEC / double(seconds));
      const loam_statistics statistics = world.statistics();
      residuals_.push_back(statistics.residual);
      if (statistics.particles > 0) particles_ = std::size_t(statistics.particles);
    };
    return course;
  }

  double seconds_per_second() const { return median(costs_); } // of the processor, for a second of the simulation
  double residual() const { return median(residuals_); }
  std::size_t particles() const { return particles_; }
  void count_vertices(std::size_t vertices) { particles_ = vertices; } // of cloth, in place of particles

private:
  static double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  Setting setting_;
  std::vector<double> costs_, residuals_;
  std::size_t particles_ = 0;
};

} // namespace loam::accuracy
