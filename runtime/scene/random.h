// Random numbers for sampling.
#pragma once

#include <cstdint>

namespace loam {

// SplitMix64 (Steele, Lea, Flood 2014): a small generator whose bits do not depend on a library.
struct Random {
  std::uint64_t state;

  std::uint64_t next() {
    std::uint64_t z = state += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
  }
  double uniform() { return double(next() >> 11) * 0x1p-53; } // in [0, 1)
  double between(double low, double high) { return low + (high - low) * uniform(); }
};

} // namespace loam
