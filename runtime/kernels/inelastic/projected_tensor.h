// The projected impulse tensor: the multiplier form that reaches the true implicit step.
//
// The impulses of a constraint on its neighbours are T G_b with one 3x3 tensor T that accumulates over the visits of a substep; its target is that of the
// implicit step, T* = -h V0 tau D^-T with the Kirchhoff stress tau at the end of the substep. So a visit does not pile an impulse along today's gradient onto
// those along yesterday's, as the scalar form does, but corrects what was applied. Kept is the stress that the impulses stand for,
// sigma = -T / (h V0). A visit
//
//   1. takes the stress of the trial strain as if matter were elastic, R = tau D^-T - sigma,
//   2. goes as far towards it as the neighbours' inertia allows. N = M + w_p s s^T says how an impulse moves the velocity gradient, and a = h^2 V0. The mean part takes
//      the step vol R / (1 + 3 K a tr N / 3), which is exact; the deviator dev R / (1 + 2 mu a n), less what the first has done to it, with n a bound on the
//      eigenvalues of N, tr N / 3 + sqrt(2/3) |dev N|: no impulse overshoots, so an iteration lowers the energy of the step, also where step 3 bends it,
//   3. maps the strain that belongs to the result, S sym(sigma D^T) with S the elastic compliance, onto the yield surface: a projected Gauss-Seidel step. Plastic strain
//      meets only the share 1 / (1 + 2 mu a n) of the moduli, since the rest of the step moved the neighbours; rate-dependent laws are told (Flow).
//
// Where zero-energy modes are resisted, the drift (non_affine.h) is treated alike: one more spring of stiffness k = 2 mu V0 stiffness / r^2, whose impulse
// -h k y along n_p stands for a drift y.
#pragma once

#include "kernels/inelastic/constraint.h"
#include "kernels/inelastic/deformation.h"
#include "kernels/materials/project.h"

namespace loam {

// theta = <P, S R> / (<P, S P> + reach <P, P N>), with S X = dev X deviator_compliance + vol X volume_compliance; 1 where P vanishes.
template <class T>
LOAM_FN T best_along(const Mat3<T> &P, const Mat3<T> &R, const Mat3<T> &N, T deviator_compliance, T volume_compliance,
                     T reach) {
  const T zero(0.0f), one(1.0f), third(1.0f / 3.0f);
  const Mat3<T> PN = P * N;
  T PR = zero, PP = zero, PPN = zero;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      PR = PR + P.m[i][j] * R.m[i][j];
      PP = PP + P.m[i][j] * P.m[i][j];
      PPN = PPN + P.m[i][j] * PN.m[i][j];
    }
  const T trace_P = P.m[0][0] + (P.m[1][1] + P.m[2][2]), trace_R = R.m[0][0] + (R.m[1][1] + R.m[2][2]);
  const T mean_PR = third * trace_P * trace_R, mean_PP = third * trace_P * trace_P;
  const T along = (PR - mean_PR) * deviator_compliance + mean_PR * volume_compliance;
  const T curvature = (PP - mean_PP) * deviator_compliance + mean_PP * volume_compliance + reach * PPN;
  const auto moving = curvature > zero;
  return select(moving, along / select(moving, curvature, one), one);
}

template <bool NonAffine> struct ProjectedTensor {
  static constexpr bool non_affine = NonAffine;
  static constexpr int state_count = NonAffine ? 12 : 9;
  static constexpr float greatest_small = 0.02f; // |h grad v| of a motion that counts as small
  float drift_stiffness;                         // stiffness / r^2; unused without NonAffine

  // `state`: sigma row by row, then y.
  template <class Law, class Real>
  LOAM_FN Impulse<Real> visit(const Law &law, StrainLimit limit, const Constraint<Real> &c,
                              Real (&state)[state_count]) const {
    const Real zero(0.0f), one(1.0f), three(3.0f), third(1.0f / 3.0f), h(c.substep);
    const Real volume = one / c.inverse_volume, a = h * h * volume;
    const Real stiffness = law.stiffness(c.history);
    const Real twice_mu = Real(law.twice_mu()) * stiffness, bulk = Real(law.bulk()) * stiffness;
    const Real deviator_compliance = one / twice_mu, volume_compliance = third / bulk;

    Sym3<Real> trial = c.trial;
    auto limited = zero > zero;
    const HenckyStrain<Real> strain = hencky_strain(trial, limit, limited);
    const Sym3<Real> tau = add_diagonal(twice_mu * strain.deviator, bulk * law.elastic_trace(strain.trace, c.history));
    const Deformation<Real> D = deformation(c.H);

    Mat3<Real> sigma;
    for (int i = 0; i < 9; ++i) sigma.m[i / 3][i % 3] = state[i];
    const Mat3<Real> R = full(tau) * D.inverse_transpose - sigma;
    const Vec3<Real> s = c.gradient_sum;
    const Real w = c.inverse_mass;
    const Sym3<Real> M = c.gradient_square;
    const Sym3<Real> N = {M.xx + w * s.x * s.x, M.yy + w * s.y * s.y, M.zz + w * s.z * s.z,
                          M.xy + w * s.x * s.y, M.xz + w * s.x * s.z, M.yz + w * s.y * s.z};
    // Where the substep compresses matter strongly, stress answers more steeply than at rest: by |D^-1|^2.
    Real steepness = zero;
    for (int i = 0; i < 9; ++i) {
      const Real d = D.inverse_transpose.m[i / 3][i % 3];
      steepness = steepness + d * d;
    }
    const Real reach = a * maximum(third * steepness, one);
    // The mean part first: its step is exact. It moves the deviator of the trial too where inertia differs by direction.
    const Real mean_N = third * trace(N), mean = third * (R.m[0][0] + (R.m[1][1] + R.m[2][2]));
    const Sym3<Real> N_deviator = add_diagonal(N, zero - mean_N);
    const Real volumetric = one / (one + three * bulk * reach * mean_N), mean_step = volumetric * mean;
    const Real greatest_N = mean_N + Real(0.81649658f) * square_root(frobenius_squared(N_deviator)); // sqrt(2/3)
    const Real deviatoric = one / (one + twice_mu * reach * greatest_N);
    Mat3<Real> step = deviatoric * (R - full((twice_mu * reach * mean_step) * N_deviator));
    const Real diagonal = mean_step - deviatoric * mean;
    for (int i = 0; i < 3; ++i) step.m[i][i] = step.m[i][i] + diagonal;
    // Where nothing yields the model is quadratic, and its minimum along the step is farther out where inertia differs by direction. It is a model of small
    // motions: as the substep comes to deform matter by more, the step goes back to the one that is safe. Otherwise bodies that hit hard would burst.
    if constexpr (!Law::plastic) {
      Real deformed = zero;
      for (int i = 0; i < 9; ++i) deformed = deformed + c.H.m[i / 3][i % 3] * c.H.m[i / 3][i % 3];
      const Real small = maximum(one - deformed * Real(1.0f / (greatest_small * greatest_small)), zero);
      const Real theta = best_along(step, R, full(N), deviator_compliance, volume_compliance, reach);
      step = (one + small * (theta - one)) * step;
    }
    const Mat3<Real> relaxed_sigma = sigma + step;

    const Sym3<Real> relaxed_tau = symmetric_part(multiply_transposed(relaxed_sigma, D.gradient));
    const Real relaxed_mean = third * trace(relaxed_tau);
    const HenckyStrain<Real> relaxed = {three * volume_compliance * relaxed_mean,
                                        deviator_compliance * add_diagonal(relaxed_tau, zero - relaxed_mean)};
    const Flow<Real> flow = {c.substep, deviatoric, volumetric};

    Impulse<Real> impulse;
    Real other_squared = zero;
    Vec3<Real> drift = {zero, zero, zero}, relaxed_drift = drift;
    Real spring = zero; // h k
    if constexpr (NonAffine) {
      spring = h * twice_mu * volume * Real(drift_stiffness);
      drift = {state[9], state[10], state[11]};
      relaxed_drift = drift + (one / (one + h * spring * c.motion.response)) * (c.motion.drift - drift);
      other_squared = Real(drift_share * drift_stiffness) * dot(relaxed_drift, relaxed_drift);
    }
    const Projection<Real> projection = project(law, relaxed, other_squared, c.history, flow);
    const Sym3<Real> projected = add_diagonal(twice_mu * projection.strain.deviator, bulk * projection.strain.trace);
    const Mat3<Real> result = full(projected) * D.inverse_transpose;
    impulse.tensor = (zero - h * volume) * (result - sigma);
    for (int i = 0; i < 9; ++i) state[i] = result.m[i / 3][i % 3];
    if constexpr (NonAffine) {
      const Vec3<Real> answered = projection.scale * relaxed_drift;
      impulse.along_drift = (zero - spring) * (answered - drift);
      state[9] = answered.x;
      state[10] = answered.y;
      state[11] = answered.z;
    }
    return impulse;
  }

  template <class Law, class Real>
  LOAM_FN Residual<Real> residual(const Law &law, StrainLimit limit, const Constraint<Real> &c,
                                  Real (&state)[state_count]) const {
    Real before[9], zero(0.0f);
    for (int i = 0; i < 9; ++i) before[i] = state[i];
    visit(law, limit, c, state);
    Residual<Real> result = {zero, zero};
    for (int i = 0; i < 9; ++i) {
      const Real change = state[i] - before[i];
      result.change = result.change + change * change;
      result.value = result.value + state[i] * state[i];
    }
    return result;
  }
};

} // namespace loam
