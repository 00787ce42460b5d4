// How neighbour lists and constraint records lie in memory on the CPU: in the order of the visits, with a few blocks of cells to a lane.
//
// Particles are visited in batches of W, one of each lane of a group; the batches of a group follow each other. For batch b and pair step t
// (offsets[b] <= t < offsets[b + 1]):
//
//   index[t][W]         the neighbour of each lane; the particle itself where a lane's list has ended (with gradient 0)
//   gradient[t][3][W]
//   record[b][field][W]
//
// Lanes run from long to short, so those in use of a batch are its first active[b]. The others repeat a particle of the same lane, or a spare row that
// belongs to no particle where a lane has no block: what they do is harmless, and nothing of it is kept.
#pragma once

#include <cstdint>

#include "math/vector.h"

namespace loam {

struct CpuPairs {
  Row *velocities;
  const int *ids; // [batch][W]: the particle of each lane
  const int *active;
  const int *offsets;
  const int *close_steps;
  int *indices;
  float *gradients;
  float *records;
  int record_size; // fields
};

// What the candidate search reads and writes.
struct CpuCandidates {
  const float *x, *y, *z;
  const std::uint32_t *keys; // cell of each particle
  const int *starts;
  int size[3];
  // Filling only. Lists are first written in two pieces each, where the gradients will be, which take three times as much room: the far neighbours of a
  // batch's lane l at lists + 3 * (W * offsets[batch] + l * steps of the batch), the close ones 2 * steps behind.
  const int *slots; // batch * W + lane of each particle
  const int *offsets;
  int *lists;
};

} // namespace loam
