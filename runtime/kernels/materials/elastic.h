// Elastic: the Saint Venant-Kirchhoff energy in Hencky strain, without a yield surface.
#pragma once

#include "kernels/materials/law.h"

namespace loam {

struct Elastic {
  static constexpr bool plastic = false;
  static constexpr bool has_history = false;
  static constexpr double greatest_strain = 2.0;
  LameParameters lame;

  template <class T> LOAM_FN Mapped<T> map(T trace, T, T history) const { return {trace, T(1.0f), history}; }
};

} // namespace loam
