// The density constraint of position-based fluids (Macklin and Mueller 2013), in velocities and with physical masses.
//
//   C_p = (1/k) sum_b V_b W(x_p - x_b) + walls - 1 <= 0        V_b the volume a neighbour was made with (its true volume if it is inelastic)
//
// One-sided: a fluid resists compression and comes apart freely. The calibration k is the kernel's sum at rest: fluid of the density it
// was made with has C = 0. The change of C over the substep is linear in the velocities,
//
//   h dC/dt = h (s . v_p - sum_b g_b . v_b),    g_b = V_b/k grad W,  s = sum_b g_b + walls' gradient
//
// and it is asked for twice, for a density that is too high already is no reason for a velocity: a velocity stays, and one that
// undoes in a substep what is too much would be an explosion, the stronger the shorter the substep.
//
//   velocities     min(C + e, 0) + h dC/dt <= 0 on v: what is dense enough gets no denser, what is not may get dense enough. The multipliers are
//                  impulses times length, lambda = h p V_p >= 0 with the pressure p:  v_b += w_b lambda g_b,  v_p -= w_p lambda s.
//   displacements  C - e + h dC/dt <= 0 on a copy u of v, which starts from v and by which particles move: C is what few iterations, and
//                  taking C for linear, left behind in earlier substeps. What u has beyond v is forgotten (a split impulse).
//
// With the tolerance e = 0 what displacements push a hair below the rest density would fall freely in the next substep, and lose its pressure.
//
// These are projected Gauss-Seidel steps on accumulated multipliers, so a visit takes back what earlier ones gave too much; gradients
// sum to zero but for the walls', so linear momentum is exact for any masses.
#pragma once

#include "kernels/inelastic/record.h"
#include "kernels/neighbours/smoothing_kernel.h"
#include "math/matrix.h"

namespace loam {

// The fields of a fluid particle's record. Position correction knows two of Record's, which stay where they are.
struct FluidRecord {
  enum Field : int {
    gradient = 0,   // 3: s
    slack = 3,      // min(C + e, 0) on x^n
    excess = 4,     // C - e on x^n, or the share of it that displacements undo
    response = 5,   // 1 / (h D), D = sum_b w_b |g_b|^2 + w_p |s|^2
    multiplier = 6, // lambda
    correction = 7, // the same for displacements
    share = 8,      // h V_p: lambda over pressure
    field_count = 9
  };
};
static_assert(FluidRecord::field_count <= static_cast<int>(Record::close_count));

enum class FluidMotion { velocities, displacements };

template <FluidMotion Motion> struct DensityConstraint {
  static constexpr int from = Motion == FluidMotion::velocities ? FluidRecord::slack : FluidRecord::excess;
  static constexpr int multiplier = Motion == FluidMotion::velocities ? FluidRecord::multiplier : FluidRecord::correction;
  float substep;
  float relaxation; // 1 in turn, less for all at once

  // The change of the multiplier.
  template <class Team> LOAM_FN typename Team::Real visit(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Real zero(0.0f);
    Lane sum(0.0f);
    for (auto k : team.neighbours(p)) sum = sum + dot(team.gradient(k), team.neighbour_velocity(k).xyz());
    const Lane none(0.0f);
    const Real flow = team.sum(Vec3<Lane>{sum, none, none}).x;
    const Real predicted =
        team.field(p, from) + Real(substep) * (dot(team.vector(p, FluidRecord::gradient), team.velocity(p).xyz()) - flow);
    const Real before = team.field(p, multiplier);
    const Real after = maximum(before + Real(relaxation) * (predicted * team.field(p, FluidRecord::response)), zero);
    team.set_field(p, multiplier, after);
    return after - before;
  }
};

// The velocity changes of a multiplier's.
template <class Team> LOAM_FN void spread_pressure(Team &team, typename Team::Item p, typename Team::Real change) {
  using Lane = typename Team::Lane;
  using Real = typename Team::Real;
  const Lane impulse = team.spread(change);
  for (auto k : team.neighbours(p)) {
    const Vec4<Lane> v = team.neighbour_velocity(k);
    const Vec3<Lane> u = v.xyz() + (impulse * v.w) * team.gradient(k);
    team.set_neighbour_velocity(k, {u.x, u.y, u.z, v.w});
  }
  const Vec4<Real> own = team.velocity(p);
  const Vec3<Real> u = own.xyz() - (change * own.w) * team.vector(p, FluidRecord::gradient);
  team.set_velocity(p, {u.x, u.y, u.z, own.w});
}

// Gauss-Seidel: a visit. Where all is loose there is nothing to write.
template <FluidMotion Motion> struct SolveFluid {
  DensityConstraint<Motion> constraint;
  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Real change = constraint.visit(team, p);
    if (any(absolute(change) > Real(0.0f))) spread_pressure(team, p, change);
  }
};

// What the last substep's multipliers would do in this one: the start of the iterations.
template <FluidMotion Motion> struct StartFluid {
  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Real start = team.field(p, DensityConstraint<Motion>::multiplier);
    if (any(start > Real(0.0f))) spread_pressure(team, p, start);
  }
};

// The multipliers go to the particle, for the next substep.
struct KeepMultipliers {
  float *pressures, *displacements;
  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    team.set_own_value(p, pressures, 1, 0, team.field(p, FluidRecord::multiplier) / team.field(p, FluidRecord::share));
    team.set_own_value(p, displacements, 1, 0, team.field(p, FluidRecord::correction));
  }
};

} // namespace loam
