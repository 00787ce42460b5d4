// Elastic: the Saint Venant-Kirchhoff energy in Hencky strain, without a yield surface.
#pragma once

#include "kernels/materials/law.h"

namespace loam {

struct Elastic : Isotropic {
  static constexpr double greatest_strain = 2.0;
};

} // namespace loam
