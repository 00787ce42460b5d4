#include "scenes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace loam::scenes {

namespace {

constexpr Plane ground(float friction) { return {{0, 0, 0}, {0, 1, 0}, friction}; }

loam_material_def material(std::uint32_t law, const char *name, float density, float youngs_modulus) {
  loam_material_def def;
  std::memset(&def, 0, sizeof def);
  def.struct_size = sizeof def;
  def.law = law;
  def.density = density;
  def.youngs_modulus = youngs_modulus;
  def.poissons_ratio = 0.3f;
  def.yield_stress = 5e3f;
  def.friction_angle = std::numbers::pi_v<float> / 6;
  std::strncpy(def.name, name, sizeof def.name - 1);
  return def;
}

/* Uniform numbers by SplitMix64 (Steele, Lea and Flood 2014): the standard library's distributions differ between machines. */
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  float between(float low, float high) {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t bits = state_;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    bits ^= bits >> 31;
    return low + (high - low) * (float(bits >> 40) * 0x1p-24f);
  }

private:
  std::uint64_t state_;
};

/* Puts particles at lattice points, given as multiples of the spacing. */
class Filler {
public:
  Filler(Scene &scene, const Lattice &lattice) : scene_(scene), lattice_(lattice), random_(lattice.seed) {
    scene_.spacing = lattice.spacing;
  }
  /* What stands against a plane is not moved along its normal: it would start inside the plane's stand-off. */
  void put(float x, float y, float z, bool jitter_y, bool jitter_x = true, bool jitter_z = true) {
    const float j = lattice_.jitter;
    const float offset[3] = {random_.between(-j, j), random_.between(-j, j), random_.between(-j, j)};
    scene_.positions.push_back((x + (jitter_x ? offset[0] : 0)) * lattice_.spacing);
    scene_.positions.push_back((y + (jitter_y ? offset[1] : 0)) * lattice_.spacing);
    scene_.positions.push_back((z + (jitter_z ? offset[2] : 0)) * lattice_.spacing);
  }

private:
  Scene &scene_;
  Lattice lattice_;
  Random random_;
};

} // namespace

loam_material_def sand(float friction_angle_degrees, float youngs_modulus) {
  loam_material_def def = material(LOAM_LAW_DRUCKER_PRAGER, "sand", 1600, youngs_modulus);
  def.friction_angle = friction_angle_degrees * std::numbers::pi_v<float> / 180;
  return def;
}

loam_material_def plasticine(float yield_stress, float youngs_modulus) {
  loam_material_def def = material(LOAM_LAW_VON_MISES, "plasticine", 1500, youngs_modulus);
  def.yield_stress = yield_stress;
  return def;
}

loam_material_def rubber(float youngs_modulus) { return material(LOAM_LAW_ELASTIC, "rubber", 1000, youngs_modulus); }

Scene axisymmetric_column(const loam_material_def &material, int radius, float aspect, float ground_friction,
                          const Lattice &lattice) {
  Scene scene;
  scene.material = material;
  scene.length = float(radius) * lattice.spacing;
  scene.planes = {ground(ground_friction)};
  Filler filler(scene, lattice);
  const int layers = int(std::lround(aspect * float(radius)));
  for (int x = -radius; x < radius; ++x)
    for (int y = 0; y < layers; ++y)
      for (int z = -radius; z < radius; ++z)
        if ((2 * x + 1) * (2 * x + 1) + (2 * z + 1) * (2 * z + 1) < 4 * radius * radius)
          filler.put(float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f, y > 0);
  return scene;
}

Scene slab(const loam_material_def &material, int length, float aspect, int depth, float ground_friction,
           const Lattice &lattice) {
  Scene scene;
  scene.material = material;
  scene.length = float(length) * lattice.spacing;
  scene.planar = true;
  const float far_wall = float(depth) * lattice.spacing;
  scene.planes = {
      ground(ground_friction), {{0, 0, 0}, {1, 0, 0}, 0}, {{0, 0, 0}, {0, 0, 1}, 0}, {{0, 0, far_wall}, {0, 0, -1}, 0}};
  Filler filler(scene, lattice);
  const int layers = int(std::lround(aspect * float(length)));
  for (int x = 0; x < length; ++x)
    for (int y = 0; y < layers; ++y)
      for (int z = 0; z < depth; ++z)
        filler.put(float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f, y > 0, x > 0, z > 0 && z + 1 < depth);
  return scene;
}

Scene drop_block(const loam_material_def &material, int edge, float height, float speed, const Lattice &lattice) {
  Scene scene;
  scene.material = material;
  scene.length = float(edge) * lattice.spacing / 2;
  scene.planes = {ground(0.6f)};
  Filler filler(scene, lattice);
  const float half = float(edge) / 2, lift = height / lattice.spacing;
  for (int x = 0; x < edge; ++x)
    for (int y = 0; y < edge; ++y)
      for (int z = 0; z < edge; ++z)
        filler.put(float(x) + 0.5f - half, float(y) + 0.5f + lift, float(z) + 0.5f - half, y > 0 || height > 0);
  for (std::size_t particle = 0; particle < scene.count(); ++particle)
    scene.velocities.insert(scene.velocities.end(), {0, -speed, 0});
  return scene;
}

Scene jittered_block(const loam_material_def &material, std::size_t count, float shear_rate, const Lattice &lattice) {
  Scene scene;
  scene.material = material;
  scene.planes = {ground(0.6f)};
  Filler filler(scene, lattice);
  const int edge = int(std::ceil(std::cbrt(double(count)) - 1e-6));
  scene.length = float(edge) * lattice.spacing / 2;
  for (int y = 0; scene.count() < count; ++y)
    for (int x = 0; x < edge && scene.count() < count; ++x)
      for (int z = 0; z < edge && scene.count() < count; ++z)
        filler.put(float(x) + 0.5f - float(edge) / 2, float(y) + 0.5f, float(z) + 0.5f - float(edge) / 2, y > 0);
  for (std::size_t particle = 0; particle < count; ++particle)
    scene.velocities.insert(scene.velocities.end(), {shear_rate * scene.positions[3 * particle + 1], 0, 0});
  return scene;
}

Scene resting_pile(const loam_material_def &material, int radius, float slope_degrees, const Lattice &lattice) {
  Scene scene;
  scene.material = material;
  scene.length = float(radius) * lattice.spacing;
  scene.planes = {ground(1)};
  Filler filler(scene, lattice);
  const float slope = std::tan(slope_degrees * std::numbers::pi_v<float> / 180);
  for (int y = 0; float(y) < float(radius) * slope; ++y)
    for (int x = -radius; x < radius; ++x)
      for (int z = -radius; z < radius; ++z) {
        const float centre_x = float(x) + 0.5f, centre_z = float(z) + 0.5f;
        if (float(y) + 0.5f < slope * (float(radius) - std::hypot(centre_x, centre_z)))
          filler.put(centre_x, float(y) + 0.5f, centre_z, y > 0);
      }
  return scene;
}

double run_out(const std::vector<float> &positions, const Scene &scene, double share) {
  std::vector<double> distances;
  for (std::size_t k = 0; k < positions.size(); k += 3)
    distances.push_back(scene.planar ? double(positions[k]) : std::hypot(double(positions[k]), double(positions[k + 2])));
  if (distances.empty()) return 0;
  const std::size_t rank = std::min(distances.size() - 1, std::size_t(share * double(distances.size())));
  std::nth_element(distances.begin(), distances.begin() + std::ptrdiff_t(rank), distances.end());
  return distances[rank] / double(scene.length) - 1;
}

} // namespace loam::scenes
