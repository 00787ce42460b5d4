#include <cstdio>

#include "api/guard.h"

namespace loam {

namespace {
thread_local char last_error[1024];
}

void set_last_error(const char *text) noexcept { std::snprintf(last_error, sizeof last_error, "%s", text); }

} // namespace loam

const char *loam_status_name(loam_status status) {
  switch (status) {
  case LOAM_OK:
    return "LOAM_OK";
  case LOAM_ERROR_INVALID_ARGUMENT:
    return "LOAM_ERROR_INVALID_ARGUMENT";
  case LOAM_ERROR_INVALID_HANDLE:
    return "LOAM_ERROR_INVALID_HANDLE";
  case LOAM_ERROR_OUT_OF_MEMORY:
    return "LOAM_ERROR_OUT_OF_MEMORY";
  case LOAM_ERROR_CAPACITY:
    return "LOAM_ERROR_CAPACITY";
  case LOAM_ERROR_BACKEND_UNAVAILABLE:
    return "LOAM_ERROR_BACKEND_UNAVAILABLE";
  case LOAM_ERROR_IN_USE:
    return "LOAM_ERROR_IN_USE";
  case LOAM_ERROR_INVALID_MESH:
    return "LOAM_ERROR_INVALID_MESH";
  case LOAM_ERROR_DEVICE:
    return "LOAM_ERROR_DEVICE";
  case LOAM_ERROR_INTERNAL:
    return "LOAM_ERROR_INTERNAL";
  case LOAM_ERROR_INVALID_SNAPSHOT:
    return "LOAM_ERROR_INVALID_SNAPSHOT";
  case LOAM_ERROR_SNAPSHOT_MISMATCH:
    return "LOAM_ERROR_SNAPSHOT_MISMATCH";
  case LOAM_ERROR_BUSY:
    return "LOAM_ERROR_BUSY";
  case LOAM_ERROR_NOT_BUILT:
    return "LOAM_ERROR_NOT_BUILT";
  case LOAM_ERROR_BUDGET:
    return "LOAM_ERROR_BUDGET";
  default:
    return "LOAM_ERROR_UNKNOWN";
  }
}

const char *loam_last_error(void) { return loam::last_error; }

loam_status loam_version(uint32_t *major, uint32_t *minor, uint32_t *patch) {
  return loam::guarded(nullptr, [&] {
    if (major != nullptr) *major = LOAM_VERSION_MAJOR;
    if (minor != nullptr) *minor = LOAM_VERSION_MINOR;
    if (patch != nullptr) *patch = LOAM_VERSION_PATCH;
  });
}
