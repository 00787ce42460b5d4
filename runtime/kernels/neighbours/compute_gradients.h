// Corrected kernel gradients G_b = V_b L_p grad W_b and all that a constraint needs to know of its neighbourhood in O(1).
//
//   L = pinv( sum_b V_b gradW_b (x_b - x_p)^T )   makes the gradient of a linear field exact (equation 6)
//   M = sum_b w_b G_b G_b^T,  s = sum_b G_b       make the denominator of a visit independent of the number of neighbours
//
// The pseudo-inverse cuts eigenvalues below an absolute share of 1, the value of a full neighbourhood: a lone pair, a line or a sheet of
// particles has directions along which nothing is known, and must not be blown up there.
#pragma once

#include "kernels/inelastic/record.h"
#include "kernels/neighbours/smoothing_kernel.h"
#include "math/tensor_functions.h"

namespace loam {

// With eigenvalues over the cut-off everywhere this is the plain inverse; positive leading minors of A - cutoff I tell.
template <class T> LOAM_FN Sym3<T> pseudo_inverse(const Sym3<T> &A, float cutoff) {
  const T zero(0.0f), one(1.0f), least(cutoff);
  const Sym3<T> B = add_diagonal(A, zero - least);
  const auto regular = both(both(B.xx > zero, B.xx * B.yy - B.xy * B.xy > zero), determinant(B) > zero);
  const Sym3<T> identity = {one, one, one, zero, zero, zero};
  Sym3<T> result = inverse(select(regular, A, identity));
  if (any(opposite(regular))) {
    const Eigen3<T> eigen = eigen_decomposition(A);
    T reciprocal[3];
    for (int k = 0; k < 3; ++k) {
      const auto kept = eigen.values[k] > least;
      reciprocal[k] = select(kept, one / select(kept, eigen.values[k], one), zero);
    }
    result = select(regular, result, from_eigen(eigen.vectors, reciprocal));
  }
  return result;
}

struct ComputeGradients {
  const Row *positions;  // x, y, z, true volume
  const Row *velocities; // fourth component: inverse mass
  const float *strains;
  const float *histories; // may be null: no law of this world has a history
  const float *rest_volumes;
  const int *neighbour_counts;
  const int *close_counts;
  float *corrections; // null unless the Jacobi solver needs L
  SmoothingKernel kernel;
  float cutoff;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Lane = typename Team::Lane;
    using Real = typename Team::Real;
    const Vec3<Lane> center = team.spread(team.own_row(p, positions).xyz());
    Sym3<Lane> moment = zero_symmetric<Lane>(), weighted = zero_symmetric<Lane>();
    Vec3<Lane> total = {Lane(0.0f), Lane(0.0f), Lane(0.0f)};
    for (auto k : team.neighbours(p)) {
      const Vec4<Lane> x = team.neighbour_row(k, positions);
      const Vec3<Lane> d = x.xyz() - center;
      const Lane factor = kernel.gradient_factor(square_root(dot(d, d))) * x.w;
      const Vec3<Lane> g = factor * d;
      team.set_gradient(k, g);
      Lane w = team.neighbour_row(k, velocities).w;
      if (corrections != nullptr) w = w * (Lane(1.0f) + team.neighbour_count(k, neighbour_counts)); // split masses
      add_square(moment, factor, d);
      add_square(weighted, w, g);
      total = total + g;
    }
    const Sym3<Real> L = pseudo_inverse(team.sum(moment), cutoff);
    const Mat3<Real> full_L = full(L);
    const Mat3<Real> M = full_L * (full(team.sum(weighted)) * full_L);
    const Vec3<Real> s = L * team.sum(total);

    const Mat3<Lane> spread_L = team.spread(full_L);
    for (auto k : team.neighbours(p)) team.set_gradient(k, spread_L * team.gradient(k));

    team.set_symmetric(p, Record::gradient_square, symmetric_part(M));
    team.set_vector(p, Record::gradient_sum, s);
    for (int i = 0; i < 6; ++i) team.set_field(p, Record::strain + i, team.own_value(p, strains, 6, i));
    Real w = team.own_row(p, velocities).w;
    if (corrections != nullptr) {
      w = w * (Real(1.0f) + team.own_count(p, neighbour_counts));
      const Real l[6] = {L.xx, L.yy, L.zz, L.xy, L.xz, L.yz};
      for (int i = 0; i < 6; ++i) team.set_own_value(p, corrections, 6, i, l[i]);
    }
    team.set_field(p, Record::inverse_mass, w);
    team.set_field(p, Record::inverse_volume, Real(1.0f) / team.own_value(p, rest_volumes, 1, 0));
    team.set_field(p, Record::history, histories != nullptr ? team.own_value(p, histories, 1, 0) : Real(0.0f));
    team.set_field(p, Record::close_count, team.own_count(p, close_counts));
    team.set_field(p, Record::pair_moment, Real(0.0f));
    for (int i = Record::multiplier; i < Record::field_count; ++i) team.set_field(p, i, Real(0.0f));
  }
};

} // namespace loam
