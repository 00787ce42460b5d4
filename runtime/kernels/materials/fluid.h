// A fluid as a material: what the stages of kernels/fluid know of it. It has no strain; its particles' memory is their pressure.
#pragma once

#include "kernels/materials/law.h"

namespace loam {

struct Fluid : Isotropic {
  float density = 1000;                                         // kg/m^3
  float kinematic_viscosity = 0, kinematic_surface_tension = 0; // over the density: m^2/s, m^3/s^2; 0: none
  float adhesion = 0;                                           // Pa
  float vorticity_confinement = 0;                              // a share of what pressure takes
  static constexpr bool is_fluid = true;
  static constexpr bool has_history = true; // the pressure in Pa, from which the next substep starts
  static constexpr bool resists_zero_energy_modes = false;
  static constexpr double greatest_strain = 1.0;
};

template <class Law> constexpr bool is_fluid() {
  if constexpr (requires { Law::is_fluid; })
    return Law::is_fluid;
  else
    return false;
}

} // namespace loam
