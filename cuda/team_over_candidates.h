// The CUDA team for the neighbour search: a tile for a particle, a lane for a candidate. Particles are sorted by cell, so candidates lie in
// runs of three cells along z: nine columns, each in one piece, or in two where the torus' seam cuts it.
//
// All lanes go through the runs together, also where a run's last packet does not fill the tile.
#pragma once

#include "math/vector.h"
#include "tile_views.h"

namespace loam {

template <class TileType> struct TeamOverCandidates {
  using Tile = TileType;
  using Lane = typename Tile::Lane;

  TileCandidates d;
  Tile tile;
  int particle = 0;
  int cell[3] = {0, 0, 0};
  Vec3<float> centre{0.0f, 0.0f, 0.0f};

  LOAM_FN TeamOverCandidates(const TileCandidates &views, const Tile &own_tile) : d(views), tile(own_tile) {}

  struct Packet {
    int base; // of lane 0
    int last; // one past the run's end
  };
  static constexpr int run_count = 18; // nine columns, two pieces each
  struct Iterator {
    const TeamOverCandidates &team;
    int run;
    Packet packet;
    LOAM_FN bool operator!=(const Iterator &end) const { return run != end.run; }
    LOAM_FN Packet operator*() const { return packet; }
    LOAM_FN void operator++() {
      packet.base += Tile::width;
      if (packet.base >= packet.last) next_run();
    }
    // The next run that is not empty.
    LOAM_FN void next_run() {
      do {
        ++run;
        packet = run < run_count ? team.find_run(run) : Packet{0, 1};
      } while (packet.base >= packet.last);
    }
  };
  struct Range {
    Iterator first, last;
    LOAM_FN Iterator begin() const { return first; }
    LOAM_FN Iterator end() const { return last; }
  };

  LOAM_FN static int wrapped(int c, int size) { return c < 0 ? c + size : c >= size ? c - size : c; }
  LOAM_FN Packet find_run(int run) const {
    const int column = run / 2;
    const bool second = run % 2 != 0;
    const int row =
        (wrapped(cell[0] + column / 3 - 1, d.size[0]) * d.size[1] + wrapped(cell[1] + column % 3 - 1, d.size[1])) *
        d.size[2];
    int first = cell[2] - 1, last = cell[2] + 2;
    if (first < 0) { // the seam is below
      first = second ? 0 : d.size[2] - 1;
      last = second ? 2 : d.size[2];
    } else if (last > d.size[2]) { // or above
      first = second ? 0 : d.size[2] - 2;
      last = second ? 1 : d.size[2];
    } else if (second) {
      return {0, 0};
    }
    return {d.starts[row + first], d.starts[row + last]};
  }
  LOAM_FN Range candidates(int i) {
    particle = i;
    centre = {d.x[i], d.y[i], d.z[i]};
    const int c = static_cast<int>(d.keys[i]), plane = d.size[1] * d.size[2];
    cell[0] = c / plane;
    cell[1] = c % plane / d.size[2];
    cell[2] = c % d.size[2];
    Iterator first = {*this, -1, {0, 0}};
    first.next_run();
    return {first, {*this, run_count, {0, 0}}};
  }

  // What stands beyond the run's end is loaded too and sorted out by other_bits(): the arrays have room for a packet past their end.
  LOAM_FN Lane distance_squared(const Packet &k) const {
    const Lane dx = tile.load_from(d.x, k.base) - Lane(centre.x), dy = tile.load_from(d.y, k.base) - Lane(centre.y),
               dz = tile.load_from(d.z, k.base) - Lane(centre.z);
    return tile.length_squared(dx, dy, dz);
  }
  // Words of bits, one a lane.
  LOAM_FN unsigned others_below(const Packet &k, Lane squared, float limit) const {
    return tile.bits_below(squared, limit) & other_bits(k);
  }
  LOAM_FN unsigned below(Lane squared, float limit, unsigned among) const { return tile.bits_below(squared, limit) & among; }
  LOAM_FN unsigned owned(const Packet &k, unsigned among) const { return owned_bits(k) & among; }
  // Candidates of the run that are not the particle itself.
  LOAM_FN unsigned other_bits(const Packet &k) const {
    const unsigned left = static_cast<unsigned>(k.last - k.base), self = static_cast<unsigned>(particle - k.base);
    const unsigned in_run = left >= 32 ? ~0u : (1u << left) - 1u;
    return self < 32 ? in_run & ~(1u << self) : in_run;
  }
  // Candidates whose close pair with the particle this particle owns.
  LOAM_FN unsigned owned_bits(const Packet &k) const {
    const int self = particle - k.base;
    const unsigned above = self < 0 ? ~0u : self >= 31 ? 0u : ~0u << (self + 1);
    const unsigned even_sum = ((k.base ^ particle) & 1) != 0 ? 0xaaaaaaaau : 0x55555555u;
    return (even_sum & above) | ~(even_sum | above);
  }
  LOAM_FN static int count(unsigned bits) { return Tile::count(bits); }
  LOAM_FN void store(int *values, int i, int value) const {
    if (tile.leader()) values[i] = value;
  }

  // filling; `list` is where the particle's list begins, set before the stage runs
  int *list = nullptr;
  struct List {
    int close_end, far_end;
  };
  LOAM_FN void open_visit(const Visit &visit) {
    list = d.indices + static_cast<std::int64_t>(visit.first_line) * TilePairs::line;
  }
  LOAM_FN List open_list(int, int, int close) const { return {0, close}; }
  LOAM_FN void append(List &ends, const Packet &k, unsigned near, unsigned close) {
    const unsigned far = near & ~close;
    tile.append(list + ends.far_end, far, k.base);
    ends.far_end += count(far);
    tile.append(list + ends.close_end, close, k.base);
    ends.close_end += count(close);
  }
};

} // namespace loam
