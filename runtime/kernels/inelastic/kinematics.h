// Kinematics of a neighbourhood: the velocity gradient and what it does to the elastic strain.
#pragma once

#include "math/matrix.h"

namespace loam {

// H = h grad v = h (sum_b v_b G_b^T - v_p s^T), with G_b = V_b L_p grad W_b (equation 6 of the XPBI paper, corrected kernel gradients).
template <class Team>
LOAM_FN Mat3<typename Team::Real> velocity_gradient_step(Team &team, typename Team::Item p, float substep,
                                                         Vec3<typename Team::Real> own,
                                                         Vec3<typename Team::Real> gradient_sum) {
  using Lane = typename Team::Lane;
  using Real = typename Team::Real;
  Mat3<Lane> sum = zero_matrix<Lane>();
  for (auto k : team.neighbours(p)) add_outer(sum, team.neighbour_velocity(k).xyz(), team.gradient(k));
  return Real(substep) * (team.sum(sum) - outer(own, gradient_sum));
}

// b - I of D b D^T with D = I + H, from S = b - I, without ever adding I: float32 keeps its relative accuracy for small strains.
template <class T> LOAM_FN Sym3<T> advance_strain(const Sym3<T> &S, const Mat3<T> &H) {
  const Mat3<T> U = H * full(S) + H; // H b, so that D b D^T - I = S + U + U^T + U H^T
  const auto change = [&](int i, int j) {
    return (U.m[i][j] + U.m[j][i]) + (U.m[i][0] * H.m[j][0] + (U.m[i][1] * H.m[j][1] + U.m[i][2] * H.m[j][2]));
  };
  return {S.xx + change(0, 0), S.yy + change(1, 1), S.zz + change(2, 2),
          S.xy + change(0, 1), S.xz + change(0, 2), S.yz + change(1, 2)};
}

} // namespace loam
