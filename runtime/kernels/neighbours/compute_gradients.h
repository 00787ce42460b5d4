// Corrected kernel gradients G_b = V_b L_p grad W_b and all that a constraint needs to know of its neighbourhood in O(1).
//
//   L = pinv( sum_b V_b gradW_b (x_b - x_p)^T )   makes the gradient of a linear field exact (equation 6)
//   M = sum_b w_b G_b G_b^T,  s = sum_b G_b       make the denominator of a visit independent of the number of neighbours
//
// The pseudo-inverse cuts eigenvalues below an absolute share of 1, the value of a full neighbourhood: a lone pair, a line or a sheet of
// particles has directions along which nothing is known, and must not be blown up there.
#pragma once

#include "kernels/inelastic/record.h"
#include "kernels/neighbours/meetings.h"
#include "kernels/neighbours/smoothing_kernel.h"
#include "math/tensor_functions.h"

namespace loam {

// With eigenvalues over the cut-off everywhere this is the plain inverse; positive leading minors of A - cutoff I tell.
// `unknown` receives the directions that were cut, as kinematics.h keeps them.
template <class T> LOAM_FN Sym3<T> pseudo_inverse(const Sym3<T> &A, float cutoff, Vec3<T> &unknown) {
  const T zero(0.0f), one(1.0f), least(cutoff);
  const Sym3<T> B = add_diagonal(A, zero - least);
  const auto regular = both(both(B.xx > zero, B.xx * B.yy - B.xy * B.xy > zero), determinant(B) > zero);
  const Sym3<T> identity = {one, one, one, zero, zero, zero};
  Sym3<T> result = inverse(select(regular, A, identity));
  unknown = {zero, zero, zero};
  if (any(opposite(regular))) {
    const Eigen3<T> eigen = eigen_decomposition(A);
    T reciprocal[3], rank = zero;
    Vec3<T> lost = unknown, known = unknown;
    for (int k = 0; k < 3; ++k) {
      const auto kept = eigen.values[k] > least;
      reciprocal[k] = select(kept, one / select(kept, eigen.values[k], one), zero);
      const Vec3<T> direction = {eigen.vectors.m[0][k], eigen.vectors.m[1][k], eigen.vectors.m[2][k]};
      lost = select(kept, lost, direction);
      known = select(kept, direction, known);
      rank = rank + select(kept, one, zero);
    }
    const auto plane = both(rank > T(1.5f), rank < T(2.5f)), line = both(rank > T(0.5f), rank < T(1.5f));
    const auto cut = opposite(regular);
    unknown = select(both(cut, plane), lost, select(both(cut, line), T(2.0f) * known, unknown));
    result = select(regular, result, from_eigen(eigen.vectors, reciprocal));
  }
  return result;
}

// With NonAffine, what resists zero-energy modes too: see kernels/inelastic/non_affine.h.
template <bool NonAffine> struct ComputeGradients {
  const Row *positions;  // x, y, z, true volume
  const Row *velocities; // fourth component: inverse mass
  const float *strains;
  const float *histories; // may be null: no law of this world has a history
  const float *drifts;    // 3 a particle; null without NonAffine
  const float *rest_volumes;
  const int *neighbour_counts;
  const int *close_counts;
  float *corrections; // null unless the Jacobi solver needs L
  SmoothingKernel kernel;
  float cutoff;
  int record_size; // fields of a record in this world
  Meetings meetings;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec3<Lane> center = team.spread(team.own_row(p, positions).xyz());
    Sym3<Lane> moment = zero_symmetric<Lane>(), weighted = zero_symmetric<Lane>();
    Vec3<Lane> total = {Lane(0.0f), Lane(0.0f), Lane(0.0f)};
    for (auto k : team.neighbours(p)) {
      const Vec4<Lane> x = team.neighbour_row(k, positions);
      const Vec3<Lane> d = x.xyz() - center;
      Lane factor = kernel.gradient_factor(square_root(dot(d, d))) * x.w;
      if (meetings.any()) factor = factor * meetings.shared(team, k);
      const Vec3<Lane> g = factor * d;
      team.set_gradient(k, g);
      const Lane w = neighbour_weight(team, k);
      add_square(moment, factor, d);
      add_square(weighted, w, g);
      total = total + g;
    }
    Vec3<Real> unknown;
    const Sym3<Real> L = pseudo_inverse(team.sum(moment), cutoff, unknown);
    const Mat3<Real> full_L = full(L);
    const Mat3<Real> M = full_L * (full(team.sum(weighted)) * full_L);
    const Vec3<Real> s = L * team.sum(total);

    const Mat3<Lane> spread_L = team.spread(full_L);
    if constexpr (!NonAffine) {
      for (auto k : team.neighbours(p)) team.set_gradient(k, spread_L * team.gradient(k));
    } else {
      // kappa = 1 / sum |G|^2, m = kappa sum |G|^2 d; and with phi_b = kappa |G_b|^2 - m . G_b
      //   nu = sum w_b phi_b^2 + w_p (sum phi_b)^2 = kappa^2 sum w |G|^4 - 2 kappa m . sum w |G|^2 G + m . M m + w_p (1 - m . s)^2
      const Lane zero_lane(0.0f);
      Lane squares = zero_lane, fourth_powers = zero_lane;
      Vec3<Lane> offsets = {zero_lane, zero_lane, zero_lane}, cubes = offsets;
      for (auto k : team.neighbours(p)) {
        const Vec3<Lane> g = spread_L * team.gradient(k);
        team.set_gradient(k, g);
        const Vec3<Lane> d = team.neighbour_row(k, positions).xyz() - center;
        const Lane square = dot(g, g), w = neighbour_weight(team, k);
        squares = squares + square;
        offsets = offsets + square * d;
        fourth_powers = fourth_powers + (w * square) * square;
        cubes = cubes + (w * square) * g;
      }
      const Real zero(0.0f), one(1.0f), sum = team.sum(Vec3<Lane>{squares, fourth_powers, zero_lane}).x;
      const auto any_gradient = sum > zero;
      const Real scale = select(any_gradient, one / select(any_gradient, sum, one), zero);
      const Vec3<Real> m = scale * team.sum(offsets);
      const Real fourth = team.sum(Vec3<Lane>{squares, fourth_powers, zero_lane}).y;
      const Real own_share = select(any_gradient, one, zero) - dot(m, s);
      const Real response = scale * scale * fourth - (scale + scale) * dot(m, team.sum(cubes)) + dot(m, M * m) +
                            own_weight(team, p) * own_share * own_share;
      team.set_vector(p, Record::weight_moment, m);
      team.set_field(p, Record::weight_scale, scale);
      team.set_field(p, Record::drift_response, maximum(response, zero));
      for (int i = 0; i < 3; ++i) {
        team.set_field(p, Record::drift + i, team.own_value(p, drifts, 3, i));
        team.set_field(p, Record::drift_multiplier + i, zero);
      }
    }

    team.set_symmetric(p, Record::gradient_square, symmetric_part(M));
    team.set_vector(p, Record::gradient_sum, s);
    team.set_vector(p, Record::unknown, unknown);
    for (int i = 0; i < 6; ++i) team.set_field(p, Record::strain + i, team.own_value(p, strains, 6, i));
    if (corrections != nullptr) {
      const Real l[6] = {L.xx, L.yy, L.zz, L.xy, L.xz, L.yz};
      for (int i = 0; i < 6; ++i) team.set_own_value(p, corrections, 6, i, l[i]);
    }
    team.set_field(p, Record::inverse_mass, own_weight(team, p));
    team.set_field(p, Record::inverse_volume, Real(1.0f) / team.own_value(p, rest_volumes, 1, 0));
    team.set_field(p, Record::history, histories != nullptr ? team.own_value(p, histories, 1, 0) : Real(0.0f));
    team.set_field(p, Record::close_count, team.own_count(p, close_counts));
    team.set_field(p, Record::pair_moment, Real(0.0f));
    const int state_end = record_size < Record::drift_multiplier ? record_size : static_cast<int>(Record::drift_multiplier);
    for (int i = Record::multiplier; i < state_end; ++i) team.set_field(p, i, Real(0.0f));
  }

  // Inverse masses as the constraints see them: split among those that share a particle where all act at once.
  template <class Team, class Neighbour> LOAM_FN typename Team::Lane neighbour_weight(Team &team, const Neighbour &k) const {
    using Lane = typename Team::Lane;
    const Lane w = team.neighbour_row(k, velocities).w;
    return corrections == nullptr ? w : w * (Lane(1.0f) + team.neighbour_count(k, neighbour_counts));
  }
  template <class Team> LOAM_FN typename Team::Real own_weight(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Real w = team.own_row(p, velocities).w;
    return corrections == nullptr ? w : w * (Real(1.0f) + team.own_count(p, neighbour_counts));
  }
};

} // namespace loam
