#include "motion.h"

#include <algorithm>
#include <cmath>

namespace runner {
namespace {

using Quaternion = std::array<double, 4>;

// First b, then a.
Quaternion product(const Quaternion &a, const Quaternion &b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

} // namespace

Vector3 rotate(const std::array<float, 4> &rotation, Vector3 v) {
  const Vector3 axis = {rotation[0], rotation[1], rotation[2]};
  const Vector3 t = 2.0f * cross(axis, v);
  return v + rotation[3] * t + cross(axis, t);
}

Pose pose_at(const Pose &start, const std::vector<Motion> &motions, double time) {
  Vector3d position = to_double(start.position);
  Quaternion rotation = {start.rotation[0], start.rotation[1], start.rotation[2], start.rotation[3]};
  for (const Motion &motion : motions) {
    const double seconds = std::max(0.0, std::min(time, motion.stop) - motion.start);
    position += seconds * to_double(motion.velocity);
    const double half = 0.5 * motion.spin * seconds;
    const Vector3d part = std::sin(half) * to_double(motion.spin_axis);
    rotation = product({part.x, part.y, part.z, std::cos(half)}, rotation);
  }
  Pose result{to_float(position), {}};
  for (std::size_t i = 0; i < 4; ++i) result.rotation[i] = static_cast<float>(rotation[i]);
  return result;
}

} // namespace runner
