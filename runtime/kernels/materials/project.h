// The return mapping as the kernels use it: a trial strain in, the projected strain out, whatever the law's form.
#pragma once

#include "kernels/materials/law.h"
#include "math/tensor_functions.h"

namespace loam {

template <class T> struct Projection {
  HenckyStrain<T> strain;
  T scale;   // of the deviator's norm
  T history; // at the end of the substep
};

// `trial.trace` is the law's elastic trace. `other_squared` adds to the squared norm of the deviator in the yield criterion: strain of the same kind
// that is not in `trial` and is to be scaled alike.
template <class Law, class T>
LOAM_FN Projection<T> project(const Law &law, const HenckyStrain<T> &trial, T other_squared, T history, Flow<T> flow) {
  if constexpr (!Law::plastic) {
    return {trial, T(1.0f), history};
  } else {
    const T norm = square_root(frobenius_squared(trial.deviator) + other_squared);
    if constexpr (!Law::principal) {
      const Mapped<T> mapped = law.map(trial.trace, norm, history, flow);
      return {{mapped.trace, mapped.scale * trial.deviator}, mapped.scale, mapped.history};
    } else {
      const T third(1.0f / 3.0f);
      const Eigen3<T> eigen = eigen_decomposition(trial.deviator);
      T strain[3];
      for (int k = 0; k < 3; ++k) strain[k] = eigen.values[k] + third * trial.trace;
      Projection<T> result;
      result.history = law.map_principal(strain, history, flow);
      result.strain.trace = strain[0] + (strain[1] + strain[2]);
      for (int k = 0; k < 3; ++k) strain[k] = strain[k] - third * result.strain.trace;
      result.strain.deviator = from_eigen(eigen.vectors, strain);
      const T tiny(1e-12f);
      result.scale = minimum(square_root(frobenius_squared(result.strain.deviator)) / maximum(norm, tiny), T(1.0f));
      return result;
    }
  }
}

} // namespace loam
