/* Water in a tank, and a dam that breaks against what was measured of one. */
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/course.h"

namespace loam::test {

/* A block of water on a lattice in the corner of a tank, `width` x `height` x `depth` particles of one size; the tank's walls have no friction. */
struct Block {
  int width, height, depth, length; // of the tank: `length`, in particles
  float compression = 0;            // the share of its volume that is missing at the start
};

class Tank {
public:
  static constexpr float radius = 0.01f; // of the kernel
  Tank(const Block &block, std::uint32_t solver, std::uint32_t substeps, std::uint32_t law = LOAM_LAW_FLUID,
       const Course &course = {})
      : water_(make_water(block, law)) {
    const float d = pitch(block), x = float(block.length) * d, z = float(block.depth) * d;
    water_.planes = {{{0, 0, 0}, {0, 1, 0}, 0},
                     {{0, 0, 0}, {1, 0, 0}, 0},
                     {{x, 0, 0}, {-1, 0, 0}, 0},
                     {{0, 0, 0}, {0, 0, 1}, 0},
                     {{0, 0, z}, {0, 0, -1}, 0}};
    loam_world_def def = scenes::world_def(water_);
    def.solver = solver;
    def.substeps = substeps;
    course.change(def);
    world = scenes::World(def, water_);
  }
  std::vector<float> sorted(std::size_t axis) const {
    const scenes::Snapshot now = world.snapshot();
    std::vector<float> values;
    for (std::size_t i = 0; i < now.count(); ++i) values.push_back(now.positions[3 * i + axis]);
    std::sort(values.begin(), values.end());
    return values;
  }
  double mean_height() const {
    double sum = 0;
    const std::vector<float> y = sorted(1);
    for (const float value : y) sum += double(value);
    return sum / double(y.size());
  }
  /* Kinetic and potential energy over the weight, in metres. */
  double energy() const {
    const double mass = double(water_.material.density) * double(water_.volume()) * double(water_.count());
    return world.statistics().kinetic_energy / (mass * 9.81) + mean_height();
  }
  /* That which such a share of the particles under three quarters of the height does not exceed. */
  double density(double share) const {
    std::vector<float> densities;
    const double below = 0.75 * 2 * mean_height();
    for (const Drop &drop : drops())
      if (double(drop.height) < below) densities.push_back(drop.density);
    std::sort(densities.begin(), densities.end());
    return double(densities[std::size_t(share * double(densities.size() - 1))]);
  }
  struct Drop {
    float height, density, pressure;
  };
  std::vector<Drop> drops() const {
    loam_particle_view view = {};
    view.struct_size = sizeof view;
    scenes::require(loam_particles_map(world.get(), &view), "map");
    std::vector<Drop> values;
    for (std::uint64_t i = 0; i < view.count; ++i)
      values.push_back({view.positions[4 * i + 1], view.densities[i], view.histories != nullptr ? view.histories[i] : 0});
    scenes::require(loam_particles_unmap(world.get()), "unmap");
    return values;
  }

private:
  static float pitch(const Block &block) { return radius * std::cbrt(1 - block.compression); }
  static scenes::Scene make_water(const Block &block, std::uint32_t law) {
    scenes::Scene scene;
    scenes::require(loam_material_def_default(law, &scene.material, sizeof scene.material), "default");
    scene.spacing = radius;
    const float d = pitch(block);
    for (int x = 0; x < block.width; ++x)
      for (int y = 0; y < block.height; ++y)
        for (int z = 0; z < block.depth; ++z) {
          const float shift = 0.1f * d * float((7 * x + 13 * y + 17 * z) % 5 - 2) / 2; // no lattice stays a lattice
          scene.positions.insert(scene.positions.end(), {(float(x) + 0.5f) * d + shift, (float(y) + 0.5f) * d - shift,
                                                         (float(z) + 0.5f) * d + shift});
        }
    return scene;
  }
  scenes::Scene water_;

public:
  scenes::World world{scenes::world_def(water_)};
};

/* Where the front Z, in widths of the column, is at the time T = t sqrt(2 g / a). */
using Front = std::vector<std::pair<double, double>>;

/* A column of n^2 = 2 in a tank that is five times as wide. */
inline Front break_dam(std::uint32_t law, std::uint32_t solver, const Course &course = {}) {
  constexpr int width = 12;
  Tank tank({width, 2 * width, 5, 5 * width}, solver, 2, law, course);
  constexpr double r = double(Tank::radius), a = width * r, step = 0.004;
  Front front;
  for (int k = 1; k <= 62; ++k) {
    course.step(tank.world, float(step));
    const std::vector<float> x = tank.sorted(0);
    front.emplace_back(k * step * std::sqrt(2 * 9.81 / a),
                       (double(x[x.size() - 8]) + 0.5 * r) / a); // no single drops
  }
  return front;
}
inline double time_of(const Front &front, double z) {
  for (std::size_t k = 1; k < front.size(); ++k)
    if (front[k].second >= z) {
      const auto &[t0, z0] = front[k - 1];
      const auto &[t1, z1] = front[k];
      return t0 + (t1 - t0) * (z - z0) / (z1 - z0);
    }
  return 1e9;
}
inline double front_at(const Front &front, double t) {
  for (std::size_t k = 1; k < front.size(); ++k)
    if (front[k].first >= t) {
      const auto &[t0, z0] = front[k - 1];
      const auto &[t1, z1] = front[k];
      return z0 + (z1 - z0) * (t - t0) / (t1 - t0);
    }
  return front.back().second;
}

/* Martin and Moyce 1952, n^2 = 2. The experiment's zero of time is not known (a gate opens; transcriptions differ), so time counts from when the front
 * passes the third point. */
inline const Front measured = {{1.19, 1.44}, {1.43, 1.67}, {1.63, 1.89}, {1.83, 2.11},
                               {1.98, 2.33}, {2.20, 2.56}, {2.32, 2.78}, {2.51, 3.00}};
/* Koshizuka and Oka 1996. */
inline const Front measured_again = {{1.537, 1.892}, {2.323, 2.615}, {3.096, 3.624}};
inline double greatest_error(const Front &front, const Front &points) {
  const double shift = points[0].first - time_of(front, points[0].second);
  double error = 0;
  for (const auto &[t, z] : points) error = std::max(error, std::abs(front_at(front, t - shift) / z - 1));
  return error;
}

} // namespace loam::test
