#include "picture/ground_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "picture/sampling.h"

namespace runner {

float glass_reflectance(float cosine) {
  const float away = 1 - std::fmin(std::fabs(cosine), 1.0f);
  const float one_face = 0.04f + 0.96f * away * away * away * away * away; // Schlick's approximation
  return 2 * one_face / (1 + one_face);
}

float glass_transmittance(const RayScene &scene, const Ray &ray) {
  float share = 1;
  float from = 0;
  for (int panes = 0; panes < 6; ++panes) {
    const std::optional<Hit> pane = scene.glass(ray, from, 1e30f);
    if (!pane) break;
    share *= 0.97f * (1 - glass_reflectance(dot(pane->normal, ray.direction)));
    from = pane->distance + 2 * scene.lift();
  }
  return share;
}

GroundLight::GroundLight(const RayScene &scene, const Environment &environment)
    : scene_(&scene), environment_(&environment) {
  const Ground &ground = *scene.ground();
  const Frame frame(ground.normal);
  along_ = frame.tangent;
  across_ = frame.bitangent;
  const Vector3 middle = 0.5f * (scene.low() + scene.high());
  center_ = middle - dot(middle - ground.point, ground.normal) * ground.normal;
  half_ = 1.1f * length(scene.high() - scene.low());

  grid_.resize((cells + 1) * (cells + 1));
  tbb::parallel_for(0, cells + 1, [&](int row) {
    for (int column = 0; column <= cells; ++column) {
      const float u = 2 * static_cast<float>(column) / cells - 1, v = 2 * static_cast<float>(row) / cells - 1;
      const Vector3 position = center_ + (half_ * u) * along_ + (half_ * v) * across_;
      grid_[static_cast<std::size_t>(row * (cells + 1) + column)] = gather(position, pixel_noise(column, row));
    }
  });
  smooth();
}

Vector3 GroundLight::gather(Vector3 position, float turn) const {
  constexpr int sky_rays = 20, key_rays = 12;
  const Vector3 normal = scene_->ground()->normal;
  const Vector3 start = position + scene_->lift() * normal;
  const Frame frame(normal);
  Vector3 sum;
  for (int i = 0; i < sky_rays; ++i) {
    const Vector3 direction = cosine_direction(i, sky_rays, turn, normal, frame);
    if (!scene_->occluded({start, direction}))
      sum += (std::numbers::pi_v<float> / sky_rays) * environment_->ambient(direction);
  }
  const FarLight &key = environment_->key();
  const float facing = dot(normal, key.direction);
  if (facing <= 0) return sum;
  const Frame key_frame(key.direction);
  for (int i = 0; i < key_rays; ++i) {
    const Vector3 disc = disc_point(i, key_rays, turn);
    const Vector3 direction =
        normalized(key.direction + key.spread * (disc.x * key_frame.tangent + disc.y * key_frame.bitangent));
    if (scene_->occluded({start, direction})) continue;
    sum += (facing / key_rays * glass_transmittance(*scene_, {start, direction})) * key.colour;
  }
  return sum;
}

void GroundLight::smooth() {
  // Neighbouring corners use different rays; averaging them evens the grain out (1 4 6 4 1 along each axis).
  constexpr float weights[5] = {1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};
  constexpr int stride = cells + 1;
  std::vector<Vector3> other(grid_.size());
  for (const int step : {1, stride}) {
    for (int row = 0; row < stride; ++row)
      for (int column = 0; column < stride; ++column) {
        Vector3 sum;
        for (int k = -2; k <= 2; ++k) {
          const int r = step == 1 ? row : std::clamp(row + k, 0, cells);
          const int c = step == 1 ? std::clamp(column + k, 0, cells) : column;
          sum += weights[k + 2] * grid_[static_cast<std::size_t>(r * stride + c)];
        }
        other[static_cast<std::size_t>(row * stride + column)] = sum;
      }
    grid_.swap(other);
  }
}

Vector3 GroundLight::irradiance(Vector3 position) const {
  const Vector3 offset = position - center_;
  const auto coordinate = [&](Vector3 axis) {
    return std::clamp((dot(offset, axis) / half_ + 1) * 0.5f * cells, 0.0f, static_cast<float>(cells) - 1e-3f);
  };
  const float u = coordinate(along_), v = coordinate(across_);
  const int column = static_cast<int>(u), row = static_cast<int>(v);
  const Vector3 *corner = &grid_[static_cast<std::size_t>(row * (cells + 1) + column)];
  const float s = u - static_cast<float>(column), t = v - static_cast<float>(row);
  return mix(mix(corner[0], corner[1], s), mix(corner[cells + 1], corner[cells + 2], s), t);
}

} // namespace runner
