// Sleep: matter that has come to rest is held in place, at no cost, until something reaches it.
//
// A particle that was slower than a given speed for a given time, and its neighbours too, falls asleep: it does not move and its strain stays. Constraints are
// visited only in cells within two cells of an awake particle. In the nearer of these, sleepers take part in the solve like all others, with weight and
// mass, and only their motion is not kept; in the farther they are pinned, and bear with the stress that they fell asleep with. All others cost nothing
// but their place in the order. (Pinning at once what sleeps changes how far a few iterations get, and with it the equilibrium that matter has found.)
//
// A sleeper wakes when a neighbour is twice as fast as the speed to fall asleep at, when a collider moves near it, or when the host says so.
//
// The error: motion slower than the speed is stopped, so a particle that would creep at v < sleep_speed lags behind by v t at most.
#pragma once

#include "kernels/neighbours/cell_grid.h"
#include "math/matrix.h"

namespace loam {

// `rest` of a particle: the time that it has been slow, 0 or more; negative while it sleeps. A sleeper that is pinned for a substep keeps its inverse mass
// there, with the sign turned.
constexpr float asleep = -1.0f;

// Pinned particles are awake only while they move.
LOAM_FN bool is_awake(const Row &velocity, float rest) {
  return rest >= 0.0f && (velocity.w != 0.0f || velocity.x != 0.0f || velocity.y != 0.0f || velocity.z != 0.0f);
}

struct CountAwake {
  using Value = long long;
  const Row *velocities;
  const float *rests;
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const { return is_awake(velocities[i], rests[i]) ? 1 : 0; }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

struct CountSleepers {
  using Value = long long;
  const float *rests;
  LOAM_FN static Value identity() { return 0; }
  LOAM_FN Value operator()(int i) const { return rests[i] < 0.0f ? 1 : 0; }
  LOAM_FN static Value combine(Value a, Value b) { return a + b; }
};

// For each cell: whether it holds an awake particle.
struct MarkAwakeCells {
  const int *starts;
  const Row *velocities;
  const float *rests;
  std::uint8_t *awake;
  LOAM_FN void operator()(int cell) const {
    std::uint8_t any = 0;
    for (int i = starts[cell]; i < starts[cell + 1]; ++i) any |= is_awake(velocities[i], rests[i]) ? 1 : 0;
    awake[cell] = any;
  }
};
// And whether it or a cell beside it is marked.
struct MarkCellsBeside {
  CellGrid grid;
  const int *starts;
  const std::uint8_t *marked;
  std::uint8_t *result;
  LOAM_FN static int wrapped(int c, int size) { return c < 0 ? c + size : c >= size ? c - size : c; }
  LOAM_FN void operator()(int cell) const {
    result[cell] = 0;
    if (starts[cell] == starts[cell + 1]) return; // nobody asks
    const int ny = grid.size[1], nz = grid.size[2];
    const int x = cell / nz / ny, y = cell / nz % ny, z = cell % nz;
    std::uint8_t any = 0;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz)
          any |= marked[grid.index(wrapped(x + dx, grid.size[0]), wrapped(y + dy, ny), wrapped(z + dz, nz))];
    result[cell] = any;
  }
};

// Before the solve: sleepers that do not take part are pinned.
struct PinSleepers {
  const std::uint32_t *keys; // cells
  const std::uint8_t *near;
  Row *velocities;
  float *rests;
  LOAM_FN void operator()(int i) const {
    if (rests[i] >= 0.0f || near[keys[i]] != 0) return;
    const float w = velocities[i].w;
    if (w == 0.0f) return;
    rests[i] = 0.0f - w;
    velocities[i] = {0.0f, 0.0f, 0.0f, 0.0f};
  }
};
// After it: none has moved.
struct HoldSleepers {
  Row *velocities;
  float *rests;
  LOAM_FN void operator()(int i) const {
    if (rests[i] >= 0.0f) return;
    const float w = velocities[i].w;
    velocities[i] = {0.0f, 0.0f, 0.0f, w == 0.0f ? 0.0f - rests[i] : w};
    rests[i] = asleep;
  }
};

// Looks at a particle's neighbours: wakes a sleeper that has a fast one, and lets the rest of one that is awake begin anew where a neighbour is not slow.
struct LookAround {
  float *rests;
  float sleep_speed, wake_speed;
  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Lane none(0.0f), one(1.0f);
    Vec3<Lane> counts = {none, none, none}; // of neighbours that are fast, and that are not slow
    for (auto k : team.unweighted_neighbours(p)) {
      const Vec3<Lane> v = team.neighbour_velocity(k).xyz();
      const Lane squared = dot(v, v);
      counts.x = counts.x + select(squared > Lane(wake_speed * wake_speed), one, none);
      counts.y = counts.y + select(squared > Lane(sleep_speed * sleep_speed), one, none);
    }
    const Vec3<Real> sums = team.sum(counts);
    const Real rest = team.own_value(p, rests, 1, 0), zero(0.0f);
    const auto disturbed = either(both(rest<zero, sums.x> zero), both(rest > zero, sums.y > zero));
    team.set_own_value(p, rests, 1, 0, select(disturbed, zero, rest));
  }
};

struct FallAsleep {
  Row *velocities;
  float *rests;
  float sleep_speed, sleep_delay, substep;
  LOAM_FN void operator()(int i) const {
    const Row v = velocities[i];
    const float rest = rests[i];
    if (rest < 0.0f || v.w == 0.0f) return;
    const bool slow = v.x * v.x + (v.y * v.y + v.z * v.z) < sleep_speed * sleep_speed;
    const bool sleeps = slow && rest + substep >= sleep_delay;
    rests[i] = sleeps ? asleep : slow ? rest + substep : 0.0f;
    if (sleeps) velocities[i] = {0.0f, 0.0f, 0.0f, v.w};
  }
};

// Wakes all that sleep within a sphere.
struct WakeWithin {
  const Row *positions;
  float *rests;
  Vec3<float> centre;
  float radius; // may be infinite
  LOAM_FN void operator()(int i) const {
    const Vec3<float> d = xyz(positions[i]) - centre;
    if (rests[i] < 0.0f && dot(d, d) <= radius * radius) rests[i] = 0.0f;
  }
};

} // namespace loam
