#include "picture/renderer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <tbb/blocked_range2d.h>
#include <tbb/parallel_for.h>

#include "picture/sampling.h"
#include "picture/surface.h"
#include "picture/surface_colour.h"
#include "picture/tone_curve.h"

namespace runner {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

Vector3 up_of(const Scene &scene) {
  const Vector3 gravity = {scene.world.gravity[0], scene.world.gravity[1], scene.world.gravity[2]};
  return length(gravity) > 0 ? -gravity : Vector3{0, 1, 0};
}

} // namespace

Renderer::Renderer(const Scene &scene, const Particles &start)
    : scene_(&scene), camera_(*scene.camera), environment_(scene.light, up_of(scene)), rays_(scene),
      still_(rays_, environment_, camera_) {
  for (const SceneEmitter &emitter : scene.emitters) {
    const Look look = std::find_if(scene.materials.begin(), scene.materials.end(), [&](const SceneMaterial &material) {
                        return material.name == emitter.material;
                      })->look;
    surfaces_.push_back(look == Look::grains
                            ? none
                            : rays_.add_surface(look == Look::glossy ? Appearance::glossy : Appearance::matte,
                                                emitter.colour, 0.2f * scene.world.kernel_radius));
  }
  for (const SceneCloth &cloth : scene.cloths)
    sheets_.push_back(cloth.appearance == Appearance::hidden ? none : rays_.add_surface(cloth.appearance, cloth.colour, 0));
  in_band_.resize(start.ids.empty() ? 0 : start.ids.back() + std::size_t(1));
  for (std::size_t i = 0; i < start.count(); ++i) {
    const float height = scene.emitters[start.emitters[i]].band_height;
    if (height > 0)
      in_band_[start.ids[i]] = std::fmod(std::floor(dot(start.positions[i], environment_.up()) / height), 2.0f) != 0;
  }
}

Image Renderer::render(const Particles &particles, const std::vector<Mesh> &cloths, double time) {
  place_cloths(cloths);
  place_particles(particles, time);
  if (rays_.ground()) ground_light_.emplace(rays_, environment_);

  const int width = camera_.width(), height = camera_.height();
  const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * width + x; };
  const tbb::blocked_range2d<int> pixels(0, height, 16, 0, width, 16);
  const auto each_pixel = [&](const auto &visit) {
    tbb::parallel_for(pixels, [&](const tbb::blocked_range2d<int> &tile) {
      for (int y = tile.rows().begin(); y < tile.rows().end(); ++y)
        for (int x = tile.cols().begin(); x < tile.cols().end(); ++x) visit(x, y);
    });
  };

  std::vector<Sample> first(at(0, height));
  each_pixel([&](int x, int y) {
    first[at(x, y)] = sample(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, at(x, y), pixel_noise(x, y));
  });

  // More samples only where something begins or ends: in most of a picture one is enough.
  Image image{width, height, std::vector<std::uint8_t>(3 * at(0, height))};
  each_pixel([&](int x, int y) {
    const Sample &own = first[at(x, y)];
    bool edge = false;
    if (x > 0) edge |= differ(own, first[at(x - 1, y)]);
    if (y > 0) edge |= differ(own, first[at(x, y - 1)]);
    if (x + 1 < width) edge |= differ(own, first[at(x + 1, y)]);
    if (y + 1 < height) edge |= differ(own, first[at(x, y + 1)]);
    Vector3 colour = own.display;
    if (edge) {
      constexpr float offsets[4][2] = {{0.375f, 0.125f}, {0.875f, 0.375f}, {0.125f, 0.625f}, {0.625f, 0.875f}};
      for (int i = 0; i < 4; ++i)
        colour += sample(static_cast<float>(x) + offsets[i][0], static_cast<float>(y) + offsets[i][1], at(x, y),
                         fraction(pixel_noise(x, y) + 0.2f * static_cast<float>(i + 1)))
                      .display;
      colour = 0.2f * colour;
    }
    // Half a level of noise keeps gradients free of bands.
    const float dither = pixel_noise(x + 71, y + 113) - 0.5f;
    for (int channel = 0; channel < 3; ++channel)
      image.pixels[3 * at(x, y) + channel] =
          static_cast<std::uint8_t>(std::clamp(255 * colour[channel] + 0.5f + dither, 0.0f, 255.0f));
  });
  return image;
}

void Renderer::place_cloths(const std::vector<Mesh> &cloths) {
  for (std::size_t i = 0; i < cloths.size(); ++i)
    if (sheets_[i] != none) rays_.set_sheet(sheets_[i], cloths[i]);
}

void Renderer::place_particles(const Particles &particles, double time) {
  std::vector<float> spheres;
  std::vector<std::vector<Vector3>> bodies(surfaces_.size());
  radii_.clear();
  colours_.clear();
  const float radius = 0.47f * scene_->world.kernel_radius;
  for (std::size_t i = 0; i < particles.count(); ++i) {
    const Vector3 x = particles.positions[i];
    const std::uint32_t emitter = particles.emitters[i];
    if (surfaces_[emitter] != none) {
      bodies[emitter].push_back(x);
      continue;
    }
    const std::uint32_t id = particles.ids[i];
    radii_.push_back(radius * (0.88f + 0.2f * hash_unit(id + 0x9e3779b9u)));
    spheres.insert(spheres.end(), {x.x, x.y, x.z, radii_.back()});
    const float variation = scene_->materials[particles.materials[i]].colour_variation;
    const SceneEmitter &from = scene_->emitters[emitter];
    colours_.push_back(grain_colour(id < in_band_.size() && in_band_[id] ? from.band_colour : from.colour, variation, id));
  }
  // Matter lies on a sheet by less than its surface is thick: what would reach through is cut off.
  Barrier sheets;
  if (!sheets_.empty())
    sheets = [this](Vector3 from, Vector3 direction, float limit) { return rays_.sheet_ahead(from, direction, limit); };
  for (std::size_t i = 0; i < surfaces_.size(); ++i)
    if (surfaces_[i] != none) rays_.set_surface(surfaces_[i], make_surface(bodies[i], scene_->world.kernel_radius, sheets));
  rays_.set_frame(std::move(spheres), time);
  grain_lights_.resize(radii_.size());
  grain_light_states_ = std::vector<std::atomic<std::uint8_t>>(radii_.size());
}

bool Renderer::differ(const Sample &a, const Sample &b) {
  return a.kind != b.kind || a.index != b.index || a.panes != b.panes ||
         dot(a.normal - b.normal, a.normal - b.normal) > 0.08f;
}

Renderer::Sample Renderer::sample(float x, float y, std::size_t pixel, float noise) {
  const Ray ray = camera_.ray(x, y);
  const Hit hit = rays_.closest(ray);
  Panes own;
  std::span<const Pane> panes = still_.panes(pixel);
  if (!still_.evenly_glazed(pixel)) {
    own = find_panes(rays_, environment_, ray, hit.distance);
    panes = {own.panes.data(), own.count};
  }

  Sample result;
  result.kind = hit.kind;
  result.index = hit.index;
  result.normal = hit.normal;
  Vector3 light, passing = {1, 1, 1};
  for (const Pane &pane : panes) {
    if (pane.distance > hit.distance) break;
    light += passing * pane.mirrored;
    passing = passing * pane.passing;
    ++result.panes;
  }
  const float across = x / static_cast<float>(camera_.width()), down = y / static_cast<float>(camera_.height());
  light += passing * shade(ray, hit, pixel, noise, environment_.background(across, down));

  const float cx = across - 0.5f, cy = down - 0.5f;
  const float vignette = 1 - 0.35f * (cx * cx + cy * cy);
  result.display = display_colour((environment_.exposure() * vignette) * light);
  return result;
}

Vector3 Renderer::shade(const Ray &ray, const Hit &hit, std::size_t pixel, float noise, Vector3 background) {
  switch (hit.kind) {
  case Hit::particle:
    return shade_particle(ray, hit, noise);
  case Hit::solid:
    return shade_solid(ray, hit, pixel, noise);
  case Hit::ground:
    return shade_ground(hit, background);
  default:
    return background;
  }
}

Vector3 Renderer::shade_ground(const Hit &hit, Vector3 background) const {
  const Ground &ground = *rays_.ground();
  const float size = length(rays_.high() - rays_.low());
  // The ground runs into the backdrop without a horizon.
  const float away = std::fmax(0.0f, length(hit.position - camera_.target()) / size - 0.5f);
  const float share = std::exp(-1.3f * away * away);
  if (!(share > 1e-3f)) return background;
  const Vector3 from = hit.position - ground.point;
  Vector3 colour = ground.colour;
  if (ground.appearance == Appearance::wood) colour = plank_colour(colour, from, Frame(ground.normal), 0.09f * size);
  if (ground.appearance == Appearance::tiles) colour = tile_colour(colour, from, Frame(ground.normal), 0.16f * size);
  const Vector3 lit = (1 / pi) * (colour * ground_light_->irradiance(hit.position));
  return mix(background, lit, share);
}

GrainLight Renderer::grain_light(std::uint32_t index) {
  std::atomic<std::uint8_t> &state = grain_light_states_[index];
  if (state.load(std::memory_order_acquire) == stored) return grain_lights_[index];
  const Vector3 center = {rays_.sphere(index)[0], rays_.sphere(index)[1], rays_.sphere(index)[2]};
  // Matter around a grain is lit about a third as well as open matter is, and passes its own colour on.
  const Vector3 sky = environment_.ambient(environment_.up());
  const Vector3 bounce = 0.30f * (colours_[index] * (sky + (0.25f / pi) * environment_.key().colour));
  const GrainLight light = gather_grain_light(rays_, environment_, center, radii_[index], bounce);
  std::uint8_t expected = unknown;
  if (state.compare_exchange_strong(expected, being_stored)) {
    grain_lights_[index] = light;
    state.store(stored, std::memory_order_release);
  }
  return light;
}

Vector3 Renderer::direct(const FarLight &light, const Hit &hit, Vector3 view, float noise, int rays, float gloss) const {
  const float facing = dot(hit.normal, light.direction);
  if (facing <= 0) return {};
  const float own_lift = hit.kind == Hit::solid ? rays_.solids()[hit.index].lift : 0.0f;
  const Vector3 start = hit.position + std::fmax(rays_.lift(), own_lift) * hit.normal;
  const Frame frame(light.direction);
  int seen = 0;
  for (int i = 0; i < rays; ++i) {
    const Vector3 disc = disc_point(i, rays, noise);
    const Vector3 direction =
        normalized(light.direction + light.spread * (disc.x * frame.tangent + disc.y * frame.bitangent));
    if (!rays_.occluded({start, direction})) ++seen;
  }
  if (seen == 0) return {};
  const Vector3 half = normalized(light.direction + view);
  const float highlight = gloss * 4.0f * std::pow(std::fmax(0.0f, dot(half, hit.normal)), 40.0f);
  return (static_cast<float>(seen) / static_cast<float>(rays) * facing * (1 + highlight)) * light.colour;
}

Vector3 Renderer::shade_particle(const Ray &ray, const Hit &hit, float noise) {
  Vector3 arriving = grain_light(hit.index).irradiance(hit.normal);
  arriving += direct(environment_.key(), hit, -ray.direction, noise, 3, 0.12f);
  arriving += direct(environment_.rim(), hit, -ray.direction, noise, 1, 0.10f);
  return (1 / pi) * (colours_[hit.index] * arriving);
}

Vector3 Renderer::colour_of(const Hit &hit) const {
  return hit.kind == Hit::particle ? colours_[hit.index] : rays_.solids()[hit.index].colour;
}

Vector3 Renderer::shade_solid(const Ray &ray, const Hit &hit, std::size_t pixel, float noise) const {
  const Solid &solid = rays_.solids()[hit.index];
  const SkyLight *known = still_.sky_light(pixel, hit);
  const SkyLight sky = known != nullptr ? *known
                                        : gather_sky_light(rays_, environment_, hit.position + solid.lift * hit.normal,
                                                           hit.normal, 40, noise);
  const Vector3 mirrored = reflect(ray.direction, hit.normal);
  Vector3 arriving = sky.irradiance;
  if (solid.appearance == Appearance::metal) {
    arriving += direct(environment_.key(), hit, -ray.direction, noise, 2, 0.6f);
    const Hit other = rays_.closest({hit.position + rays_.lift() * hit.normal, mirrored});
    const bool free = other.kind == Hit::nothing || other.kind == Hit::ground; // the table is part of the mirrored studio
    const Vector3 mirror = free ? environment_.mirrored(mirrored) : (0.5f / pi) * (sky.irradiance * colour_of(other));
    return solid.colour * (0.8f * mirror + (0.22f / pi) * arriving);
  }
  arriving += direct(environment_.key(), hit, -ray.direction, noise, 10, 0.15f);
  arriving += direct(environment_.rim(), hit, -ray.direction, noise, 4, 0.15f);
  Vector3 colour = solid.colour;
  float coat = 0;
  if (solid.appearance == Appearance::wood) {
    colour = wood_colour(solid.colour, hit.position - solid.origin, 0.012f * length(rays_.high() - rays_.low()));
    coat = 0.35f; // a thin coat of varnish
  }
  if (solid.appearance == Appearance::glossy) coat = 1;
  const Vector3 matte = (1 / pi) * (colour * arriving);
  if (coat == 0) return matte;
  const float away = 1 + dot(ray.direction, hit.normal);
  const float sheen = coat * (0.04f + 0.5f * away * away * away * away * away) * sky.open;
  return matte + sheen * environment_.mirrored(mirrored);
}

} // namespace runner
