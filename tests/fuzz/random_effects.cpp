#include <algorithm>

#include "random_definitions.h"

namespace loam::fuzz {

loam_emitter_def random_emitter(Random &random, float r, meshes::Mesh &mesh) {
  loam_emitter_def def;
  loam_emitter_def_default(&def, sizeof def);
  random_place(random, r, def.position, def.rotation);
  for (float &component : def.direction) component = random.between(-1, 1);
  def.direction[1] -= 1.5f; // never of length 0
  if (random.chance(0.3)) {
    def.nozzle = LOAM_NOZZLE_MESH;
    mesh = random.chance(0.5) ? random_flawed_mesh(random, r) : random_solid(random, r);
    def.mesh = mesh.view();
    if (random.chance(0.5)) std::fill(def.rotation, def.rotation + 4, 0.0f);
  }
  def.radius = r * random.between(0.8, 3);
  def.speed = std::min(1e4f, r * random.log_between(0.5, 300));
  // At most what the opening carries, of a disc.
  if (random.chance(0.3)) def.flow = random.between(0.05, 0.9) * 3.14f * def.radius * def.radius * def.speed;
  if (random.chance(0.3)) def.spacing = r * random.between(0.51, 1.5);
  if (random.chance(0.3)) def.jitter = random.between(0, 0.5);
  if (random.chance(0.3)) def.velocity_jitter = random.between(0, 1) * def.speed;
  if (random.chance(0.3)) def.start = random.between(0, 0.1);
  if (random.chance(0.3)) def.stop = def.start + random.between(0.01, 0.2);
  def.seed = random.below(1u << 31);
  def.when_full = random.chance(0.7) ? LOAM_FULL_DROP : LOAM_FULL_TELL;
  return def;
}

void spoil(loam_emitter_def &def, Random &random) {
  switch (random.below(9)) {
  case 0:
    def.position[random.below(3)] = bad_number(random);
    break;
  case 1:
    std::fill(def.direction, def.direction + 3, random.chance(0.5) ? 0.0f : bad_number(random));
    break;
  case 2:
    def.nozzle = LOAM_NOZZLE_MESH + 1 + random.below(3);
    break;
  case 3:
    def.speed = random.chance(0.5) ? 0.0f : bad_number(random);
    break;
  case 4:
    def.nozzle = LOAM_NOZZLE_DISC;
    def.radius = random.chance(0.5) ? 0.0f : bad_number(random);
    break;
  case 5:
    def.flow = random.chance(0.5) ? -1.0f : bad_number(random);
    break;
  case 6:
    def.jitter = random.chance(0.5) ? 0.6f : bad_number(random);
    break;
  case 7:
    def.start = 2;
    def.stop = random.chance(0.5) ? 1.0f : bad_number(random);
    break;
  default:
    def.when_full = LOAM_FULL_DROP + 1 + random.below(9);
    break;
  }
}

} // namespace loam::fuzz
