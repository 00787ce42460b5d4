// What a host sees of a fluid, and the calibration of its rest density.
#pragma once

#include "kernels/fluid/viscosity.h"
#include "kernels/neighbours/smoothing_kernel.h"
#include "math/vector.h"

namespace loam {

// Over densities that were made of volumes alone: a fluid's volume changes by its strain.
struct FluidDensities {
  const float *is_fluid; // of each material: 1 or 0
  const std::uint32_t *materials;
  const float *strains;
  float *densities;
  LOAM_FN void operator()(int i) const {
    if (is_fluid[materials[i]] > 0.0f) densities[i] = densities[i] / (1.0f + strains[6 * static_cast<long>(i)]);
  }
};

// Sums of the kernel over a cubic lattice of the constant r, whose volume a particle has however it was sampled.
struct FluidCalibration {
  float per_calibration;        // 1 / k
  float full_response;          // r^6 / k^2 times the sum of |grad W|^2
  float slope;                  // what the sum makes of a gradient of 1
  float wall_value, wall_slope; // a half space of the lattice r/2 away, over the kernel's integrals there
  float curl;                   // 1 / what the sum makes of a gradient of 1, with true volumes
  float viscous_scale;          // 10, calibrated, see viscosity.h
  float viscous_rate;           // of one component of D, at a kinematic viscosity and substep of 1 and r = 1

  static FluidCalibration of(const SmoothingKernel &kernel, float r) {
    float sum = 0, squares = 0, slopes = 0, half = 0, half_slopes = 0, shear = 0, along = 0;
    for (int x = -2; x <= 2; ++x)
      for (int y = -2; y <= 2; ++y)
        for (int z = -2; z <= 2; ++z) {
          const float distance = r * square_root(static_cast<float>(x * x + y * y + z * z));
          const float slope = kernel.gradient_factor(distance) * distance;
          const float viscous = kernel.gradient_factor(distance) / (distance * distance + viscous_softening * r * r);
          sum += kernel.value(distance);
          shear += viscous * distance * distance * distance * distance / 15; // x^2 y^2, of all directions
          along += viscous * static_cast<float>(x * x) * r * r;
          squares += slope * slope;
          slopes += kernel.gradient_factor(distance) * static_cast<float>(x * x) * r * r;
          if (x > 0) {
            half += kernel.value(distance);
            half_slopes += kernel.gradient_factor(distance) * static_cast<float>(x) * r;
          }
        }
    const float volume = r * r * r, per_calibration = 1.0f / (volume * sum);
    const float scale = volume * per_calibration;
    // walls.h at t = 3/4
    constexpr float t = 0.75f, t5 = t * t * t * t * t, value = t5 * t * (3.5f + t * (1.5f * t - 4.5f));
    const float plane = 10.5f / r * t5 * (1.0f + t * ((4.0f / 7.0f) * t - 1.5f));
    // Disordered pairs give way to each other: seen in waves of shear through fills, they are so much less stiff than the lattice on average.
    constexpr float disorder = 0.76f;
    const float viscous_scale = 2 / (disorder * volume * shear);
    return {per_calibration,
            scale * scale * squares,
            scale * slopes,
            scale * half / value,
            scale * half_slopes / plane,
            1 / (volume * slopes),
            viscous_scale,
            viscous_scale * volume * along * r * r};
  }
};

} // namespace loam
