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
  static constexpr int buffer_size =
      496; // about twice the usual number of candidates; the arrays' starts are no power of two apart

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

  LOAM_FN explicit TeamOverCandidates(const CpuCandidates &views) : d(views) {}

  LOAM_FN static int wrapped(int coordinate, int size) {
    return coordinate < 0 ? coordinate + size : coordinate >= size ? coordinate - size : coordinate;
  }
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
    const int column = c / nz, cz = c - column * nz, cx = column / ny, cy = column - cx * ny;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const int row = (wrapped(cx + dx, nx) * ny + wrapped(cy + dy, ny)) * nz;
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
    while (next_run < run_count && filled + 2 * W <= buffer_size) {
      __builtin_memcpy(buffer_x + filled, d.x + next_particle, sizeof(float) * W);
      __builtin_memcpy(buffer_y + filled, d.y + next_particle, sizeof(float) * W);
      __builtin_memcpy(buffer_z + filled, d.z + next_particle, sizeof(float) * W);
      store_sequence(buffer_index + filled, next_particle);
      const int rest = run_last[next_run] - next_particle, taken = rest < W ? rest : W;
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
  // All but the particle itself.
  LOAM_FN Mask others_below(int packet, Pack squared, float limit) const {
    return others(buffer_index + packet, particle, squared < Pack(limit));
  }
  LOAM_FN static Mask below(Pack squared, float limit, Mask among) { return both(squared < Pack(limit), among); }
  // Those whose close pair with the particle this particle owns.
  LOAM_FN Mask owned(int packet, Mask among) const { return owned_pairs(buffer_index + packet, particle, among); }

  // A list is collected in two buffers, close neighbours and far ones, which one packet may overrun. Longer ones are only counted at first.
  struct List {
    int close, far;
    int *end; // of a long one, while it is written
  };
  static constexpr int close_limit = 128, far_limit = 256;
  alignas(64) int close_buffer[close_limit + W], far_buffer[far_limit + W];

  LOAM_FN static List begin_list() { return {0, 0, nullptr}; }
  LOAM_FN void append(List &list, int packet, Mask near, Mask close) {
    const int *const index = buffer_index + packet;
    list.close += compress(index, close, close_buffer + (list.close < close_limit ? list.close : close_limit));
    list.far += compress(index, both(near, opposite(close)), far_buffer + (list.far < far_limit ? list.far : far_limit));
  }
  // False if the list is long and there is room for it: then it follows by append_close() and append_far().
  LOAM_FN bool end_list(List &list) const {
    FoundLists &lists = *d.lists;
    const int length = list.close + list.far;
    lists.needed += length;
    if (lists.used + length + W > lists.capacity) return true;
    int *const to = lists.entries + lists.used;
    d.list_starts[particle] = static_cast<int>(lists.used);
    lists.used += length;
    if (list.close > close_limit || list.far > far_limit) {
      list.end = to;
      return false;
    }
    for (int k = 0; k < list.close; k += W) copy_pack(close_buffer + k, to + k);
    for (int k = 0; k < list.far; k += W) copy_pack(far_buffer + k, to + list.close + k);
    return true;
  }
  LOAM_FN void append_close(List &list, int packet, Mask close) const {
    list.end += compress(buffer_index + packet, close, list.end);
  }
  LOAM_FN void append_far(List &list, int packet, Mask near, Mask close) const {
    list.end += compress(buffer_index + packet, both(near, opposite(close)), list.end);
  }
};

} // namespace loam::LOAM_INSTRUCTION_SET
