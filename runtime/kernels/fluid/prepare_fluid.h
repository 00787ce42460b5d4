// At the start of a substep: a fluid particle's density on x^n, the gradients of it, and its record.
#pragma once

#include "kernels/fluid/density_constraint.h"
#include "kernels/fluid/walls.h"

namespace loam {

// From a snapshot anything may come.
template <class T> LOAM_FN T usable_multiplier(T start) {
  return select(both(start > T(0.0f), start < T(1e30f)), start, T(0.0f));
}

struct PrepareFluid {
  const Row *positions, *velocities;
  const float *pressures, *displacements; // with which the last substep ended
  const int *neighbour_counts, *close_counts;
  const Row *walls; // null: there are none
  float *strains;   // 6 a particle: the volume change is kept as that of an elastic body
  SmoothingKernel kernel;
  float substep;
  float per_calibration; // 1 / k
  float least_response;  // D of a full neighbourhood over its w, times the least share of it that is trusted
  float most_excess;     // that displacements undo in a substep, of the density
  float share_of_excess; // at most
  float kept;            // of the last substep's multipliers of displacements
  float tolerance; // of C, either way: velocities hold from below the rest density on, displacements undo what is above it
  float per_slope; // 1 / the calibration of gradients: lambda over h p V

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec4<Real> own = team.own_row(p, positions);
    const Vec3<Lane> center = team.spread(own.xyz());
    const Lane zero_lane(0.0f);
    Vec3<Lane> total = {zero_lane, zero_lane, zero_lane};
    Lane squares = zero_lane, sum = zero_lane, apart = zero_lane;
    for (auto k : team.neighbours(p)) {
      const Vec4<Lane> x = team.neighbour_row(k, positions);
      const Vec3<Lane> d = x.xyz() - center;
      const Lane distance = square_root(dot(d, d)), volume = Lane(per_calibration) * x.w;
      const Vec3<Lane> g = (kernel.gradient_factor(distance) * volume) * d;
      team.set_gradient(k, g);
      total = total + g;
      squares = squares + team.neighbour_row(k, velocities).w * dot(g, g);
      // the list ends in the particle itself, which does not count here
      sum = sum + select(distance > zero_lane, kernel.value(distance) * volume, zero_lane);
      apart = apart + select(distance > zero_lane, Lane(1.0f), zero_lane);
    }
    const Real zero(0.0f), one(1.0f);
    const Vec3<Real> sums = team.sum(Vec3<Lane>{squares, sum, apart});
    Vec3<Real> s = team.sum(total);
    // with the particle itself, and those that are in the same place
    const Real here = one + maximum(team.own_count(p, neighbour_counts) - sums.z, zero);
    Real density = sums.y + Real(per_calibration) * (kernel.value(zero) * own.w) * here;
    if (walls != nullptr) {
      const Vec4<Real> wall = team.own_row(p, walls);
      s = s + wall.xyz();
      density = density + wall.w;
    }
    const Real w = team.own_row(p, velocities).w;
    const Real D = maximum(sums.x + w * dot(s, s), w * Real(least_response));
    const auto movable = D > zero;
    const Real excess = density - one;
    team.set_vector(p, FluidRecord::gradient, s);
    team.set_field(p, FluidRecord::slack, minimum(excess + Real(tolerance), zero));
    const Real over = excess - Real(tolerance);
    team.set_field(p, FluidRecord::excess,
                   select(over > zero, minimum(Real(share_of_excess) * over, Real(most_excess) * density), over));
    team.set_field(p, FluidRecord::response, select(movable, one / (Real(substep) * select(movable, D, one)), zero));
    const Real share = Real(substep * per_slope) * own.w;
    team.set_field(p, FluidRecord::share, share);
    team.set_field(p, FluidRecord::multiplier, usable_multiplier(team.own_value(p, pressures, 1, 0) * share));
    team.set_field(p, FluidRecord::correction, Real(kept) * usable_multiplier(team.own_value(p, displacements, 1, 0)));
    team.set_field(p, Record::close_count, team.own_count(p, close_counts));
    team.set_field(p, Record::pair_moment, zero);
    for (int i = 0; i < 3; ++i) team.set_own_value(p, strains, 6, i, one / density - one);
  }
};

} // namespace loam
