// Checks of what the host gives: each failure names the field, its value and what would be right.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "scene/error.h"

namespace loam {

inline void check_pointer(const void *pointer, const char *name) {
  if (pointer == nullptr) throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s is null", name));
}

inline void check_range(const char *field, double value, double least, double most) {
  if (!(value >= least && value <= most)) // also false for NaN
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s is %g; it must be from %g to %g", field, value, least, most));
}

inline void check_above(const char *field, double value, double bound, double most) {
  if (!(value > bound && value <= most))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("%s is %g; it must be over %g and at most %g", field, value, bound, most));
}

inline void check_vector(const char *field, const float v[3], double most) {
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(static_cast<double>(v[k])) <= most))
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s[%d] is %g; it must be finite and at most %g in size", field, k,
                                                      static_cast<double>(v[k]), most));
}

// One of the values 0 to last of an enumeration.
inline void check_choice(const char *field, std::uint32_t value, std::uint32_t last) {
  if (value > last)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s is %u; it must be from 0 to %u", field, value, last));
}

inline void check_reserved(const char *field, std::uint32_t value) {
  if (value != 0) throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("%s is %u; it must be 0", field, value));
}

} // namespace loam
