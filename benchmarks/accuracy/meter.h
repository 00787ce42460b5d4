/* What the frames of an experiment cost. */
#pragma once

#include <algorithm>
#include <cmath>
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
      if (setting_.preset >= 0 && costs_.empty()) use_preset(world);
      const std::clock_t begin = std::clock();
      world.step(seconds);
      costs_.push_back(double(std::clock() - begin) / CLOCKS_PER_SEC / double(seconds));
      const loam_statistics statistics = world.statistics();
      residuals_.push_back(statistics.residual);
      substeps_.push_back(double(seconds) / statistics.substeps);
      iterations_.push_back(statistics.iterations);
      if (statistics.particles > 0) particles_ = std::size_t(statistics.particles);
    };
    return course;
  }

  double seconds_per_second() const { return median(costs_); } // of the processor, for a second of the simulation
  double residual() const { return median(residuals_); }
  double substep() const { return median(substeps_); }                                         // seconds
  std::uint32_t iterations() const { return std::uint32_t(std::lround(median(iterations_))); } // of a substep
  std::size_t particles() const { return particles_; }
  void count_vertices(std::size_t vertices) { particles_ = vertices; } // of cloth, in place of particles

private:
  void use_preset(scenes::World &world) const {
    loam_accuracy_def def;
    scenes::require(loam_accuracy_def_preset(std::uint32_t(setting_.preset), &def, sizeof def), "loam_accuracy_def_preset");
    scenes::require(loam_world_use_accuracy(world.get(), &def), "loam_world_use_accuracy");
  }
  static double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  }

  Setting setting_;
  std::vector<double> costs_, residuals_, substeps_, iterations_;
  std::size_t particles_ = 0;
};

} // namespace loam::accuracy
