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

loam_field_def random_field(Random &random, float r) {
  loam_field_def def;
  loam_field_def_default(&def, sizeof def);
  def.kind = random.below(LOAM_FIELD_BLAST + 1);
  float unused[4];
  random_place(random, r, def.position, unused);
  for (float &v : def.velocity) v = std::clamp(r * random.between(-100, 100), -1e6f, 1e6f);
  def.rate = random.log_between(0.01, 1e5);
  def.strength = std::min(1e12f, r * r * r * random.log_between(0.1, 1e5)) * (random.chance(0.3) ? -1.0f : 1.0f);
  def.softening = r * random.log_between(0.02, 10);
  def.speed = std::min(1e6f, r * random.log_between(0.1, 1000)) * (random.chance(0.3) ? -1.0f : 1.0f);
  def.radius = r * random.log_between(0.5, 20);
  if (def.kind == LOAM_FIELD_WIND && random.chance(0.5)) def.radius = 0;
  if (random.chance(0.7)) def.time = random.between(0, 0.1);
  return def;
}

void spoil(loam_field_def &def, Random &random) {
  switch (random.below(6)) {
  case 0:
    def.position[random.below(3)] = bad_number(random);
    break;
  case 1:
    def.velocity[random.below(3)] = bad_number(random);
    break;
  case 2:
    def.kind = LOAM_FIELD_BLAST + 1 + random.below(3);
    break;
  case 3: // every kind has a number that is wrong
    def.rate = def.softening = random.chance(0.5) ? 0.0f : bad_number(random);
    if (def.kind == LOAM_FIELD_BLAST) def.radius = 0;
    break;
  case 4:
    def.time = random.chance(0.5) ? -1.0f : bad_number(random);
    break;
  default:
    def.radius = random.chance(0.5) ? -1.0f : bad_number(random);
    break;
  }
}

loam_killer_def random_killer(Random &random, float r) {
  loam_killer_def def;
  loam_killer_def_default(&def, sizeof def);
  def.kind = random.below(LOAM_KILLER_AGE + 1);
  random_place(random, r, def.position, def.rotation);
  for (float &half : def.half_extents) half = r * random.log_between(0.5, 5);
  def.radius = r * random.log_between(0.5, 5);
  def.age = random.log_between(0.01, 1);
  if (random.chance(0.1)) {
    def.outside = 1;
    def.radius *= 10;
    for (float &half : def.half_extents) half *= 10;
  }
  return def;
}

void spoil(loam_killer_def &def, Random &random) {
  switch (random.below(6)) {
  case 0:
    def.position[random.below(3)] = bad_number(random);
    break;
  case 1:
    std::fill(def.rotation, def.rotation + 4, random.chance(0.5) ? 0.0f : bad_number(random));
    break;
  case 2:
    def.kind = LOAM_KILLER_AGE + 1 + random.below(3);
    break;
  case 3: // every kind has a number that is wrong
    def.half_extents[random.below(3)] = def.radius = def.age = random.chance(0.5) ? 0.0f : bad_number(random);
    break;
  case 4:
    def.outside = 2 + random.below(9);
    break;
  default:
    def.reserved = 1;
    break;
  }
}

} // namespace loam::fuzz
