// The CPU team for stages over neighbours: a lane works through a few blocks of cells. Lane and Real are both packs, sums need no folding.
#pragma once

#include "cpu/cpu_views.h"
#include "kernels/inelastic/record.h"
#include "math/atomics.h"
#if defined(LOAM_PORTABLE_KERNELS)
#include "math/pack_portable.h"
#else
#include "math/pack.h"
#endif

namespace loam::LOAM_INSTRUCTION_SET {

struct TeamOverCells {
  using Lane = Pack;
  using Real = Pack;
  using Item = int; // a batch
  static constexpr int W = Pack::width;
  static constexpr int prefetch_distance = 32; // pair steps: measured

  CpuPairs d;

  // A place in the lists. Walking on, it prefetches what will be read: gradients too if the stage uses them.
  template <bool WithGradients> struct Neighbour {
    int *index;
    float *gradient;
    LOAM_FN Neighbour operator*() const { return *this; }
    LOAM_FN bool operator!=(const Neighbour &end) const { return index != end.index; }
    LOAM_FN void operator++() {
      if constexpr (WithGradients)
        for (int i = 0; i < 3 * W; i += 16) __builtin_prefetch(gradient + 3 * W * prefetch_distance + i);
      __builtin_prefetch(index + W * prefetch_distance);
      index += W;
      gradient += 3 * W;
    }
  };
  template <bool WithGradients> struct Range {
    Neighbour<WithGradients> first, last;
    LOAM_FN Neighbour<WithGradients> begin() const { return first; }
    LOAM_FN Neighbour<WithGradients> end() const { return last; }
  };
  template <bool WithGradients> LOAM_FN Range<WithGradients> range(long first, long last) const {
    return {{d.indices + first * W, d.gradients + first * 3 * W}, {d.indices + last * W, d.gradients + last * 3 * W}};
  }
  LOAM_FN Range<true> neighbours(int b) const { return range<true>(d.offsets[b], d.offsets[b] + d.steps[b]); }
  // For stages that do not look at gradients.
  LOAM_FN Range<false> unweighted_neighbours(int b) const { return range<false>(d.offsets[b], d.offsets[b] + d.steps[b]); }
  // Only the close ones, first in the list.
  LOAM_FN Range<false> close_neighbours(int b) const { return range<false>(d.offsets[b], d.offsets[b] + d.close_steps[b]); }

  // of a neighbour
  template <bool G> LOAM_FN Vec4<Pack> neighbour_velocity(const Neighbour<G> &k) const {
    return load_rows(d.velocities, k.index);
  }
  template <bool G> LOAM_FN void set_neighbour_velocity(const Neighbour<G> &k, const Vec4<Pack> &v) const {
    store_rows(d.velocities, k.index, v);
  }
  template <bool G> LOAM_FN Vec4<Pack> neighbour_row(const Neighbour<G> &k, const Row *rows) const {
    return load_rows(rows, k.index);
  }
  template <bool G> LOAM_FN Vec3<Pack> gradient(const Neighbour<G> &k) const {
    return {Pack::load(k.gradient), Pack::load(k.gradient + W), Pack::load(k.gradient + 2 * W)};
  }
  template <bool G> LOAM_FN void set_gradient(const Neighbour<G> &k, const Vec3<Pack> &g) const {
    g.x.store(k.gradient);
    g.y.store(k.gradient + W);
    g.z.store(k.gradient + 2 * W);
  }
  template <bool G> LOAM_FN Pack neighbour_count(const Neighbour<G> &k, const int *counts) const {
    alignas(64) float values[W];
    for (int l = 0; l < W; ++l) values[l] = static_cast<float>(counts[k.index[l]]);
    return Pack::load(values);
  }

  template <bool G>
  LOAM_FN Pack neighbour_lookup(const Neighbour<G> &k, const std::uint32_t *numbers, const float *table) const {
    alignas(64) float values[W];
    for (int l = 0; l < W; ++l) values[l] = table[numbers[k.index[l]]];
    return Pack::load(values);
  }

  // of the item's own particles
  LOAM_FN const int *own(int b) const { return d.ids + static_cast<long>(b) * W; }
  LOAM_FN Vec4<Pack> velocity(int b) const { return load_rows(d.velocities, own(b)); }
  LOAM_FN void set_velocity(int b, const Vec4<Pack> &v) const { set_own_row(b, d.velocities, v); }
  LOAM_FN Vec4<Pack> own_row(int b, const Row *rows) const { return load_rows(rows, own(b)); }
  LOAM_FN void set_own_row(int b, Row *rows, const Vec4<Pack> &v) const {
    if (d.active[b] == W) {
      store_rows(rows, own(b), v);
      return;
    }
    alignas(64) float x[W], y[W], z[W], w[W];
    v.x.store(x);
    v.y.store(y);
    v.z.store(z);
    v.w.store(w);
    for (int l = 0; l < d.active[b]; ++l) rows[own(b)[l]] = {x[l], y[l], z[l], w[l]};
  }
  LOAM_FN Pack own_value(int b, const float *values, int stride, int offset) const {
    alignas(64) float lanes[W];
    for (int l = 0; l < W; ++l) lanes[l] = values[static_cast<long>(own(b)[l]) * stride + offset];
    return Pack::load(lanes);
  }
  LOAM_FN void set_own_value(int b, float *values, int stride, int offset, Pack value) const {
    alignas(64) float lanes[W];
    value.store(lanes);
    for (int l = 0; l < d.active[b]; ++l) values[static_cast<long>(own(b)[l]) * stride + offset] = lanes[l];
  }
  // 0 in idle lanes: they have no neighbours, whatever particle they stand in for.
  LOAM_FN Pack own_count(int b, const int *counts) const {
    alignas(64) float lanes[W];
    for (int l = 0; l < W; ++l) lanes[l] = l < d.active[b] ? static_cast<float>(counts[own(b)[l]]) : 0.0f;
    return Pack::load(lanes);
  }

  // of the record
  LOAM_FN float *place(int b, int field) const { return d.records + (static_cast<long>(b) * d.record_size + field) * W; }
  LOAM_FN Pack field(int b, int field) const { return Pack::load(place(b, field)); }
  LOAM_FN void set_field(int b, int field, Pack value) const { value.store(place(b, field)); }
  LOAM_FN Vec3<Pack> vector(int b, int f) const { return {field(b, f), field(b, f + 1), field(b, f + 2)}; }
  LOAM_FN void set_vector(int b, int f, const Vec3<Pack> &v) const {
    set_field(b, f, v.x);
    set_field(b, f + 1, v.y);
    set_field(b, f + 2, v.z);
  }
  LOAM_FN Sym3<Pack> symmetric(int b, int f) const {
    return {field(b, f), field(b, f + 1), field(b, f + 2), field(b, f + 3), field(b, f + 4), field(b, f + 5)};
  }
  LOAM_FN void set_symmetric(int b, int f, const Sym3<Pack> &s) const {
    const Pack values[6] = {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
    for (int i = 0; i < 6; ++i) set_field(b, f + i, values[i]);
  }

  // between lanes and the item
  template <class V> LOAM_FN static const V &sum(const V &v) { return v; }
  template <class V> LOAM_FN static const V &spread(const V &v) { return v; }
  LOAM_FN void count(int b, Mask mask, int *counter) const {
    alignas(64) float lanes[W];
    select(mask, Pack(1.0f), Pack(0.0f)).store(lanes);
    int total = 0;
    for (int l = 0; l < d.active[b]; ++l) total += lanes[l] > 0.0f ? 1 : 0;
    if (total > 0) atomic_add(counter, total);
  }
};

} // namespace loam::LOAM_INSTRUCTION_SET
