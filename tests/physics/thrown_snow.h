/* A block of snow thrown flat onto the ground: Stomakhin et al. 2013, the first row of parameters. */
#pragma once

#include "granular.h"
#include "support/course.h"

namespace loam::test {

struct Shape {
  double width, height; // within which the middle 94 % of the particles lie, in spacings

  /* The greatest difference, as a share of the extent. */
  double difference(const Shape &other) const {
    return std::max(std::fabs(width - other.width) / other.width, std::fabs(height - other.height) / other.height);
  }
};

struct ThrownSnow {
  Shape shape;
  double changing; // the difference from the shape a hundredth of a second before
};

/* After a hit of 6 m/s, in substeps of `substep`: r / substep is 20 m/s at the longest used here. */
inline ThrownSnow thrown_snow(double substep, std::uint32_t plasticity, const Course &course = {}) {
  loam_material_def snow;
  scenes::require(loam_material_def_default(LOAM_LAW_STOMAKHIN_SNOW, &snow, sizeof snow), "loam_material_def_default");
  snow.density = 400;
  snow.youngs_modulus = 5e5f;
  snow.poissons_ratio = 0.2f;
  snow.hardening_factor = 10;
  snow.critical_compression = 0.025f;
  snow.critical_stretch = 0.0075f;
  const float spacing = 0.02f;
  const scenes::Scene scene = scenes::drop_block(snow, 8, spacing / 2, 6, {.spacing = spacing});
  loam_world_def def = scenes::world_def(scene);
  def.plasticity = plasticity;
  constexpr double frame = 0.005;
  def.substeps = std::uint32_t(std::lround(frame / substep));
  course.change(def);
  scenes::World world(def, scene);
  const auto shape = [&] {
    const std::vector<float> now = world.snapshot().positions;
    const auto extent = [&](std::size_t axis) {
      return (quantile(now, axis, 0.97) - quantile(now, axis, 0.03)) / double(spacing);
    };
    return Shape{extent(0), extent(1)};
  };
  const auto run = [&](double seconds) {
    for (int k = 0; k < int(std::lround(seconds / frame)); ++k) course.step(world, float(frame));
  };
  run(0.02);
  const Shape early = shape();
  run(0.01);
  if (world.statistics().non_finite > 0) throw std::runtime_error("particles are not finite");
  return {shape(), shape().difference(early)};
}

} // namespace loam::test
