#include "random_definitions.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>

namespace loam::fuzz {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();

void random_rotation(Random &random, float rotation[4]) {
  const float turned[4] = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(0.1, 1)};
  const float scale = random.log_between(1e-3, 1e3); // it need not be of length 1
  for (int k = 0; k < 4; ++k) rotation[k] = scale * turned[k];
}

/* The places of a definition's numbers: everything behind its law that is not the name or a choice. */
std::vector<std::size_t> numbers_of_a_material() {
  std::vector<std::size_t> places;
  for (std::size_t at = offsetof(loam_material_def, density); at + sizeof(float) <= sizeof(loam_material_def);
       at += sizeof(float))
    if (at != offsetof(loam_material_def, constant_hardness) &&
        (at < offsetof(loam_material_def, name) ||
         at >= offsetof(loam_material_def, name) + sizeof(loam_material_def::name)))
      places.push_back(at);
  return places;
}

template <class F> void change_number(loam_material_def &def, std::size_t place, F &&change) {
  auto *bytes = reinterpret_cast<unsigned char *>(&def) + place;
  float value = 0;
  std::memcpy(&value, bytes, sizeof value);
  value = change(value);
  std::memcpy(bytes, &value, sizeof value);
}

loam_region random_region(Random &random, float r, meshes::Mesh &mesh) {
  loam_region region = {};
  const double kind = random.uniform(); // meshes take longest
  region.kind = kind < 0.35   ? std::uint32_t(LOAM_REGION_BOX)
                : kind < 0.65 ? std::uint32_t(LOAM_REGION_SPHERE)
                : kind < 0.92 ? std::uint32_t(LOAM_REGION_CYLINDER)
                              : std::uint32_t(LOAM_REGION_MESH);
  random_place(random, r, region.center, region.rotation);
  if (random.chance(0.3)) std::fill(region.rotation, region.rotation + 4, 0.0f);
  for (float &half : region.half_extents) half = r * random.log_between(0.3, 6);
  region.radius = r * random.log_between(0.3, 6);
  region.half_height = r * random.log_between(0.3, 6);
  if (region.kind == LOAM_REGION_MESH) {
    mesh = random_solid(random, r);
    region.mesh = mesh.view();
  }
  return region;
}

} // namespace

float bad_number(Random &random) {
  constexpr float numbers[] = {nan, infinity, -infinity, 3e38f, -3e38f};
  return random.pick(numbers);
}

loam_world_def random_world(Random &random) {
  loam_world_def def;
  loam_world_def_default(&def, sizeof def);
  def.backend = LOAM_BACKEND_CPU;
  for (float &g : def.gravity) g = random.chance(0.3) ? 0.0f : random.between(-20, 20);
  def.kernel_radius = random.chance(0.05) ? random.log_between(1e-6, 1e6) : random.log_between(1e-3, 1);
  def.substeps = std::uint32_t(random.log_between(1, 24));
  def.iterations = std::uint32_t(random.log_between(1, 9));
  def.solver = random.chance(0.5) ? LOAM_SOLVER_JACOBI : LOAM_SOLVER_GAUSS_SEIDEL;
  def.plasticity = random.chance(0.2) ? LOAM_PLASTICITY_SEMI_IMPLICIT : LOAM_PLASTICITY_IMPLICIT;
  if (random.chance(0.3)) def.velocity_smoothing = random.chance(0.3) ? 0.0f : random.log_between(0.1, 1e4);
  if (random.chance(0.3)) def.minimum_distance = random.chance(0.3) ? 0.0f : random.between(0, 1);
  if (random.chance(0.3)) def.gradient_cutoff = random.log_between(0.01, 1);
  def.multiplier = random.chance(0.4) ? LOAM_MULTIPLIER_SCALAR : LOAM_MULTIPLIER_PROJECTED_TENSOR;
  if (random.chance(0.2)) {
    def.sleep_speed = random.log_between(1e-4, 10);
    def.sleep_delay = random.log_between(0.01, 0.1);
  }
  if (random.chance(0.3)) def.zero_energy_stiffness = random.chance(0.3) ? 0.0f : random.log_between(0.01, 100);
  def.warm_start = random.chance(0.4) ? 1 : 0;
  def.particle_capacity = std::uint64_t(random.log_between(random.chance(0.2) ? 1 : 100, 2500));
  if (random.chance(0.1)) def.pair_capacity = std::uint64_t(random.log_between(1, 1e5));
  return def;
}

std::uint32_t law_count() {
  static const std::uint32_t count = [] {
    loam_material_def def;
    std::uint32_t law = 0;
    while (loam_material_def_default(law, &def, sizeof def) == LOAM_OK) ++law;
    return law;
  }();
  return count;
}

loam_material_def random_material(Random &random) {
  static const std::uint32_t preset_count = [] {
    std::uint32_t count = 0;
    while (loam_material_preset_name(count) != nullptr) ++count;
    return count;
  }();
  loam_material_def def;
  if (random.chance(0.3))
    loam_material_def_preset(loam_material_preset_name(random.below(preset_count)), &def, sizeof def);
  else
    loam_material_def_default(random.below(law_count()), &def, sizeof def);
  if (random.chance(0.1)) def.constant_hardness = 1;
  if (random.chance(0.3)) def.viscosity = random.log_between(1e-4, 1e6);
  if (random.chance(0.3)) def.surface_tension = random.log_between(1e-3, 1e4);
  if (random.chance(0.3)) def.vorticity_confinement = random.between(0, 1);
  if (random.chance(0.3)) def.adhesion = random.log_between(1, 1e6);
  if (random.chance(0.7)) scale_numbers(def, random);
  return def;
}

void scale_numbers(loam_material_def &def, Random &random) {
  const double share = random.chance(0.5) ? 0.1 : 0.4, factor = random.chance(0.1) ? 1e3 : 10;
  for (const std::size_t place : numbers_of_a_material())
    if (random.chance(share)) change_number(def, place, [&](float x) { return x * random.log_between(1 / factor, factor); });
}

void spoil(loam_material_def &def, Random &random) {
  if (random.chance(0.1)) {
    def.law = law_count() + random.below(3);
  } else if (random.chance(0.1)) {
    std::memset(def.name, 'x', sizeof def.name);
  } else {
    const std::vector<std::size_t> places = numbers_of_a_material();
    change_number(def, random.pick(places), [&](float x) { return random.chance(0.3) ? -x : bad_number(random); });
  }
}

void random_place(Random &random, float r, float position[3], float rotation[4]) {
  const double reach = random.chance(0.02) ? 1e5 : 8;
  for (int k = 0; k < 3; ++k) position[k] = std::clamp(r * float(random.between(-reach, reach)), -1e9f, 1e9f);
  random_rotation(random, rotation);
}

meshes::Mesh random_solid(Random &random, float r) {
  switch (random.below(4)) {
  case 0:
    return meshes::box(r * random.log_between(0.3, 8), r * random.log_between(0.3, 8), r * random.log_between(0.3, 8));
  case 1:
    return meshes::icosphere(r * random.log_between(0.5, 8), int(random.below(3)));
  case 2:
    return meshes::hourglass(r * random.between(2, 5), r * random.between(0.2, 2), 8 + random.below(8));
  default: {
    std::vector<std::pair<float, float>> profile;
    float height = 0;
    for (std::uint32_t rings = random.from(2, 6); rings > 0; --rings) {
      profile.emplace_back(r * random.log_between(0.3, 6), height);
      height += r * random.between(0.3, 4);
    }
    return meshes::revolution(profile, 3 + random.below(9));
  }
  }
}

meshes::Mesh random_flawed_mesh(Random &random, float r) {
  meshes::Mesh mesh =
      random.chance(0.3) ? meshes::sheet(r * random.between(1, 8), random.from(1, 6)) : random_solid(random, r);
  if (random.chance(0.4)) // a soup
    for (std::uint32_t n = random.from(1, 20); n > 0; --n) {
      std::uint32_t corner[3];
      for (std::uint32_t &c : corner)
        c = mesh.vertex(r * random.between(-6, 6), r * random.between(-6, 6), r * random.between(-6, 6));
      mesh.triangle(corner[0], corner[1], corner[2]);
    }
  const auto triangles = std::uint32_t(mesh.indices.size() / 3);
  const auto vertices = std::uint32_t(mesh.positions.size() / 3);
  if (random.chance(0.4)) // holes
    for (std::uint32_t n = random.from(1, 4); n > 0 && mesh.indices.size() > 3; --n)
      mesh.indices.resize(mesh.indices.size() - 3);
  for (std::uint32_t n = random.below(4); n > 0; --n) { // doubled, inside out, without area
    const std::uint32_t *of = &mesh.indices[std::size_t(3) * random.below(mesh.indices.size() / 3)];
    const std::uint32_t a = of[0], b = of[1], c = of[2];
    if (random.chance(0.3))
      mesh.triangle(a, b, c);
    else if (random.chance(0.5))
      mesh.triangle(a, c, b);
    else
      mesh.triangle(a, b, a);
  }
  if (random.chance(0.3)) // crumpled
    for (std::uint32_t n = random.from(1, triangles); n > 0; --n)
      mesh.positions[std::size_t(3) * random.below(vertices) + random.below(3)] += r * random.between(-2, 2);
  if (random.chance(0.1)) // slivers
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3) mesh.positions[i] *= random.log_between(1e-7, 1e-2);
  return mesh;
}

namespace {

/* Closed and convex. */
meshes::Mesh random_hull(Random &random, float r) {
  meshes::Mesh mesh = random.chance(0.5) ? meshes::box(1, 1, 1) : meshes::icosphere(1, int(random.below(3)));
  float scale[3];
  for (float &s : scale) s = r * random.log_between(random.chance(0.1) ? 1e-3 : 0.3, 8);
  const float slant = random.chance(0.5) ? 0 : random.between(-2, 2);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    float *x = &mesh.positions[i];
    x[0] += slant * x[1];
    for (int k = 0; k < 3; ++k) x[k] *= scale[k];
  }
  return mesh;
}

/* A solid of three balls, at times cut by the end of the grid, or a band of distances alone. */
void random_grid(Random &random, float r, loam_distance_grid &grid, std::vector<float> &values) {
  grid.spacing = std::max(1e-6f, r * random.log_between(0.1, 2));
  for (std::uint32_t &size : grid.size) size = random.from(2, 16);
  float extent[3], ball[3][4];
  for (int k = 0; k < 3; ++k) {
    extent[k] = grid.spacing * float(grid.size[k] - 1);
    grid.origin[k] = -0.5f * extent[k] + r * random.between(-1, 1);
  }
  for (auto &b : ball) {
    for (int k = 0; k < 3; ++k)
      b[k] = random.uniform() < 0.5 ? extent[k] * random.between(0.2, 0.8) : extent[k] * random.between(0, 1);
    b[3] = grid.spacing * random.between(0.5, 6);
  }
  const float band = random.chance(0.3) ? grid.spacing * random.between(1, 4) : 1e7f;
  for (std::uint32_t z = 0; z < grid.size[2]; ++z)
    for (std::uint32_t y = 0; y < grid.size[1]; ++y)
      for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
        float least = band;
        for (const auto &b : ball)
          least = std::min(least, std::hypot(grid.spacing * float(x) - b[0], grid.spacing * float(y) - b[1],
                                             grid.spacing * float(z) - b[2]) -
                                      b[3]);
        values.push_back(std::max(least, -band));
      }
  values[random.below(values.size())] = std::min(0.0f, values.front()); // at times a point that is no distance
  grid.values = values.data();
}

} // namespace

loam_collider_def random_collider(Random &random, float r, ColliderArrays &arrays) {
  loam_collider_def def;
  loam_collider_def_default(&def, sizeof def);
  random_place(random, r, def.position, def.rotation);
  if (random.chance(0.5)) {
    for (float &q : def.rotation) q = 0;
    def.rotation[3] = 1;
  }
  def.friction = random.chance(0.2) ? 0.0f : random.log_between(0.05, 100);
  def.reaction = random.chance(0.3) ? 1 : 0;
  if (random.chance(0.2)) def.restitution = random.between(0, 1);
  if (random.chance(0.2)) def.stick = random.log_between(1, 1e9);
  if (random.chance(0.2)) return def;
  def.kind = random.from(LOAM_COLLIDER_MESH, LOAM_COLLIDER_GRID);
  if (random.chance(0.3)) def.kind = LOAM_COLLIDER_MESH;
  switch (def.kind) {
  case LOAM_COLLIDER_MESH:
    arrays.mesh = random.chance(0.5) ? random_flawed_mesh(random, r) : random_solid(random, r);
    def.mesh = arrays.mesh.view();
    def.deforms = random.chance(0.6) ? 1 : 0;
    break;
  case LOAM_COLLIDER_HULL:
    arrays.mesh = random_hull(random, r);
    def.mesh = arrays.mesh.view();
    break;
  case LOAM_COLLIDER_GRID:
    random_grid(random, r, def.grid, arrays.values);
    break;
  default:
    def.radius = r * random.log_between(0.1, 8);
    def.half_height = random.chance(0.2) ? 0.0f : r * random.log_between(0.1, 8);
    for (float &half : def.half_extents) half = r * random.log_between(0.1, 8);
    break;
  }
  return def;
}

void spoil(loam_collider_def &def, Random &random, ColliderArrays &arrays) {
  meshes::Mesh &mesh = arrays.mesh;
  switch (random.below(12)) {
  case 0:
    def.position[random.below(3)] = bad_number(random);
    break;
  case 1:
    def.rotation[random.below(4)] = bad_number(random);
    break;
  case 2:
    std::fill(def.rotation, def.rotation + 4, 0.0f);
    break;
  case 3:
    def.friction = random.chance(0.5) ? -1.0f : bad_number(random);
    break;
  case 4:
    def.kind = LOAM_COLLIDER_GRID + 1 + random.below(3);
    break;
  case 5:
    (random.chance(0.3) ? def.reserved : random.chance(0.5) ? def.deforms : def.reaction) = 2;
    break;
  case 6:
    def.struct_size = random.chance(0.5) ? 4 : std::uint32_t(sizeof def) + 8;
    break;
  case 7: // every kind of primitive has one that is wrong
    def.kind = random.from(LOAM_COLLIDER_SPHERE, LOAM_COLLIDER_BOX);
    def.half_extents[random.below(3)] = def.radius = random.chance(0.5) ? 0.0f : bad_number(random);
    break;
  case 8: { // open, inside out, or dented
    def.kind = LOAM_COLLIDER_HULL;
    mesh = meshes::icosphere(1, 1);
    const std::uint32_t flaw = random.below(3);
    if (flaw == 0) mesh.indices.resize(mesh.indices.size() - 3);
    for (std::size_t i = 0; i < mesh.indices.size() && flaw == 1; i += 3) std::swap(mesh.indices[i], mesh.indices[i + 1]);
    for (std::size_t k = 0; k < 3 && flaw == 2; ++k) mesh.positions[k] *= 0.5f;
    def.mesh = mesh.view();
    break;
  }
  case 9: {
    arrays.values.clear();
    random_grid(random, 1, def.grid, arrays.values);
    def.kind = LOAM_COLLIDER_GRID;
    const std::uint32_t flaw = random.below(6);
    if (flaw == 0) arrays.values[random.below(arrays.values.size())] = bad_number(random);
    if (flaw == 1) def.grid.values = nullptr;
    if (flaw == 2) def.grid.size[random.below(3)] = random.chance(0.5) ? random.below(2) : ~0u - random.below(9);
    if (flaw == 3) def.grid.spacing = random.chance(0.5) ? 0.0f : bad_number(random);
    if (flaw == 4) def.grid.origin[random.below(3)] = bad_number(random);
    if (flaw == 5) std::fill(arrays.values.begin(), arrays.values.end(), 1.0f);
    break;
  }
  default: // flaws that no mesh may have
    def.kind = LOAM_COLLIDER_MESH;
    mesh = random_solid(random, 1);
    const std::uint32_t flaw = random.below(6);
    if (flaw == 0) mesh.positions[random.below(mesh.positions.size())] = bad_number(random);
    if (flaw == 1)
      mesh.indices[random.below(mesh.indices.size())] = std::uint32_t(mesh.positions.size() / 3) + random.below(1u << 31);
    if (flaw == 2) std::fill(mesh.positions.begin(), mesh.positions.end(), 1.0f); // all in one place
    def.mesh = mesh.view();
    if (flaw == 3) def.mesh.positions = nullptr;
    if (flaw == 4) def.mesh.indices = nullptr;
    if (flaw == 5) def.mesh.triangle_count = 0;
    break;
  }
}

loam_fill_def random_fill(Random &random, float r, RegionMeshes &meshes) {
  loam_fill_def def;
  loam_fill_def_default(&def, sizeof def);
  def.region = random_region(random, r, meshes.region);
  if (random.chance(0.2)) {
    def.cut = random_region(random, r, meshes.cut);
    for (int k = 0; k < 3; ++k) def.cut.center[k] = def.region.center[k] + r * random.between(-4, 4);
  }
  def.sampling = random.chance(0.5) ? LOAM_SAMPLING_LATTICE : LOAM_SAMPLING_POISSON_DISK;
  if (random.chance(0.3)) def.spacing = r * random.between(0.51, 1.5);
  if (random.chance(0.3)) def.jitter = random.between(0, 0.5);
  if (random.chance(0.2)) def.inset = r * random.between(0, 1);
  def.seed = random.below(1u << 31);
  if (random.chance(0.3))
    for (float &v : def.velocity) v = random.between(-1, 1) * random.log_between(0.01, 100);
  return def;
}

void spoil(loam_fill_def &def, Random &random, RegionMeshes &meshes) {
  switch (random.below(10)) {
  case 0:
    def.region.center[random.below(3)] = bad_number(random);
    break;
  case 1:
    def.region.rotation[random.below(4)] = bad_number(random);
    break;
  case 2:
    def.region.kind = random.chance(0.5) ? std::uint32_t(LOAM_REGION_NONE) : LOAM_REGION_MESH + 1 + random.below(3);
    break;
  case 3: // every kind of primitive has one that is wrong
    def.region.kind = random.from(LOAM_REGION_BOX, LOAM_REGION_CYLINDER);
    def.region.half_extents[random.below(3)] = def.region.radius = random.chance(0.5) ? 0.0f : bad_number(random);
    break;
  case 4:
    def.jitter = random.chance(0.5) ? 0.51f : bad_number(random);
    break;
  case 5:
    def.inset = random.chance(0.5) ? -1.0f : bad_number(random);
    break;
  case 6:
    def.velocity[random.below(3)] = bad_number(random);
    break;
  case 7:
    def.spacing = random.chance(0.5) ? 1e-9f : bad_number(random);
    break;
  case 8:
    def.sampling = LOAM_SAMPLING_LATTICE + 1 + random.below(3);
    break;
  default: // open
    def.region.kind = LOAM_REGION_MESH;
    meshes.region = meshes::sheet(1, random.from(1, 4));
    def.region.mesh = meshes.region.view();
    break;
  }
}

loam_particles_def random_particles(Random &random, float r, ParticleArrays &arrays) {
  loam_particles_def def;
  loam_particles_def_default(&def, sizeof def);
  const float extent = r * random.log_between(0.5, 12);
  const bool coincident = random.chance(0.15);
  const float shape[3] = {extent, random.chance(0.2) ? 0.0f : extent, random.chance(0.3) ? 0.0f : extent};
  float centre[3], unused[4];
  random_place(random, r, centre, unused);
  const float speed = random.chance(0.4) ? 0.0f : random.chance(0.05) ? 1e9f : random.log_between(0.01, 100);
  for (std::uint32_t n = std::uint32_t(random.log_between(1, 300)); n > 0; --n) {
    const bool again = coincident && !arrays.positions.empty() && random.chance(0.8);
    for (int k = 0; k < 3; ++k) {
      arrays.positions.push_back(again ? arrays.positions[arrays.positions.size() - 3]
                                       : centre[k] + shape[k] * random.between(-0.5, 0.5));
      arrays.velocities.push_back(speed * random.between(-1, 1));
    }
  }
  def.count = arrays.positions.size() / 3;
  def.positions = arrays.positions.data();
  def.velocities = random.chance(0.3) ? nullptr : arrays.velocities.data();
  if (random.chance(0.3)) def.volume = r * r * r * random.log_between(0.05, 20);
  def.pinned = random.chance(0.15) ? 1 : 0;
  return def;
}

void spoil(loam_particles_def &def, Random &random, ParticleArrays &arrays) {
  switch (random.below(7)) {
  case 0:
    arrays.positions[random.below(arrays.positions.size())] = bad_number(random);
    break;
  case 1:
    def.velocities = arrays.velocities.data();
    arrays.velocities[random.below(arrays.velocities.size())] = bad_number(random);
    break;
  case 2:
    def.pinned = 2 + random.below(9);
    break;
  case 3:
    def.volume = random.chance(0.5) ? -1.0f : bad_number(random);
    break;
  case 4:
    def.count = random.chance(0.5) ? ~std::uint64_t(0) / random.from(1, 16) : std::uint64_t(1) << random.from(29, 63);
    break;
  case 5:
    def.positions = nullptr;
    break;
  default:
    def.reserved = 1;
    break;
  }
}

} // namespace loam::fuzz
