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
// that is not in `trial` and is to be scaled alike. A principal law has no such criterion and leaves it out.
template <class Law, class T>
LOAM_FN Projection<T> project(const Law &law, const HenckyStrain<T> &trial, T other_squared, T history, Flow<T> flow) {
  if constexpr (!Law::plastic) {
    return {trial, T(1.0f), history};
  } else if constexpr (!Law::principal) {
    const T norm = square_root(frobenius_squared(trial.deviator) + other_squared);
    const Mapped<T> mapped = law.map(trial.trace, norm, history, flow);
    return {{mapped.trace, mapped.scale * trial.deviator}, mapped.scale, mapped.history};
  } else {
    Projection<T> result = {trial, T(1.0f), history};
    const T third_of_trace = T(1.0f / 3.0f) * trial.trace, norm = square_root(frobenius_squared(trial.deviator));
    const T reach = T(0.81649668f) * norm; // no eigenvalue of the deviator is farther from 0 than sqrt(2/3) of its norm
    if (any(law.may_move(third_of_trace - reach, third_of_trace + reach))) {
      const Spectrum<T> spectrum = spectrum_of_traceless(trial.deviator);
      T strain[3];
      for (int k = 0; k < 3; ++k) strain[k] = spectrum.values[k] + third_of_trace;
      auto moved = norm < T(0.0f);
      const T before[3] = {strain[0], strain[1], strain[2]};
      result.history = law.map_principal(strain, history, flow);
      for (int k = 0; k < 3; ++k) moved = either(moved, either(strain[k]<before[k], strain[k]> before[k]));
      result.history = select(moved, result.history, history);
      const T trace = strain[0] + (strain[1] + strain[2]);
      for (T &e : strain) e = e - T(1.0f / 3.0f) * trace;
      result.strain.trace = select(moved, trace, trial.trace);
      result.strain.deviator = select(moved, with_values(spectrum, strain), trial.deviator);
      const T scaled = square_root(frobenius_squared(result.strain.deviator)) / maximum(norm, T(1e-20f));
      result.scale = select(moved, minimum(scaled, T(1.0f)), T(1.0f));
    }
    return result;
  }
}

} // namespace loam
