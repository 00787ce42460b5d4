// The CUDA team for stages over neighbours: a tile for a particle, a lane for a neighbour. Values of the particle itself are the same in
// all lanes, which compute them alike; the tile's leader writes them.
//
// Ordering within a tile. A lane may run ahead of the others between two points where they wait for each other, so:
//   - before the leader writes something of the particle, all lanes have read what they want of it: every such write waits first;
//   - what one visit has written, the next one of the block reads in other lanes: close() waits;
//   - the neighbours of one particle are distinct and not the particle itself, so the lanes' own writes never meet.
#pragma once

#include "math/atomics.h"
#include "math/matrix.h"
#include "tile_views.h"

namespace loam {

template <class TileType> struct TeamOverNeighbours {
  using Tile = TileType;
  using Lane = typename Tile::Lane;
  using Real = float;
  using Item = int; // a visit

  TilePairs d;
  Tile tile;
  Visit visit{};
  float *record = nullptr;
  float fields[TilePairs::most_fields] = {}; // of the record, as the visit found it

  LOAM_FN TeamOverNeighbours(const TilePairs &pairs, const Tile &own_tile) : d(pairs), tile(own_tile) {}

  // Around each visit.
  LOAM_FN void open(int p) {
    visit = d.visits[p];
    record = d.records + static_cast<std::int64_t>(p) * d.record_stride;
    // Asked for all at once and early, so that they arrive while the neighbours are gathered. What a stage does not use is not loaded.
    for (int i = 0; i < TilePairs::most_fields; i += 4) {
      const Row row = *reinterpret_cast<const Row *>(record + i);
      fields[i] = row.x;
      fields[i + 1] = row.y;
      fields[i + 2] = row.z;
      fields[i + 3] = row.w;
    }
  }
  LOAM_FN void close() const { tile.sync(); }

  struct Neighbour {
    typename Tile::Index index;
    float *gradient;
    int left;
  };
  struct Iterator {
    const Tile &tile;
    const int *indices;
    float *gradients;
    int position, count, self;
    LOAM_FN bool operator!=(const Iterator &end) const { return position < end.position; }
    LOAM_FN void operator++() { position += Tile::width; }
    LOAM_FN Neighbour operator*() const {
      // gradients + (position / 16) * 48 + position % 16
      float *gradient = gradients + position + 2 * (position & ~(TilePairs::line - 1));
      return {tile.load_index(indices + position, count - position, self), gradient, count - position};
    }
  };
  struct Range {
    Iterator first, last;
    LOAM_FN Iterator begin() const { return first; }
    LOAM_FN Iterator end() const { return last; }
  };
  LOAM_FN Range first_neighbours(int count) const {
    const std::int64_t place = static_cast<std::int64_t>(visit.first_line) * TilePairs::line;
    int *indices = d.indices + place;
    float *gradients = d.gradients + 3 * place;
    return {{tile, indices, gradients, tile.first_position(), count, visit.particle},
            {tile, indices, gradients, count, count, visit.particle}};
  }
  LOAM_FN Range neighbours(int) const { return first_neighbours(visit.count); }
  LOAM_FN Range unweighted_neighbours(int) const { return first_neighbours(visit.count); }
  LOAM_FN Range close_neighbours(int) const { return first_neighbours(visit.close_count); }

  // of a neighbour
  LOAM_FN Vec4<Lane> neighbour_velocity(const Neighbour &k) const { return tile.gather(d.velocities, k.index); }
  LOAM_FN void set_neighbour_velocity(const Neighbour &k, const Vec4<Lane> &v) const {
    tile.scatter(d.velocities, k.index, v, k.left);
  }
  LOAM_FN Vec4<Lane> neighbour_row(const Neighbour &k, const Row *rows) const { return tile.gather(rows, k.index); }
  LOAM_FN Vec3<Lane> gradient(const Neighbour &k) const {
    constexpr int line = TilePairs::line;
    return {tile.load(k.gradient, k.left), tile.load(k.gradient + line, k.left), tile.load(k.gradient + 2 * line, k.left)};
  }
  LOAM_FN void set_gradient(const Neighbour &k, const Vec3<Lane> &g) const {
    constexpr int line = TilePairs::line;
    tile.store(k.gradient, g.x, k.left);
    tile.store(k.gradient + line, g.y, k.left);
    tile.store(k.gradient + 2 * line, g.z, k.left);
  }
  LOAM_FN Lane neighbour_count(const Neighbour &k, const int *counts) const { return tile.gather_count(counts, k.index); }
  LOAM_FN Lane neighbour_lookup(const Neighbour &k, const std::uint32_t *numbers, const float *table) const {
    return tile.gather_lookup(numbers, table, k.index);
  }

  // of the particle itself
  LOAM_FN Vec4<Real> velocity(int p) const { return own_row(p, d.velocities); }
  LOAM_FN void set_velocity(int p, const Vec4<Real> &v) const { set_own_row(p, d.velocities, v); }
  LOAM_FN Vec4<Real> own_row(int, const Row *rows) const {
    const Row row = rows[visit.particle];
    return {row.x, row.y, row.z, row.w};
  }
  LOAM_FN void set_own_row(int, Row *rows, const Vec4<Real> &v) const {
    tile.sync();
    if (tile.leader()) rows[visit.particle] = {v.x, v.y, v.z, v.w};
  }
  LOAM_FN Real own_value(int, const float *values, int stride, int offset) const {
    return values[static_cast<std::int64_t>(visit.particle) * stride + offset];
  }
  LOAM_FN void set_own_value(int, float *values, int stride, int offset, Real value) const {
    tile.sync();
    if (tile.leader()) values[static_cast<std::int64_t>(visit.particle) * stride + offset] = value;
  }
  LOAM_FN Real own_count(int, const int *counts) const { return static_cast<float>(counts[visit.particle]); }

  // of the record
  LOAM_FN Real field(int, int f) const { return fields[f]; }
  LOAM_FN void set_field(int, int f, Real value) const {
    tile.sync();
    if (tile.leader()) record[f] = value;
  }
  LOAM_FN Vec3<Real> vector(int, int f) const { return {fields[f], fields[f + 1], fields[f + 2]}; }
  LOAM_FN void set_vector(int, int f, const Vec3<Real> &v) const {
    tile.sync();
    if (!tile.leader()) return;
    record[f] = v.x;
    record[f + 1] = v.y;
    record[f + 2] = v.z;
  }
  LOAM_FN Sym3<Real> symmetric(int, int f) const {
    return {fields[f], fields[f + 1], fields[f + 2], fields[f + 3], fields[f + 4], fields[f + 5]};
  }
  LOAM_FN void set_symmetric(int, int f, const Sym3<Real> &s) const {
    const Real values[6] = {s.xx, s.yy, s.zz, s.xy, s.xz, s.yz};
    tile.sync();
    if (!tile.leader()) return;
    for (int i = 0; i < 6; ++i) record[f + i] = values[i];
  }

  // between lanes and the particle
  LOAM_FN Vec3<Real> sum(const Vec3<Lane> &v) const {
    const Lane lanes[3] = {v.x, v.y, v.z};
    Real s[3];
    tile.sum(s, lanes);
    return {s[0], s[1], s[2]};
  }
  LOAM_FN Sym3<Real> sum(const Sym3<Lane> &v) const {
    const Lane lanes[6] = {v.xx, v.yy, v.zz, v.xy, v.xz, v.yz};
    Real s[6];
    tile.sum(s, lanes);
    return {s[0], s[1], s[2], s[3], s[4], s[5]};
  }
  LOAM_FN Mat3<Real> sum(const Mat3<Lane> &v) const {
    const Lane lanes[9] = {v.m[0][0], v.m[0][1], v.m[0][2], v.m[1][0], v.m[1][1],
                           v.m[1][2], v.m[2][0], v.m[2][1], v.m[2][2]};
    Real s[9];
    tile.sum(s, lanes);
    return {{{s[0], s[1], s[2]}, {s[3], s[4], s[5]}, {s[6], s[7], s[8]}}};
  }
  LOAM_FN static Lane spread(Real v) { return Lane(v); }
  LOAM_FN static Vec3<Lane> spread(const Vec3<Real> &v) { return {Lane(v.x), Lane(v.y), Lane(v.z)}; }
  LOAM_FN static Mat3<Lane> spread(const Mat3<Real> &v) {
    Mat3<Lane> lanes;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) lanes.m[i][j] = Lane(v.m[i][j]);
    return lanes;
  }
  LOAM_FN void count(int, bool counted, int *counter) const {
    if (counted && tile.leader()) atomic_add(counter, 1);
  }
};

} // namespace loam
