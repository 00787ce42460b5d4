/* Bodies on a lattice for experiments with closed forms: what they are made of, what holds them, and the stress within. */
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "support/scenes.h"
#include "support/tensors.h"

namespace loam::test {

inline constexpr double pi = 3.14159265358979323846;

/* Lattice points with disorder. Along an axis that is `flush`, the outermost layers are not moved along it: they lie against walls. */
struct Points {
  float spacing = 0.01f, jitter = 0.12f;
  unsigned seed = 1;
  bool flush[3] = {false, false, false};

  /* Points (i + 1/2) spacing with first <= i < last along each axis. */
  std::vector<float> box(const int (&first)[3], const int (&last)[3]) const {
    RandomTensors random(seed);
    std::vector<float> points;
    for (int i = first[0]; i < last[0]; ++i)
      for (int j = first[1]; j < last[1]; ++j)
        for (int k = first[2]; k < last[2]; ++k) {
          const int index[3] = {i, j, k};
          for (int axis = 0; axis < 3; ++axis) {
            const bool outermost = index[axis] == first[axis] || index[axis] == last[axis] - 1;
            const double offset = random.between(-double(jitter), double(jitter));
            points.push_back(spacing * float(index[axis] + 0.5 + (flush[axis] && outermost ? 0 : offset)));
          }
        }
    return points;
  }
};

/* A scene of solids in a world: free particles first, then held ones, which keep their velocity. */
class Solid {
public:
  scenes::Scene scene;     // the free particles
  std::vector<float> held; // x, y, z
  float held_velocity[3] = {0, 0, 0};
  loam_world_def def;

  Solid(const loam_material_def &material, std::vector<float> points, float spacing = 0.01f) {
    scene.material = material;
    scene.spacing = spacing;
    scene.positions = std::move(points);
    def = scenes::world_def(scene);
    for (float &component : def.gravity) component = 0;
  }

  scenes::World make() {
    def.particle_capacity = scene.count() + held.size() / 3;
    scenes::World world(def);
    const loam_material_id material = world.add(scene);
    if (held.empty()) return world;
    loam_particles_def more;
    scenes::require(loam_particles_def_default(&more, sizeof more), "loam_particles_def_default");
    more.material = material;
    more.count = held.size() / 3;
    more.positions = held.data();
    more.volume = scene.volume();
    std::vector<float> velocities;
    for (std::size_t i = 0; i < held.size(); ++i) velocities.push_back(held_velocity[i % 3]);
    more.velocities = velocities.data();
    more.pinned = 1;
    scenes::require(loam_particles_add(world.get(), &more, nullptr), "loam_particles_add");
    return world;
  }
};

/* The Kirchhoff stress of a particle, in Pa. */
inline Matrix kirchhoff_stress(const loam_material_def &material, const scenes::Snapshot &now, std::size_t i) {
  const float *s = &now.strains[6 * i];
  const Matrix e =
      apply(widen(Sym3<float>{s[0], s[1], s[2], s[3], s[4], s[5]}), [](double x) { return 0.5 * std::log1p(x); });
  const double E = double(material.youngs_modulus), nu = double(material.poissons_ratio);
  return E / (1 + nu) * e + E * nu / ((1 + nu) * (1 - 2 * nu)) * e.trace() * Matrix::Identity();
}

/* The velocity gradient around a particle by the method's definition, in double precision, from a snapshot. */
inline Matrix velocity_gradient(const scenes::Snapshot &now, std::size_t p, double radius) {
  Matrix moment = Matrix::Zero(), sum = Matrix::Zero();
  const auto at = [](const std::vector<float> &values, std::size_t i) {
    return Vector(double(values[3 * i]), double(values[3 * i + 1]), double(values[3 * i + 2]));
  };
  for (std::size_t b = 0; b < now.count(); ++b) {
    const Vector d = at(now.positions, b) - at(now.positions, p);
    const double q = d.norm() / radius;
    if (b == p || q >= 2) continue;
    const Vector g = double(now.volumes[b]) * std::pow(1 - q / 2, 3) * d; // Wendland's C2 kernel, but for a factor
    moment += g * d.transpose();
    sum += (at(now.velocities, b) - at(now.velocities, p)) * g.transpose();
  }
  return sum * moment.inverse();
}

} // namespace loam::test
