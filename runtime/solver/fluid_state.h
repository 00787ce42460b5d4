// What the fluids of a world hold beside their particles.
#pragma once

#include <cstdint>

#include "kernels/fluid/measure_fluid.h"
#include "math/vector.h"

namespace loam {

template <class Executor> struct FluidState {
  template <class T> using Array = typename Executor::template Array<T>;
  explicit FluidState(Executor &executor)
      : walls(executor.template array<Row>()), is_fluid(executor.template array<float>()),
        surface(executor.template array<Row>()), vortex_marks(executor.template array<Row>()),
        vorticity(executor.template array<Row>()),
        viscosities(executor.template array<float>()), marks{executor.template array<Row>(),
                                                             executor.template array<Row>()} {}
  bool in_use = false;
  float viscosity = 0, surface_tension = 0, vorticity_confinement = 0; // the greatest, kinematic ones; 0: no stages of it
  FluidCalibration calibration = {};
  Array<Row> walls;                   // of each particle, while there are contacts; see kernels/fluid/walls.h
  Array<float> is_fluid;              // of each material
  Array<Row> surface;                 // of each particle: see kernels/fluid/surface_tension.h
  Array<Row> vortex_marks, vorticity; // of each particle: see kernels/fluid/vorticity_confinement.h
  Array<float> viscosities;           // of each material, and of each particle: see kernels/fluid/viscosity.h
  Array<Row> marks[2];
  std::uint64_t bytes() const {
    return walls.bytes() + is_fluid.bytes() + surface.bytes() + viscosities.bytes() + marks[0].bytes() + marks[1].bytes() +
           vortex_marks.bytes() + vorticity.bytes();
  }
};

} // namespace loam
