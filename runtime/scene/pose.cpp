#include "scene/pose.h"

#include <cmath>

#include "scene/checks.h"

namespace loam {

Pose interpolate(const Pose &a, const Pose &b, double t) {
  if (t <= 0) return a;
  if (t >= 1) return b;
  Pose pose;
  pose.position = {static_cast<float>(a.position.x + t * (static_cast<double>(b.position.x) - a.position.x)),
                   static_cast<float>(a.position.y + t * (static_cast<double>(b.position.y) - a.position.y)),
                   static_cast<float>(a.position.z + t * (static_cast<double>(b.position.z) - a.position.z))};
  const double p[4] = {a.rotation.x, a.rotation.y, a.rotation.z, a.rotation.w};
  double q[4] = {b.rotation.x, b.rotation.y, b.rotation.z, b.rotation.w};
  double cosine = p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  if (cosine < 0) { // the shorter way round
    for (double &c : q) c = -c;
    cosine = -cosine;
  }
  double from = 1 - t, to = t;
  if (cosine < 0.9999) {
    const double angle = std::acos(cosine), sine = std::sin(angle);
    from = std::sin((1 - t) * angle) / sine;
    to = std::sin(t * angle) / sine;
  }
  double r[4], norm = 0;
  for (int k = 0; k < 4; ++k) {
    r[k] = from * p[k] + to * q[k];
    norm += r[k] * r[k];
  }
  norm = std::sqrt(norm);
  pose.rotation = {static_cast<float>(r[0] / norm), static_cast<float>(r[1] / norm), static_cast<float>(r[2] / norm),
                   static_cast<float>(r[3] / norm)};
  return pose;
}

Pose make_pose(const float position[3], const float rotation[4]) {
  check_vector("position", position, 1e9);
  double norm = 0;
  for (int k = 0; k < 4; ++k) {
    if (!(std::abs(static_cast<double>(rotation[k])) <= 1e6))
      throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                  format("rotation[%d] is %g; it must be finite", k, static_cast<double>(rotation[k])));
    norm += static_cast<double>(rotation[k]) * static_cast<double>(rotation[k]);
  }
  norm = std::sqrt(norm);
  if (!(norm > 1e-6)) throw Error(LOAM_ERROR_INVALID_ARGUMENT, "rotation is a quaternion of length 0");
  Pose pose;
  pose.position = {position[0], position[1], position[2]};
  pose.rotation = {static_cast<float>(static_cast<double>(rotation[0]) / norm),
                   static_cast<float>(static_cast<double>(rotation[1]) / norm),
                   static_cast<float>(static_cast<double>(rotation[2]) / norm),
                   static_cast<float>(static_cast<double>(rotation[3]) / norm)};
  return pose;
}

} // namespace loam
