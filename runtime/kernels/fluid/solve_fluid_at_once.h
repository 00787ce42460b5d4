// The Jacobi form: impulses go into the rows that kernels/inelastic/solve_jacobi.h applies, as those of a tensor lambda/k 1.
#pragma once

#include "kernels/fluid/density_constraint.h"
#include "kernels/inelastic/solve_jacobi.h"

namespace loam {

enum class FluidTurn { start, velocities, start_displacements, displacements };

template <FluidTurn Turn> struct FluidImpulse {
  static constexpr bool starts = Turn == FluidTurn::start || Turn == FluidTurn::start_displacements;
  static constexpr FluidMotion motion =
      Turn == FluidTurn::start || Turn == FluidTurn::velocities ? FluidMotion::velocities : FluidMotion::displacements;
  DensityConstraint<motion> constraint;
  float per_calibration;
  JacobiRows rows;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Real zero(0.0f);
    Real change = zero;
    if constexpr (starts)
      change = team.field(p, DensityConstraint<motion>::multiplier);
    else
      change = constraint.visit(team, p);
    const Real along = Real(per_calibration) * change;
    const Vec3<Real> own = (zero - change * team.velocity(p).w) * team.vector(p, FluidRecord::gradient);
    team.set_own_row(p, rows.column[0], {along, zero, zero, own.x});
    team.set_own_row(p, rows.column[1], {zero, along, zero, own.y});
    team.set_own_row(p, rows.column[2], {zero, zero, along, own.z});
    if (rows.along_drift[0] != nullptr)
      for (int j = 0; j < 3; ++j) team.set_own_row(p, rows.along_drift[j], {zero, zero, zero, zero});
  }
};

} // namespace loam
