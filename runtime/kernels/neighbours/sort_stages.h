// The per-particle stages of the sort by cell: keys, the move of all particle data into the new order, and the table of cells.
#pragma once

#include <cstdint>

#include "kernels/neighbours/cell_grid.h"

namespace loam {

// The arrays that make up the particles. `histories` is null where no law has one, `drifts` where no matter resists zero-energy modes, `free_distances`
// where there is no mesh.
struct ParticleArrays {
  Row *positions;  // x, y, z, true volume
  Row *velocities; // x, y, z, inverse mass
  float *strains;  // 6 a particle
  float *histories;
  float *drifts;       // 3 a particle
  float *log_volumes;  // log of the true volume change
  float *rest_volumes; // V0
  std::uint32_t *ids;
  std::uint32_t *materials;
  float *free_distances;          // see kernels/contact/free_distance.h; no part of the state
  float *rests;                   // see kernels/integration/sleep.h; null where nothing may sleep
  float *ages = nullptr;          // s; while something asks
  float *displacements = nullptr; // multipliers, see kernels/fluid/density_constraint.h; while there is fluid
  // See kernels/inelastic/warm_start.h; null without one, and for the sort, which moves them by themselves.
  float *stresses = nullptr;        // 6 a particle
  float *answered_drifts = nullptr; // 3 a particle, where there are drifts
};

LOAM_FN void move_particle(const ParticleArrays &from, long j, const ParticleArrays &to, long i) {
  to.positions[i] = from.positions[j];
  to.velocities[i] = from.velocities[j];
  for (int k = 0; k < 6; ++k) to.strains[6 * i + k] = from.strains[6 * j + k];
  if (to.histories != nullptr) to.histories[i] = from.histories[j];
  if (to.drifts != nullptr)
    for (int k = 0; k < 3; ++k) to.drifts[3 * i + k] = from.drifts[3 * j + k];
  to.log_volumes[i] = from.log_volumes[j];
  to.rest_volumes[i] = from.rest_volumes[j];
  to.ids[i] = from.ids[j];
  to.materials[i] = from.materials[j];
  if (to.free_distances != nullptr) to.free_distances[i] = from.free_distances[j];
  if (to.rests != nullptr) to.rests[i] = from.rests[j];
  if (to.ages != nullptr) to.ages[i] = from.ages[j];
  if (to.displacements != nullptr) to.displacements[i] = from.displacements[j];
  if (to.stresses != nullptr)
    for (int k = 0; k < 6; ++k) to.stresses[6 * i + k] = from.stresses[6 * j + k];
  if (to.answered_drifts != nullptr)
    for (int k = 0; k < 3; ++k) to.answered_drifts[3 * i + k] = from.answered_drifts[3 * j + k];
}

struct AssignCells {
  CellGrid grid;
  const Row *positions;
  std::uint32_t *keys;
  std::uint32_t *order;
  LOAM_FN void operator()(int i) const {
    keys[i] = static_cast<std::uint32_t>(grid.index(xyz(positions[i])));
    order[i] = static_cast<std::uint32_t>(i);
  }
};

struct MoveParticles {
  ParticleArrays from, to;
  const std::uint32_t *order;
  float *x, *y, *z; // coordinates once more, each by itself, for the candidate search
  LOAM_FN void operator()(int i) const {
    const std::uint32_t j = order[i];
    const Row position = from.positions[j];
    x[i] = position.x;
    y[i] = position.y;
    z[i] = position.z;
    move_particle(from, static_cast<long>(j), to, i);
  }
};

// Of an array that has no second copy: it takes the place of another's.
template <int Stride> struct MoveValues {
  const float *from;
  float *to;
  const std::uint32_t *order;
  LOAM_FN void operator()(int i) const {
    for (int k = 0; k < Stride; ++k) to[Stride * static_cast<long>(i) + k] = from[Stride * static_cast<long>(order[i]) + k];
  }
};

// What forces and the search for contacts have changed since the sort, back from the other copy.
struct RestoreMotion {
  const Row *velocities;
  const float *free_distances; // null where there are none
  Row *restored_velocities;
  float *restored_distances;
  const std::uint32_t *order;
  LOAM_FN void operator()(int i) const {
    restored_velocities[i] = velocities[order[i]];
    if (free_distances != nullptr) restored_distances[i] = free_distances[order[i]];
  }
};

// starts[c] is the first particle whose cell is c or later. Particle i writes the entries between its predecessor's cell and its own.
struct MarkCells {
  const std::uint32_t *keys; // sorted
  int *starts;               // cell_count + 1 entries
  int particle_count, cell_count;
  LOAM_FN void operator()(int i) const {
    const int own = static_cast<int>(keys[i]);
    const int before = i == 0 ? -1 : static_cast<int>(keys[i - 1]);
    for (int c = before + 1; c <= own; ++c) starts[c] = i;
    if (i == particle_count - 1)
      for (int c = own + 1; c <= cell_count; ++c) starts[c] = particle_count;
  }
};

} // namespace loam
