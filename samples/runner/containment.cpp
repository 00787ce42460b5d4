#include "containment.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include "inside_test.h"

namespace runner {
namespace {

// From the world's frame to a collider's, in double precision.
class ToLocal {
public:
  explicit ToLocal(const Pose &pose) : position_(to_double(pose.position)) {
    const auto &q = pose.rotation;
    const double norm = std::sqrt(double(q[0]) * q[0] + double(q[1]) * q[1] + double(q[2]) * q[2] + double(q[3]) * q[3]);
    axis_ = {-q[0] / norm, -q[1] / norm, -q[2] / norm};
    w_ = q[3] / norm;
  }
  Vector3d operator()(Vector3d world) const {
    const Vector3d v = world - position_, t = 2.0 * cross(axis_, v);
    return v + w_ * t + cross(axis_, t);
  }

private:
  Vector3d position_, axis_;
  double w_ = 1;
};

// Null where it has no sides.
Containment::Inside inside_of(const SceneCollider &collider, const Mesh *mesh, double time) {
  const double radius = collider.radius, half_height = collider.half_height;
  switch (collider.kind) {
  case LOAM_COLLIDER_PLANE:
    return [](Vector3d p) { return p.y < 0; };
  case LOAM_COLLIDER_SPHERE:
    return [=](Vector3d p) { return length(p) < radius; };
  case LOAM_COLLIDER_CAPSULE:
    return [=](Vector3d p) {
      const double along = std::clamp(p.y, -half_height, half_height);
      return length(Vector3d{p.x, p.y - along, p.z}) < radius;
    };
  case LOAM_COLLIDER_BOX:
    return [half = to_double(collider.half_extents)](Vector3d p) {
      return std::abs(p.x) < half.x && std::abs(p.y) < half.y && std::abs(p.z) < half.z;
    };
  case LOAM_COLLIDER_GRID:
    return [&field = collider.field](Vector3d p) { return field.at(p) < 0; };
  default: {
    if (!is_closed(*mesh)) return {};
    const auto test = collider.deformations.empty()
                          ? std::make_shared<InsideTest>(*mesh, Vector3{}, std::array<float, 4>{0, 0, 0, 1})
                          : std::make_shared<InsideTest>(deformed(*mesh, collider.deformations, time), Vector3{},
                                                         std::array<float, 4>{0, 0, 0, 1});
    return [test](Vector3d p) { return test->inside(p); };
  }
  }
}

} // namespace

Containment::Containment(const Scene &scene, const Particles &start) {
  const std::size_t ids = start.ids.empty() ? 0 : start.ids.back() + std::size_t(1);
  for (const SceneCollider &collider : scene.colliders) {
    const auto found = scene.meshes.find(collider.file);
    const Mesh *mesh = found != scene.meshes.end() ? &found->second : nullptr;
    Side side{&collider, mesh, inside_of(collider, mesh, 0), collider.kind == LOAM_COLLIDER_MESH,
              std::vector<std::uint8_t>(ids)};
    if (!side.inside) continue;
    const ToLocal to_local(collider.pose);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, start.count(), 256), [&](const auto &range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        side.within[start.ids[i]] = side.inside(to_local(to_double(start.positions[i])));
    });
    sides_.push_back(std::move(side));
  }
}

std::uint64_t Containment::count_outside(const Particles &particles, double time) const {
  std::vector<ToLocal> frames;
  std::vector<Inside> now;
  for (const Side &side : sides_) {
    frames.emplace_back(pose_at(side.collider->pose, side.collider->motions, time));
    now.push_back(side.collider->deformations.empty() ? side.inside : inside_of(*side.collider, side.mesh, time));
  }
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, particles.count(), 256), std::uint64_t(0),
      [&](const auto &range, std::uint64_t sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          for (std::size_t s = 0; s < sides_.size(); ++s) {
            const Side &side = sides_[s];
            const std::uint32_t id = particles.ids[i];
            if (id >= side.within.size() || (side.within[id] != 0 && !side.both)) continue;
            if (now[s](frames[s](to_double(particles.positions[i]))) == (side.within[id] != 0)) continue;
            ++sum;
            break;
          }
        return sum;
      },
      std::plus<>());
}

} // namespace runner
