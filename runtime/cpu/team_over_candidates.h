// The CPU team for the neighbour search: a lane is a candidate. Particles are sorted by cell, so candidates lie in runs of three cells along z.
#pragma once

#include "cpu/cpu_views.h"
#if defined(LOAM_PORTABLE_KERNELS)
#include "math/pack_portable.h"
#else
#include "math/pack.h"
#endif

namespace loam::LOAM_INSTRUCTION_SET {

struct TeamOverCandidates {
  using Lane = Pack;
  static constexpr int W = Pack::width;

  CpuCandidates d;
  Pack x, y, z;      // of the particle
  Pack lane_numbers; // 0, 1, 2 ...
  Pack lane_parity;  // 0, 1, 0 ...
  int particle = 0;

  // A run of candidates, W at a time. Up to 18 of them: nine columns of cells, each in one piece, or two where the torus' seam cuts it.
  struct Runs {
    int first[18], last[18];
    int count = 0;
  };
  struct Candidate {
    int base; // of this pack
    int last; // one past the run's end
  };
  struct Iterator {
    const Runs *runs;
    int run, base;
    LOAM_FN Candidate operator*() const { return {base, runs->last[run]}; }
    LOAM_FN bool operator!=(const Iterator &end) const { return run != end.run; }
    LOAM_FN void operator++() {
      base += W;
      if (base >= runs->last[run]) {
        ++run;
        base = run < runs->count ? runs->first[run] : 0;
      }
    }
  };
  struct Range {
    const Runs *runs;
    LOAM_FN Iterator begin() const { return {runs, 0, runs->first[0]}; }
    LOAM_FN Iterator end() const { return {runs, runs->count, 0}; }
  };

  Runs runs;
  int cell = -1; // that `runs` belongs to

  LOAM_FN explicit TeamOverCandidates(const CpuCandidates &views) : d(views) {
    alignas(64) float numbers[W], parity[W];
    for (int l = 0; l < W; ++l) {
      numbers[l] = static_cast<float>(l);
      parity[l] = static_cast<float>(l & 1);
    }
    lane_numbers = Pack::load(numbers);
    lane_parity = Pack::load(parity);
  }

  LOAM_FN void add_run(int from_cell, int to_cell) {
    const int first = d.starts[from_cell], last = d.starts[to_cell];
    if (first == last) return;
    runs.first[runs.count] = first;
    runs.last[runs.count] = last;
    ++runs.count;
  }
  LOAM_FN void find_runs(int c) {
    cell = c;
    runs.count = 0;
    const int nx = d.size[0], ny = d.size[1], nz = d.size[2];
    const int cz = c % nz, cy = c / nz % ny, cx = c / nz / ny;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const int row = ((cx + dx + nx) % nx * ny + (cy + dy + ny) % ny) * nz;
        if (cz > 0 && cz < nz - 1) {
          add_run(row + cz - 1, row + cz + 2);
        } else if (cz == 0) {
          add_run(row + nz - 1, row + nz);
          add_run(row, row + 2);
        } else {
          add_run(row + nz - 2, row + nz);
          add_run(row, row + 1);
        }
      }
  }
  LOAM_FN Range candidates(int i) {
    particle = i;
    x = Pack(d.x[i]);
    y = Pack(d.y[i]);
    z = Pack(d.z[i]);
    if (static_cast<int>(d.keys[i]) != cell) find_runs(static_cast<int>(d.keys[i]));
    return {&runs};
  }
  LOAM_FN Pack distance_squared(const Candidate &k) const {
    const Pack dx = Pack::load_unaligned(d.x + k.base) - x, dy = Pack::load_unaligned(d.y + k.base) - y,
               dz = Pack::load_unaligned(d.z + k.base) - z;
    return dx * dx + (dy * dy + dz * dz);
  }
  // Candidates of the run that are not the particle itself. Differences of indices are exact or at least keep their sign.
  LOAM_FN Mask other(const Candidate &k) const {
    const Pack left(static_cast<float>(k.last - k.base)), self(static_cast<float>(particle - k.base));
    return both(lane_numbers < left, either(lane_numbers<self, lane_numbers> self));
  }
  LOAM_FN Mask owned(const Candidate &k) const {
    const Pack self(static_cast<float>(particle - k.base)), half(0.5f);
    const bool odd = ((k.base + particle) & 1) != 0;
    const Mask even_sum = odd ? lane_parity > half : lane_parity < half;
    return either(both(even_sum, lane_numbers > self), both(opposite(even_sum), lane_numbers < self));
  }
  LOAM_FN int count(Mask m) const { return loam::LOAM_INSTRUCTION_SET::count(m); }
  LOAM_FN void store(int *values, int i, int value) const { values[i] = value; }

  // filling
  int *close_end = nullptr, *far_end = nullptr, *list_end = nullptr;
  LOAM_FN void open_list(int i, int total, int close) {
    const int slot = d.slots[i], batch = slot / W, lane = slot % W;
    close_end = d.indices + static_cast<long>(d.offsets[batch]) * W + lane;
    far_end = close_end + static_cast<long>(close) * W;
    list_end = d.indices + static_cast<long>(d.offsets[batch + 1]) * W + lane;
    (void)total;
  }
  LOAM_FN void append(const Candidate &k, Mask near, Mask close) {
    const unsigned close_bits = mask_bits(close);
    for (unsigned rest = mask_bits(near); rest != 0; rest &= rest - 1) {
      const int lane = __builtin_ctz(rest);
      int *&end = (close_bits >> lane & 1u) != 0 ? close_end : far_end;
      *end = k.base + lane;
      end += W;
    }
  }
  LOAM_FN void close_list(int i) {
    for (; far_end < list_end; far_end += W) *far_end = i;
  }
};

} // namespace loam::LOAM_INSTRUCTION_SET
