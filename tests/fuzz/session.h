/* One random scene: a world that is driven through the whole public interface by calls that a seed decides, good and bad, and watched all along.
 *
 * What must hold after every call:
 *   - its status is one that the header knows, and not an internal error; there is an error text exactly when it failed
 *   - what must be refused is refused, what is in order is not
 *   - a failed call left the state's hash as it was (but for a step that ran out of room, which stands at its last whole substep)
 * and after every step:
 *   - everything is finite, volumes and masses are positive, masses and materials are what they were, particles come from nozzles and go to killers only
 *   - speeds are within twice r / substep, above that of the colliders
 *
 * Each call draws from a stream of its own, so that a second run can leave out those that failed, and must end in the same state. */
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace loam::fuzz {

struct SessionOptions {
  std::uint64_t seed = 1;
  std::uint32_t thread_count = 1;
  std::uint32_t instruction_set = 0;
  const std::vector<bool> *leave_out = nullptr; // calls of an earlier run that changed nothing
  bool verbose = false;
};

struct SessionReport {
  std::vector<std::string> findings; // what was wrong
  std::vector<bool> refused;         // for each call: failed, so that it might as well not have been made
  std::vector<std::uint64_t> hashes; // after each call
  bool repeatable = true; // false where memory was refused within a step, which another number of threads would not repeat
  std::uint64_t calls = 0, failures = 0, steps = 0, particles = 0;
};

SessionReport run_session(const SessionOptions &options);

} // namespace loam::fuzz
