// What a backend holds that a step starts from, as a list of arrays: for snapshots, and whoever else moves state as a whole.
//
// An effect puts its arrays into the list, one line each. What it can find again (lists, contacts, caches) does not belong there.
#pragma once

#include <cstddef>
#include <cstdint>

namespace loam {

// Numbers in snapshots: they never change their meaning.
enum class StateKind : std::uint32_t {
  positions = 1,
  velocities = 2,
  strains = 3,
  histories = 4,
  drifts = 5,
  log_volumes = 6,
  rest_volumes = 7,
  ids = 8,
  materials = 9,
  rests = 10,
  displacements = 11,
  stresses = 12,
  answered_drifts = 13,
  ages = 20,
  cloth_positions = 32,
  cloth_velocities = 33,
  collider_vertices = 40,
  collider_targets = 41
};

// `count` elements of `stride` words of 4 bytes each in the executor's memory, of which the first `saved` are state.
struct StateSection {
  StateKind kind;
  std::uint32_t object; // which, where there are several of a kind
  std::byte *data;
  std::uint32_t stride, saved;
  std::uint64_t count;
  std::uint32_t few_values = 0; // bit k: word k mostly has the same few values in all elements
};

} // namespace loam
