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
  Pack x, y, z; // of the particle
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

  LOAM_FN explicit TeamOverCandidates(const CpuCandidates &views) : d(views) {}

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
  LOAM_FN unsigned bits_below(Pack squared, float limit) const { return mask_bits(squared < Pack(limit)); }
  // Candidates of the run that are not the particle itself.
  LOAM_FN unsigned other_bits(const Candidate &k) const {
    const unsigned left = static_cast<unsigned>(k.last - k.base), self = static_cast<unsigned>(particle - k.base);
    const unsigned in_run = left >= 32 ? ~0u : (1u << left) - 1u;
    return self < 32 ? in_run & ~(1u << self) : in_run;
  }
  // Candidates whose close pair with the particle this particle owns.
  LOAM_FN unsigned owned_bits(const Candidate &k) const {
    const int self = particle - k.base;
    const unsigned above = self < 0 ? ~0u : self >= 31 ? 0u : ~0u << (self + 1);
    const unsigned even_sum = ((k.base ^ particle) & 1) != 0 ? 0xaaaaaaaau : 0x55555555u;
    return (even_sum & above) | ~(even_sum | above);
  }
  LOAM_FN int count(unsigned bits) const { return __builtin_popcount(bits); }
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
  LOAM_FN void append(const Candidate &k, unsigned near, unsigned close) {
    for (unsigned rest = near & ~close; rest != 0; rest &= rest - 1) {
      *far_end = k.base + __builtin_ctz(rest);
      far_end += W;
    }
    for (unsigned rest = close; rest != 0; rest &= rest - 1) {
      *close_end = k.base + __builtin_ctz(rest);
      close_end += W;
    }
  }
  LOAM_FN void close_list(int i) {
    for (; far_end < list_end; far_end += W) *far_end = i;
  }
};

} // namespace loam::LOAM_INSTRUCTION_SET
