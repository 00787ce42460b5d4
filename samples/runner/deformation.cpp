#include "deformation.h"

#include <cmath>
#include <numbers>

namespace runner {
namespace {

Vector3d deformed(Vector3d p, const Deformation &how, double time) {
  if (time < how.start) return p;
  const Vector3d axis = to_double(how.axis);
  const double turns = (time - how.start) / how.period, along = dot(axis, p);
  const double amplitude = double(how.amplitude), a = amplitude * std::sin(2 * std::numbers::pi * turns);
  const Vector3d across = p - along * axis;
  switch (how.kind) {
  case Deformation::Kind::squash:
    return (1 - a) * along * axis + 1 / std::sqrt(1 - a) * across;
  case Deformation::Kind::twist: {
    const double angle = a * along * std::numbers::pi / 180;
    return along * axis + std::cos(angle) * across + std::sin(angle) * cross(axis, across);
  }
  default: {
    const double phase = turns - dot(to_double(how.direction), p) / double(how.wavelength);
    return p + amplitude * std::sin(2 * std::numbers::pi * phase) * axis;
  }
  }
}

} // namespace

Mesh deformed(const Mesh &mesh, const std::vector<Deformation> &deformations, double time) {
  Mesh result = mesh;
  for (Vector3 &vertex : result.vertices) {
    Vector3d p = to_double(vertex);
    for (const Deformation &deformation : deformations) p = deformed(p, deformation, time);
    vertex = to_float(p);
  }
  return result;
}

} // namespace runner
