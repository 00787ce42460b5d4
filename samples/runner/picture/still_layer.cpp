#include "picture/still_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/parallel_for.h>

#include "picture/ground_light.h"
#include "picture/sampling.h"

namespace runner {

Panes find_panes(const RayScene &scene, const Environment &environment, const Ray &ray, float to) {
  Panes result;
  float from = 0;
  while (result.count < result.panes.size()) {
    const std::optional<Hit> hit = scene.glass(ray, from, to);
    if (!hit) break;
    const float cosine = -dot(hit->normal, ray.direction);
    const float mirror = glass_reflectance(cosine);
    // The longer the way through the pane, the greener.
    const float way = 1 / std::fmax(cosine, 0.12f);
    result.panes[result.count++] = {hit->distance, mirror * environment.mirrored(reflect(ray.direction, hit->normal)),
                                    (1 - mirror) * Vector3{1 - 0.016f * way, 1 - 0.008f * way, 1 - 0.011f * way}};
    from = hit->distance + 2 * scene.lift();
  }
  return result;
}

SkyLight gather_sky_light(const RayScene &scene, const Environment &environment, Vector3 position, Vector3 normal, int rays,
                          float turn) {
  SkyLight light;
  const Frame frame(normal);
  const Vector3 start = position + scene.lift() * normal;
  for (int i = 0; i < rays; ++i) {
    const Vector3 direction = cosine_direction(i, rays, turn, normal, frame);
    if (scene.occluded({start, direction})) continue;
    light.irradiance += (std::numbers::pi_v<float> / static_cast<float>(rays)) * environment.ambient(direction);
    light.open += 1 / static_cast<float>(rays);
  }
  // What is not sky is some surface that is dimly lit itself.
  light.irradiance += (0.08f * std::numbers::pi_v<float> * (1 - light.open)) * environment.ambient(environment.up());
  return light;
}

StillLayer::StillLayer(const RayScene &scene, const Environment &environment, const Camera &camera) {
  const int width = camera.width(), height = camera.height();
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  surfaces_.resize(pixels);
  evenly_glazed_.resize(pixels);
  std::vector<std::uint8_t> counts(pixels);
  std::vector<std::vector<Pane>> rows(height);
  constexpr int sky_rays = 64;
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      const Ray ray = camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const Hit hit = scene.closest(ray);
      if (hit.kind == Hit::solid)
        surfaces_[pixel] = {hit.index, hit.normal,
                            gather_sky_light(scene, environment, hit.position, hit.normal, sky_rays, pixel_noise(x, y))};
      const Panes found = find_panes(scene, environment, ray, hit.distance);
      counts[pixel] = static_cast<std::uint8_t>(found.count);
      rows[y].insert(rows[y].end(), found.panes.begin(), found.panes.begin() + found.count);
    }
  });

  first_pane_.reserve(pixels + 1);
  std::size_t total = 0;
  for (const std::uint8_t count : counts) {
    first_pane_.push_back(total);
    total += count;
  }
  first_pane_.push_back(total);
  panes_.reserve(total);
  for (const std::vector<Pane> &row : rows) panes_.insert(panes_.end(), row.begin(), row.end());

  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      const auto same = [&](std::size_t other) { return counts[other] == counts[pixel]; };
      evenly_glazed_[pixel] = same(pixel - 1) && same(pixel + 1) && same(pixel - width) && same(pixel + width);
    }
}

const SkyLight *StillLayer::sky_light(std::size_t pixel, const Hit &hit) const {
  const Surface &surface = surfaces_[pixel];
  return surface.solid == hit.index && dot(surface.normal, hit.normal) > 0.95f ? &surface.light : nullptr;
}

} // namespace runner
