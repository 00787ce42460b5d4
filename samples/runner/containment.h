// Counts the particles that have left the closed colliders in which they started.
#pragma once

#include <cstdint>
#include <vector>

#include "inside_test.h"
#include "particles.h"
#include "scene.h"

namespace runner {

class Containment {
public:
  // `start` are the particles before the first step. A collider takes part if it never moves, its mesh is closed, and it holds at least one of them.
  Containment(const Scene &scene, const Particles &start);

  // Particles that are now outside a collider that they started in.
  std::uint64_t count_outside(const Particles &particles) const;
  std::size_t containers() const { return containers_.size(); }

private:
  struct Container {
    InsideTest test;
    std::vector<std::uint8_t> held; // by particle id: was it inside at the start?
  };
  std::vector<Container> containers_;
};

} // namespace runner
