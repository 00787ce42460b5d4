// How neighbour lists and constraint records lie in memory on the CPU: in the order of the visits, with a few blocks of cells to a lane.
//
// Particles are visited in batches of W, one of each lane of a group; the batches of a group follow each other. For batch b and pair step t
// (offsets[b] <= t < offsets[b] + steps[b]):
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
  const int *offsets;     // the first pair step of a batch,
  const int *steps;       // how many it has,
  const int *close_steps; // and how many of these hold close pairs
  int *indices;
  float *gradients;
  float *records;
  int record_size; // fields
};

// Lists as they are found, one behind the other, in memory that stays in a thread's cache until they are interleaved. Close neighbours come first.
struct FoundLists {
  int *entries;
  std::int64_t capacity; // in entries; a list needs room for a pack behind it
  std::int64_t used, needed;
};

// What the candidate search reads and writes.
struct CpuCandidates {
  const float *x, *y, *z;
  const std::uint32_t *keys; // cell of each particle
  const int *starts;
  int size[3];
  FoundLists *lists;
  int *list_starts; // of each particle in the entries; written where the list has room
};

// From lists as they were found to lists interleaved lane by lane, the particle itself behind each list's end.
struct CpuInterleaving {
  const int *lists, *list_starts, *neighbour_counts;
  const int *ids, *active, *offsets, *steps; // as in CpuPairs
  int *indices;
};

} // namespace loam
