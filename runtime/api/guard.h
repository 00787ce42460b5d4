// The boundary: no exception passes it, every failure becomes a status, a text for the calling thread, and a line in the world's log.
#pragma once

#include <algorithm>
#include <cstring>
#include <initializer_list>
#include <new>
#include <string>

#include "scene/checks.h"
#include "scene/world.h"

namespace loam {

// The calling thread's last error text.
void set_last_error(const char *text) noexcept;

// Whether a call may come during an asynchronous step.
enum class Meanwhile { busy, allowed };

template <class F>
loam_status guarded(const loam_world *world, F &&function, Meanwhile meanwhile = Meanwhile::busy) noexcept {
  set_last_error("");
  loam_status status = LOAM_OK;
  try {
    if (meanwhile == Meanwhile::busy && world != nullptr) world->check_not_stepping();
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

// Throws for a struct size that neither this version nor an earlier one had.
template <class Def>
void check_size(const char *what, std::size_t size, std::initializer_list<std::size_t> earlier, const char *advice) {
  if (size == sizeof(Def) || std::find(earlier.begin(), earlier.end(), size) != earlier.end()) return;
  std::string known;
  for (const std::size_t each : earlier) known += std::to_string(each) + ", ";
  throw Error(LOAM_ERROR_INVALID_ARGUMENT,
              format("%s is %zu; this library knows %s%zu%s", what, size, known.c_str(), sizeof(Def), advice));
}

// A copy of a host's definition: fields that an older, smaller struct lacks keep the values of `defaults`. `earlier` are the sizes that the struct
// had in earlier versions.
template <class Def>
Def read_definition(const Def *def, const char *name, const Def &defaults, std::initializer_list<std::size_t> earlier = {}) {
  check_pointer(def, name);
  check_size<Def>((std::string(name) + "->struct_size").c_str(), def->struct_size, earlier,
                  ". Fill the definition with its default function, and do not run a host against an older library");
  Def copy = defaults;
  std::memcpy(static_cast<void *>(&copy), def, def->struct_size);
  copy.struct_size = sizeof(Def);
  return copy;
}

// Writes defaults or results into a host's struct of `size` bytes, with struct_size set to that.
template <class Def>
void write_definition(Def *def, const char *name, std::size_t size, const Def &value,
                      std::initializer_list<std::size_t> earlier = {}) {
  check_pointer(def, name);
  check_size<Def>(("the size of " + std::string(name)).c_str(), size, earlier, "");
  Def copy = value;
  copy.struct_size = static_cast<std::uint32_t>(size);
  std::memcpy(static_cast<void *>(def), &copy, size);
}

} // namespace loam
