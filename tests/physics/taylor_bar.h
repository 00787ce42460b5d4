/* Taylor's bar: a copper rod that strikes a smooth rigid wall at 227 m/s. */
#pragma once

#include "solid.h"

namespace loam::test {

struct TaylorBar {
  int across = 6; // spacings in the radius
  float hardening_modulus = 1e8f, yield_stress = 4e8f, zero_energy_stiffness = 10, minimum_distance = 0.75f;
  std::uint32_t iterations = 5;
  double courant = 2.3; // c h / r

  static constexpr double radius = 3.2e-3, length = 32.4e-3, speed = 227, duration = 80e-6;

  struct Result {
    double foot, length, kinetic; // metres, metres, share of the energy that is left
  };
  Result run() const {
    loam_material_def copper;
    scenes::require(loam_material_def_default(LOAM_LAW_VON_MISES, &copper, sizeof copper), "loam_material_def_default");
    copper.density = 8930;
    copper.youngs_modulus = 117e9f;
    copper.poissons_ratio = 0.35f;
    copper.yield_stress = yield_stress;
    copper.hardening_modulus = hardening_modulus;
    const float spacing = float(radius / across);
    const int high = int(std::lround(length / double(spacing)));
    Points points = {spacing, 0.12f};
    points.flush[1] = true;
    std::vector<float> rod;
    const std::vector<float> box = points.box({-across, 0, -across}, {across, high, across});
    for (std::size_t i = 0; i < box.size(); i += 3)
      if (std::hypot(double(box[i]), double(box[i + 2])) < radius) rod.insert(rod.end(), {box[i], box[i + 1], box[i + 2]});
    Solid bar(copper, rod, spacing);
    bar.scene.planes = {{{0, 0, 0}, {0, 1, 0}, 0}};
    for (std::size_t i = 0; i < bar.scene.count(); ++i)
      bar.scene.velocities.insert(bar.scene.velocities.end(), {0, float(-speed), 0});
    bar.def.iterations = iterations;
    bar.def.zero_energy_stiffness = zero_energy_stiffness;
    bar.def.minimum_distance = minimum_distance;
    const double wave = std::sqrt(117e9 * 0.65 / (1.35 * 0.3) / 8930), step = courant * double(spacing) / wave;
    bar.def.substeps = 10;
    scenes::World world = bar.make();
    const int frames = int(std::lround(duration / (10 * step)));
    for (int frame = 0; frame < frames; ++frame) world.step(float(duration / frames));
    const scenes::Snapshot now = world.snapshot();
    Result result = {};
    double energy = 0, reaches[12] = {}; // the farthest particle of each sector, so that a stray one does not decide
    for (std::size_t i = 0; i < now.count(); ++i) {
      const float *x = &now.positions[3 * i];
      const double angle = std::atan2(double(x[2]), double(x[0])) / pi; // -1 to 1
      double &reach = reaches[std::min<std::size_t>(std::size_t((angle + 1) * 6), 11)];
      reach = std::max(reach, std::hypot(double(x[0]), double(x[2])));
      result.length = std::max(result.length, double(x[1]));
      for (std::size_t k = 0; k < 3; ++k) energy += double(now.velocities[3 * i + k] * now.velocities[3 * i + k]);
    }
    for (const double reach : reaches) result.foot += reach / 12;
    result.foot += double(spacing) / 2; // matter reaches half a spacing beyond the centres
    result.length += double(spacing) / 2;
    result.kinetic = energy / double(now.count()) / (speed * speed);
    return result;
  }
};

} // namespace loam::test
