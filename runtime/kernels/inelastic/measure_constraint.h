// Per-particle terms of the residual and of the virial, for the statistics: gathered once a step, on the velocities of the last iteration.
#pragma once

#include "kernels/inelastic/solve_inelastic.h"

namespace loam {

// What one particle adds to the sums.
struct ConstraintTerms {
  enum Term : int { residual_squared = 0, value_squared = 1, stress_moment = 2, pair_moment = 3, term_count = 4 };
};

template <class Law, class Multiplier> struct MeasureConstraint {
  Law law;
  StrainLimit limit;
  float substep;
  Multiplier multiplier;
  Vec3<float> up; // unit vector against gravity
  float *terms;   // term_count a particle

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p);
    const Constraint<Real> c = gather_constraint<Multiplier::non_affine>(team, p, substep, own.xyz());
    Real state[Multiplier::state_count];
    for (int i = 0; i < Multiplier::state_count; ++i) state[i] = team.field(p, Record::multiplier + i);
    const Residual<Real> residual = multiplier.residual(law, limit, c, state);
    const Real h(substep);
    team.set_own_value(p, terms, ConstraintTerms::term_count, ConstraintTerms::residual_squared, residual.change);
    team.set_own_value(p, terms, ConstraintTerms::term_count, ConstraintTerms::value_squared, residual.value);

    // V0 tau : up up^T, tau from the strain at the start of the substep
    Sym3<Real> S = team.symmetric(p, Record::strain);
    auto limited = h > h;
    const HenckyStrain<Real> strain = hencky_strain(S, limit, limited);
    const Vec3<Real> u = {Real(up.x), Real(up.y), Real(up.z)};
    const Real deviator = dot(u, strain.deviator * u);
    const Real stiffness = law.stiffness(c.history);
    const Real tau = stiffness * (Real(law.twice_mu()) * deviator + Real(law.bulk()) * strain.trace);
    team.set_own_value(p, terms, ConstraintTerms::term_count, ConstraintTerms::stress_moment, tau / c.inverse_volume);
    team.set_own_value(p, terms, ConstraintTerms::term_count, ConstraintTerms::pair_moment,
                       team.field(p, Record::pair_moment) / h);
  }
};

} // namespace loam
