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
  static constexpr int buffer_size = 512; // about twice the usual number of candidates

  CpuCandidates d;
  Pack x, y, z; // of the particle
  int particle = 0;

  // The runs of candidates of one cell. Up to 18 of them: nine columns of cells, each in one piece, or two where the torus' seam cuts it.
  int cell = -1;
  int run_count = 0;
  int run_first[18], run_last[18];

  // The candidates themselves, copied into one piece, which the particles of the cell share. Where they do not fit they come in segments.
  alignas(64) float buffer_x[buffer_size], buffer_y[buffer_size], buffer_z[buffer_size];
  alignas(64) int buffer_index[buffer_size];
  int filled = 0;
  bool first_segment = false; // the buffer holds the first segment
  int next_run = 0, next_particle = 0;
  // Where the particles of the run that holds the cell itself stand in the buffer: particle + own_shift, from own_begin to own_end.
  int own_shift = 0, own_begin = 0, own_end = 0;

  LOAM_FN explicit TeamOverCandidates(const CpuCandidates &views) : d(views) {}

  LOAM_FN void add_run(int from_cell, int to_cell) {
    const int first = d.starts[from_cell], last = d.starts[to_cell];
    if (first == last) return;
    run_first[run_count] = first;
    run_last[run_count] = last;
    ++run_count;
  }
  LOAM_FN void find_runs(int c) {
    cell = c;
    run_count = 0;
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
    next_run = 0;
    next_particle = run_first[0]; // a particle's own cell is never empty
    first_segment = load_segment();
  }
  // Copies a pack at a time; what runs over a run's end is overwritten by the next run, or by the far-away candidates that fill the last pack.
  LOAM_FN bool load_segment() {
    filled = 0;
    own_begin = own_end = 0;
    while (next_run < run_count && filled + 2 * W <= buffer_size) {
      __builtin_memcpy(buffer_x + filled, d.x + next_particle, sizeof(float) * W);
      __builtin_memcpy(buffer_y + filled, d.y + next_particle, sizeof(float) * W);
      __builtin_memcpy(buffer_z + filled, d.z + next_particle, sizeof(float) * W);
      for (int l = 0; l < W; ++l) buffer_index[filled + l] = next_particle + l;
      const int rest = run_last[next_run] - next_particle, taken = rest < W ? rest : W;
      if (particle >= run_first[next_run] && particle < run_last[next_run]) {
        own_shift = filled - next_particle;
        own_begin = own_end > own_begin ? own_begin : filled;
        own_end = filled + taken;
      }
      filled += taken;
      next_particle += W;
      if (rest <= W && ++next_run < run_count) next_particle = run_first[next_run];
    }
    for (int l = 0; l < W; ++l) buffer_x[filled + l] = 1e30f;
    return filled > 0;
  }

  // A pack of candidates: its place in the buffer.
  struct Iterator {
    TeamOverCandidates *team;
    int at; // -1: the end
    LOAM_FN int operator*() const { return at; }
    LOAM_FN bool operator!=(const Iterator &end) const { return at != end.at; }
    LOAM_FN void operator++() {
      at += W;
      if (at < team->filled) return;
      at = -1;
      if (team->next_run < team->run_count) {
        team->load_segment();
        team->first_segment = false;
        at = 0;
      }
    }
  };
  struct Range {
    TeamOverCandidates *team;
    LOAM_FN Iterator begin() const { return {team, 0}; }
    LOAM_FN Iterator end() const { return {team, -1}; }
  };
  LOAM_FN Range candidates(int i) {
    particle = i;
    x = Pack(d.x[i]);
    y = Pack(d.y[i]);
    z = Pack(d.z[i]);
    const int own = static_cast<int>(d.keys[i]);
    if (own != cell || !first_segment) find_runs(own);
    return {this};
  }
  LOAM_FN Pack distance_squared(int packet) const {
    const Pack dx = Pack::load(buffer_x + packet) - x, dy = Pack::load(buffer_y + packet) - y,
               dz = Pack::load(buffer_z + packet) - z;
    return dx * dx + (dy * dy + dz * dz);
  }
  LOAM_FN unsigned bits_below(Pack squared, float limit) const { return mask_bits(squared < Pack(limit)); }
  // All but the particle itself.
  LOAM_FN unsigned other_bits(int packet) const {
    const int self = particle + own_shift;
    const unsigned lane = static_cast<unsigned>(self - packet);
    return self >= own_begin && self < own_end && lane < 32 ? ~(1u << lane) : ~0u;
  }
  // Those whose close pair with the particle this particle owns.
  LOAM_FN unsigned owned_bits(int packet) const { return owned_pairs(buffer_index + packet, particle); }
  LOAM_FN int count(unsigned bits) const { return __builtin_popcount(bits); }
  LOAM_FN void store(int *values, int i, int value) const { values[i] = value; }

  // Filling: a particle's list is in two pieces here, far neighbours and close ones, each with room behind it for a pack too many. They are copied there
  // without branches; joining them and interleaving them with the lists of the other lanes is a step of its own, see VisitOrder.
  struct List {
    int *far_end, *close_end;
    bool roomy;
  };
  LOAM_FN List open_list(int i, int, int close) const {
    const int slot = d.slots[i], batch = slot / W, lane = slot % W;
    const long first = d.offsets[batch], steps = d.offsets[batch + 1] - first;
    int *const list = d.lists + 3 * (first * W + lane * steps);
    return {list, list + 2 * steps, close + W <= steps};
  }
  LOAM_FN int *append_one_by_one(int packet, unsigned bits, int *end) const {
    for (; bits != 0; bits &= bits - 1) *end++ = buffer_index[packet + __builtin_ctz(bits)];
    return end;
  }
  LOAM_FN void append(List &list, int packet, unsigned near, unsigned close) const {
    const unsigned far = near & ~close;
    if (list.roomy) {
      compress(buffer_index + packet, far, list.far_end);
      list.far_end += count(far);
      compress(buffer_index + packet, close, list.close_end);
      list.close_end += count(close);
    } else {
      list.far_end = append_one_by_one(packet, far, list.far_end);
      list.close_end = append_one_by_one(packet, close, list.close_end);
    }
  }
  LOAM_FN void close_list(const List &) const {}
};

} // namespace loam::LOAM_INSTRUCTION_SET
