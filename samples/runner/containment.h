// Counts the particles that have got through a collider: those that are in a solid in which they did not start, and those on the other side of a
// closed mesh.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh.h"
#include "particles.h"
#include "scene.h"

namespace runner {

class Containment {
public:
  using Inside = std::function<bool(Vector3d)>; // of a point in the collider's frame

  // `start` are the particles before the first step. Open meshes have no sides and take no part.
  Containment(const Scene &scene, const Particles &start);

  // Particles that are now on a side of a collider where they must not be; `time` in seconds says where it has moved and how it is deformed.
  std::uint64_t count_outside(const Particles &particles, double time) const;
  // Colliders that take part.
  std::size_t sides() const { return sides_.size(); }

private:
  struct Side {
    const SceneCollider *collider;
    const Mesh *mesh;                 // as it was described; null if it has none
    Inside inside;                    // at the start
    bool both;                        // a mesh: coming out is as wrong as going in
    std::vector<std::uint8_t> within; // by particle id: was it inside at the start?
  };
  std::vector<Side> sides_;
};

} // namespace runner
