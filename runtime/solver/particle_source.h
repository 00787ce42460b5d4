// How matter that streams gets from the scene to the machine: after each substep the solver asks the source what has entered meanwhile.
#pragma once

#include <cstdint>

#include "math/vector.h"

namespace loam {

// Particles that enter together: consecutive ids, pinned until they are released.
struct Layer {
  std::uint32_t material, first_id;
  int count;
  float volume;
  const Row *positions, *velocities;
  const std::uint32_t *ids;
};

// Particles of consecutive ids that the nozzle leads no longer.
struct Release {
  std::uint32_t first_id, count;
  float inverse_mass, velocity_jitter;
  std::uint32_t seed;
};

class ParticleSink {
public:
  virtual std::uint64_t room() const = 0; // particles that would fit
  virtual void enter(const Layer &layer) = 0;
  virtual void release(const Release &release) = 0;
  virtual void drop(std::uint64_t count) = 0; // had no room

protected:
  ~ParticleSink() = default;
};

class ParticleSource {
public:
  // `seconds` have passed. Takes no memory and does not throw.
  virtual void advance(double seconds, ParticleSink &sink) = 0;

protected:
  ~ParticleSource() = default;
};

} // namespace loam
