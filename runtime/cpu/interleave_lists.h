// Interleaving neighbour lists, four steps of all lanes at a time. Written one by one, each entry would touch a cache line of its own.
#pragma once

#include "cpu/cpu_views.h"
#if defined(LOAM_PORTABLE_KERNELS)
#include "math/pack_portable.h"
#else
#include "math/pack.h"
#endif

namespace loam::LOAM_INSTRUCTION_SET {

LOAM_FN void interleave_lists(const CpuInterleaving &d, int first_batch, int last_batch) {
  constexpr int W = Pack::width;
  for (int batch = first_batch; batch < last_batch; ++batch) {
    const int *const ids = d.ids + static_cast<long>(batch) * W;
    const int *lists[W];
    alignas(64) float lengths[W];
    for (int lane = 0; lane < W; ++lane) {
      const bool idle = lane >= d.active[batch];
      lists[lane] = idle ? d.lists : d.lists + d.list_starts[ids[lane]];
      lengths[lane] = idle ? 0.0f : static_cast<float>(d.neighbour_counts[ids[lane]]);
    }
    // Indices travel as floats: they are moved, never computed with.
    const Pack length = Pack::load(lengths), own = Pack::load(reinterpret_cast<const float *>(ids));
    const int steps = d.steps[batch];
    float *const to = reinterpret_cast<float *>(d.indices + static_cast<long>(d.offsets[batch]) * W);
    for (int step = 0; step < steps; step += 4) {
      const Vec4<Pack> entries = load_columns(lists, step);
      const Pack columns[4] = {entries.x, entries.y, entries.z, entries.w};
      const int left = steps - step < 4 ? steps - step : 4;
      for (int k = 0; k < left; ++k)
        select(length > Pack(static_cast<float>(step + k)), columns[k], own).store(to + static_cast<long>(step + k) * W);
    }
  }
}

} // namespace loam::LOAM_INSTRUCTION_SET
