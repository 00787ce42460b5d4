#include "containment.h"

#include <algorithm>
#include <functional>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace runner {

Containment::Containment(const Scene &scene, const Particles &start) {
  const std::size_t ids = start.ids.empty() ? 0 : start.ids.back() + std::size_t(1);
  for (const SceneCollider &collider : scene.colliders) {
    if (collider.kind != LOAM_COLLIDER_MESH || !collider.motions.empty()) continue;
    const Mesh &mesh = scene.meshes.at(collider.file);
    if (!is_closed(mesh)) continue;
    Container container{InsideTest(mesh, collider.pose.position, collider.pose.rotation), std::vector<std::uint8_t>(ids)};
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, start.count(), 256), [&](const auto &range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        container.held[start.ids[i]] = container.test.inside(to_double(start.positions[i]));
    });
    if (std::find(container.held.begin(), container.held.end(), 1) != container.held.end())
      containers_.push_back(std::move(container));
  }
}

std::uint64_t Containment::count_outside(const Particles &particles) const {
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, particles.count(), 256), std::uint64_t(0),
      [&](const auto &range, std::uint64_t sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          sum += std::any_of(containers_.begin(), containers_.end(), [&](const Container &container) {
            const std::uint32_t id = particles.ids[i];
            return id < container.held.size() && container.held[id] != 0 &&
                   !container.test.inside(to_double(particles.positions[i]));
          });
        return sum;
      },
      std::plus<>());
}

} // namespace runner
