/* Random numbers for random scenes: the same on every machine, a stream of their own for every pair of seed and index. */
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace loam::fuzz {

class Random {
public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) : state_(seed) {
    state_ = next() ^ (stream * 0xD1B54A32D192ED03u);
    (void)next();
  }
  std::uint64_t next() { // SplitMix64
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15u;
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9u;
    z = (z ^ z >> 27) * 0x94D049BB133111EBu;
    return z ^ z >> 31;
  }
  double uniform() { return double(next() >> 11) * 0x1p-53; } // in [0, 1)
  float between(double low, double high) { return float(low + (high - low) * uniform()); }
  /* Every decade as likely as another. */
  float log_between(double low, double high) { return float(low * std::exp(std::log(high / low) * uniform())); }
  bool chance(double share) { return uniform() < share; }
  std::uint32_t below(std::size_t count) { return std::uint32_t(next() % count); }
  std::uint32_t from(std::uint32_t low, std::uint32_t high) { return low + below(std::size_t(high) - low + 1); }
  template <class List> auto pick(const List &list) { return list[below(std::size(list))]; }

private:
  std::uint64_t state_;
};

} // namespace loam::fuzz
