#include "picture/grain_light.h"

#include <numbers>

#include "picture/sampling.h"

namespace runner {
namespace {

constexpr int directions = 48;
constexpr float pi = std::numbers::pi_v<float>;

// The real spherical harmonics of degrees 0, 1 and 2, as polynomials of a unit vector.
std::array<float, 9> harmonics(Vector3 d) {
  return {0.282095f,
          0.488603f * d.y,
          0.488603f * d.z,
          0.488603f * d.x,
          1.092548f * d.x * d.y,
          1.092548f * d.y * d.z,
          0.315392f * (3 * d.z * d.z - 1),
          1.092548f * d.x * d.z,
          0.546274f * (d.x * d.x - d.y * d.y)};
}

struct Direction {
  Vector3 towards;
  std::array<float, 9> basis;
};

std::vector<Direction> make_directions() {
  std::vector<Direction> result;
  for (int i = 0; i < directions; ++i) {
    const Vector3 towards = sphere_direction(i, directions);
    result.push_back({towards, harmonics(towards)});
  }
  return result;
}

} // namespace

GrainLight gather_grain_light(const RayScene &scene, const Environment &environment, Vector3 center, float radius,
                              Vector3 bounce) {
  static const std::vector<Direction> all = make_directions();
  GrainLight light;
  for (const Direction &direction : all) {
    const Ray ray = {center + (1.02f * radius) * direction.towards, direction.towards};
    const Vector3 arriving = scene.occluded(ray) ? bounce : environment.ambient(direction.towards);
    for (std::size_t k = 0; k < 9; ++k) light.coefficients[k] += direction.basis[k] * arriving;
  }
  // Each direction stands for its share of the sphere; the cosine lobe's own coefficients are pi, 2 pi / 3 and pi / 4.
  constexpr float share = 4 * pi / directions;
  for (std::size_t k = 0; k < 9; ++k) {
    const float lobe = k == 0 ? pi : k < 4 ? 2 * pi / 3 : pi / 4;
    light.coefficients[k] = (share * lobe) * light.coefficients[k];
  }
  return light;
}

Vector3 GrainLight::irradiance(Vector3 normal) const {
  const std::array<float, 9> basis = harmonics(normal);
  Vector3 sum;
  for (std::size_t k = 0; k < 9; ++k) sum += basis[k] * coefficients[k];
  return maximum(sum, Vector3{});
}

} // namespace runner
