// What the fluids of a world hold beside their particles.
#pragma once

#include <cstdint>

#include "kernels/fluid/measure_fluid.h"
#include "math/vector.h"

namespace loam {

template <class Executor> struct FluidState {
  template <class T> using Array = typename Executor::template Array<T>;
  explicit FluidState(Executor &executor)
      : walls(executor.template array<Row>()), is_fluid(executor.template array<float>()) {}
  bool in_use = false;
  FluidCalibration calibration = {};
  Array<Row> walls;      // of each particle, while there are contacts; see kernels/fluid/walls.h
  Array<float> is_fluid; // of each material
  std::uint64_t bytes() const { return walls.bytes() + is_fluid.bytes(); }
};

} // namespace loam
