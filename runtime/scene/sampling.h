// Where particles are put in a region.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/region.h"

namespace loam {

// All samplers give the same points for the same seed, on every machine. They throw Error CAPACITY before taking much memory if the
// region needs clearly more than `max_count` points.

// Poisson-disk samples: no two closer than the spacing d, and no room for many more; about 0.57 points per d^3.
std::vector<Vec3<float>> sample_poisson_disk(const RegionSampler &region, float spacing, std::uint32_t seed,
                                             std::uint64_t max_count);

// A cubic lattice along the region's axes, centred in its bounds. Each point is moved at random by up to jitter x spacing along each axis, unless
// that takes it out of the region.
std::vector<Vec3<float>> sample_lattice(const RegionSampler &region, float spacing, float jitter, std::uint32_t seed,
                                        std::uint64_t max_count);

struct FillResult {
  std::vector<Vec3<float>> positions;
  double volume_per_particle = 0; // m^3; the region's volume over the count
};

// Checks everything in the definition that needs no world (sampling, region, cut, spacing, jitter, inset, velocity, reserved) and makes
// the points. `max_count` is how many more particles the world can hold. Throws Error INVALID_ARGUMENT, INVALID_MESH, CAPACITY or
// OUT_OF_MEMORY.
FillResult fill(const loam_fill_def &def, float kernel_radius, std::uint64_t max_count);

} // namespace loam
