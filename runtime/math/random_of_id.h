// Random numbers of particles: from their ids, so that it does not matter where a particle is or who asks.
#pragma once

#include <cstdint>

#include "math/qualifiers.h"

namespace loam {

// In [-1, 1). The mixer is SplitMix64's.
LOAM_FN float random_of_id(std::uint32_t seed, std::uint32_t id, std::uint32_t axis) {
  std::uint64_t z = (static_cast<std::uint64_t>(seed) << 34) + (static_cast<std::uint64_t>(id) << 2) + axis;
  z += 0x9E3779B97F4A7C15ull;
  z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ z >> 27) * 0x94D049BB133111EBull;
  z ^= z >> 31;
  return static_cast<float>(static_cast<std::int32_t>(z >> 40) - (1 << 23)) * (1.0f / (1 << 23));
}

} // namespace loam
