// The boundary: no exception passes it, every failure becomes a status, a text for the calling thread, and a line in the world's log.
#pragma once

#include <algorithm>
#include <cstring>
#include <new>

#include "scene/checks.h"
#include "scene/world.h"

namespace loam {

// The calling thread's last error text.
void set_last_error(const char *text) noexcept;

template <class F> loam_status guarded(const loam_world *world, F &&function) noexcept {
  set_last_error("");
  loam_status status = LOAM_OK;
  try {
    function();
    return LOAM_OK;
  } catch (const Error &error) {
    status = error.status();
    set_last_error(error.what());
  } catch (const std::bad_alloc &) {
    status = LOAM_ERROR_OUT_OF_MEMORY;
    set_last_error("out of memory for bookkeeping");
  } catch (const std::exception &error) {
    status = LOAM_ERROR_INTERNAL;
    set_last_error(error.what());
  } catch (...) {
    status = LOAM_ERROR_INTERNAL;
    set_last_error("unknown exception");
  }
  if (world != nullptr) world->log(LOAM_LOG_ERROR, loam_last_error());
  return status;
}

// A copy of a host's definition: fields that an older, smaller struct lacks keep the values of `defaults`. `first_size` is the struct's size in
// the first version that had it.
template <class Def>
Def read_definition(const Def *def, const char *name, const Def &defaults, std::size_t first_size = sizeof(Def)) {
  check_pointer(def, name);
  if (def->struct_size < first_size || def->struct_size > sizeof(Def))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("%s->struct_size is %u; this library knows %zu to %zu. Fill the definition with its "
                       "default function, and do not run a host against an older library",
                       name, def->struct_size, first_size, sizeof(Def)));
  Def copy = defaults;
  std::memcpy(static_cast<void *>(&copy), def, def->struct_size);
  copy.struct_size = sizeof(Def);
  return copy;
}

// Writes defaults or results into a host's struct of `size` bytes, with struct_size set to that.
template <class Def>
void write_definition(Def *def, const char *name, std::size_t size, const Def &value, std::size_t first_size = sizeof(Def)) {
  check_pointer(def, name);
  if (size < first_size || size > sizeof(Def))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("the size of %s is given as %zu; this library knows %zu to %zu", name,
                                                    size, first_size, sizeof(Def)));
  Def copy = value;
  copy.struct_size = static_cast<std::uint32_t>(size);
  std::memcpy(static_cast<void *>(def), &copy, size);
}

} // namespace loam
