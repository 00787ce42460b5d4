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

std::function<bool(Vector3d)> inside_of(const SceneCollider &collider, const Scene &scene) {
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
    const Mesh &mesh = scene.meshes.at(collider.file);
    if (!is_closed(mesh)) return {};
    return [test = std::make_shared<InsideTest>(mesh, Vector3{}, std::array<float, 4>{0, 0, 0, 1})](Vector3d p) {
      return test->inside(p);
    };
  }
  }
}

} // namespace

Containment::Containment(const Scene &scene, const Particles &start) {
  const std::size_t ids = start.ids.empty() ? 0 : start.ids.back() + std::size_t(1);
  for (const SceneCollider &collider : scene.colliders) {
    Side side{&collider, inside_of(collider, scene), collider.kind == LOAM_COLLIDER_MESH, std::vector<std::uint8_t>(ids)};
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
  for (const Side &side : sides_) frames.emplace_back(pose_at(side.collider->pose, side.collider->motions, time));
  return tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, particles.count(), 256), std::uint64_t(0),
      [&](const auto &range, std::uint64_t sum) {
        for (std::size_t i = range.begin(); i < range.end(); ++i)
          for (std::size_t s = 0; s < sides_.size(); ++s) {
            const Side &side = sides_[s];
            const std::uint32_t id = particles.ids[i];
            if (id >= side.within.size() || (side.within[id] != 0 && !side.both)) continue;
            if (side.inside(frames[s](to_double(particles.positions[i]))) == (side.within[id] != 0)) continue;
            ++sum;
            break;
          }
        return sum;
      },
      std::plus<>());
}

} // namespace runner
