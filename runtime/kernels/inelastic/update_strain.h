// The end of a substep for the elastic strain: F^{n+1} = Z((I + h grad v) F^n), with the final velocity, and the true volume.
//
// The true volume J follows det(I + h grad v) alone: the elastic determinant forgets what the return mapping discards.
#pragma once

#include "kernels/inelastic/constraint.h"
#include "kernels/materials/project.h"
#include "math/tensor_functions.h"

namespace loam {

template <class Law, bool NonAffine> struct UpdateStrain {
  Law law;
  StrainLimit limit;
  float substep;
  float *strains;
  float *histories; // null if the law has none
  float *log_volumes;
  float *drifts;          // 3 a particle; null without NonAffine
  float drift_stiffness;  // stiffness / r^2, see non_affine.h
  float *stresses;        // 6 a particle, see warm_start.h; null without a warm start
  float *answered_drifts; // 3 a particle; null without either
  const int *neighbour_counts;
  int *strain_limited, *strain_decomposed; // counters

  static constexpr float greatest_drift = 0.5f; // as a strain
  static constexpr float greatest_slow = 0.02f; // strain of a substep

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Real zero(0.0f), one(1.0f), third(1.0f / 3.0f);
    const Vec3<Real> s = team.vector(p, Record::gradient_sum);
    Mat3<Real> H;
    NonAffineMotion<Real> motion;
    gather_motion<NonAffine>(team, p, substep, team.velocity(p).xyz(), s, team.vector(p, Record::unknown), H, motion);
    Sym3<Real> S = advance_strain(team.symmetric(p, Record::strain), H);

    // det(I + H) - 1 = tr H + second invariant + det H
    const Real first = H.m[0][0] + (H.m[1][1] + H.m[2][2]);
    const Real second = (H.m[0][0] * H.m[1][1] - H.m[0][1] * H.m[1][0]) +
                        ((H.m[0][0] * H.m[2][2] - H.m[0][2] * H.m[2][0]) + (H.m[1][1] * H.m[2][2] - H.m[1][2] * H.m[2][1]));
    const Real volume_step = log1p_bounded(first + (second + determinant(H)));
    const Real log_volume =
        team.own_value(p, log_volumes, 1, 0) + select(absolute(volume_step) < Real(10.0f), volume_step, zero); // not NaN
    team.set_own_value(p, log_volumes, 1, 0, minimum(maximum(log_volume, Real(-20.0f)), Real(20.0f)));

    auto limited = zero > zero, decomposed = limited;
    const HenckyStrain<Real> strain = hencky_strain(S, limit, limited, decomposed);
    if (any(limited)) team.count(p, limited, strain_limited);
    if (any(decomposed)) team.count(p, decomposed, strain_decomposed);
    Real drift_scale = one, other_squared = zero;
    if constexpr (NonAffine) other_squared = Real(drift_share * drift_stiffness) * dot(motion.drift, motion.drift);
    // Matter that may come apart, with too few neighbours, is loose: its neighbourhood cannot tell a strain.
    const auto alone = team.own_count(p, neighbour_counts) < Real(3.0f);
    if constexpr (Law::plastic) {
      const Real history = team.field(p, Record::history);
      const HenckyStrain<Real> elastic = {law.elastic_trace(strain.trace, history), strain.deviator};
      const Projection<Real> mapped = project(law, elastic, other_squared, history, Flow<Real>{substep, one, one});
      // b - I = (1 + a)(I + E) - I = a I + E + a E with 1 + a = exp(2 tr/3) and I + E = exp(2 dev)
      const Real a = expm1_series(Real(2.0f) * third * mapped.strain.trace);
      const Sym3<Real> E = expm1_traceless(Real(2.0f) * mapped.strain.deviator);
      const Sym3<Real> projected = add_diagonal((one + a) * E, a);
      const Real trace = mapped.strain.trace;
      const auto moved = either(mapped.scale < one, either(trace<strain.trace, trace> strain.trace));
      S = select(either(moved, limited), projected, S);
      drift_scale = mapped.scale;
      S = select(alone, zero_symmetric<Real>(), S);
      if constexpr (Law::has_history) team.set_own_value(p, histories, 1, 0, mapped.history);
    }
    if (stresses != nullptr) keep_stress(team, p, H);
    if constexpr (NonAffine) {
      // Within half a kernel radius, where the picture of a small displacement ends; and not NaN.
      const Real strain_squared = maximum(Real(drift_stiffness) * dot(motion.drift, motion.drift), Real(1e-30f));
      const Real bounded = minimum(drift_scale, square_root(Real(greatest_drift * greatest_drift) / strain_squared));
      Vec3<Real> drift = bounded * motion.drift;
      const auto kept = both(opposite(alone), dot(drift, drift) < Real(1e12f));
      drift = select(kept, drift, Vec3<Real>{zero, zero, zero});
      team.set_own_value(p, drifts, 3, 0, drift.x);
      team.set_own_value(p, drifts, 3, 1, drift.y);
      team.set_own_value(p, drifts, 3, 2, drift.z);
    }
    // Should numbers ever run away, a particle forgets its strain instead of spreading NaN.
    S = select(frobenius_squared(S) < Real(1e12f), S, zero_symmetric<Real>());
    const Real values[6] = {S.xx, S.yy, S.zz, S.xy, S.xz, S.yz};
    for (int i = 0; i < 6; ++i) team.set_own_value(p, strains, 6, i, values[i]);
  }

private:
  // tau = sigma D^T, with sigma = -T / (h V0) of the multiplier's state.
  template <class Team>
  LOAM_FN void keep_stress(Team &team, typename Team::Item p, const Mat3<typename Team::Real> &H) const {
    using Real = typename Team::Real;
    Mat3<Real> sigma, D = H;
    for (int i = 0; i < 9; ++i) sigma.m[i / 3][i % 3] = team.field(p, Record::multiplier + i);
    for (int i = 0; i < 3; ++i) D.m[i][i] = D.m[i][i] + Real(1.0f);
    Sym3<Real> tau = symmetric_part(multiply_transposed(sigma, D));
    // The faster matter deforms, the less its stress says of the next substep's: what hits hard starts from zero.
    const Real deformed = frobenius_squared(symmetric_part(H));
    const Real share = maximum(Real(1.0f) - deformed * Real(1.0f / (greatest_slow * greatest_slow)), Real(0.0f));
    tau = share * tau;
    tau = select(frobenius_squared(tau) < Real(1e36f), tau, zero_symmetric<Real>()); // not NaN
    const Real values[6] = {tau.xx, tau.yy, tau.zz, tau.xy, tau.xz, tau.yz};
    for (int i = 0; i < 6; ++i) team.set_own_value(p, stresses, 6, i, values[i]);
    if constexpr (NonAffine) {
      Vec3<Real> drift = share * team.vector(p, Record::drift_multiplier);
      drift = select(dot(drift, drift) < Real(1e12f), drift, Vec3<Real>{Real(0.0f), Real(0.0f), Real(0.0f)});
      team.set_own_value(p, answered_drifts, 3, 0, drift.x);
      team.set_own_value(p, answered_drifts, 3, 1, drift.y);
      team.set_own_value(p, answered_drifts, 3, 2, drift.z);
    }
  }
};

} // namespace loam
