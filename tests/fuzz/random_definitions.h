/* Random definitions of everything that a world holds, within the ranges of the public headers but for what says otherwise. Lengths are in units of
 * the world's kernel radius r, so that what is made meets. */
#pragma once

#include <string>
#include <vector>

#include <loam/loam.h>

#include "random.h"
#include "support/meshes.h"

namespace loam::fuzz {

/* NaN, infinities, huge numbers and a negative one: outside of every range. */
float bad_number(Random &random);

/* On the CPU, without hooks. */
loam_world_def random_world(Random &random);

/* Of any law or preset that the library knows, some numbers scaled. Combinations may be out of range. */
loam_material_def random_material(Random &random);
void scale_numbers(loam_material_def &def, Random &random);
std::uint32_t law_count();
/* One of the definition's numbers is replaced. Laws ignore what belongs to others, so the result may still be valid. */
void spoil(loam_material_def &def, Random &random);

void random_place(Random &random, float r, float position[3], float rotation[4]);

/* Closed. */
meshes::Mesh random_solid(Random &random, float r);
/* Open, crumpled, doubled, inside out, partly without area: still with a usable triangle. */
meshes::Mesh random_flawed_mesh(Random &random, float r);

/* Of any kind. `arrays` receives what the definition points to. */
struct ColliderArrays {
  meshes::Mesh mesh;
  std::vector<float> values;
};
loam_collider_def random_collider(Random &random, float r, ColliderArrays &arrays);
void spoil(loam_collider_def &def, Random &random, ColliderArrays &arrays);

struct RegionMeshes {
  meshes::Mesh region, cut;
};
/* Without the material. It may be that nothing is left to fill, or too much. */
loam_fill_def random_fill(Random &random, float r, RegionMeshes &meshes);
void spoil(loam_fill_def &def, Random &random, RegionMeshes &meshes);

struct ParticleArrays {
  std::vector<float> positions, velocities;
};
/* A cloud, a line, a sheet, pairs in one place; without the material. */
loam_particles_def random_particles(Random &random, float r, ParticleArrays &arrays);
void spoil(loam_particles_def &def, Random &random, ParticleArrays &arrays);

/* Without the material. A layer may have more particles than the world has room for. */
loam_emitter_def random_emitter(Random &random, float r, meshes::Mesh &mesh);
void spoil(loam_emitter_def &def, Random &random);
loam_field_def random_field(Random &random, float r);
void spoil(loam_field_def &def, Random &random);
/* Of all materials. */
loam_killer_def random_killer(Random &random, float r);
void spoil(loam_killer_def &def, Random &random);

} // namespace loam::fuzz
