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

// Where the neighbours lie in a plane or on a line (or close to it), the corrected gradients have no part along the rest, and a rotation would look like a shear. Let N
// project onto the unknown directions. H is completed so that they take part in the rotation and are not strained, H <- H - H^T N, and an
// impulse tensor loses what would strain them, T <- T - N T^T: the transposed map, so that impulses keep angular momentum.
//
// N is kept as a vector q: one unknown direction is q itself, of length 1; of two, q is the known direction with length 2; none is 0.
template <class T> struct UnknownDirections {
  T isotropic, along; // N = isotropic I + along q q^T
  Vec3<T> q;
};
template <class T> LOAM_FN UnknownDirections<T> unknown_directions(Vec3<T> q) {
  const auto two = dot(q, q) > T(2.0f);
  return {select(two, T(1.0f), T(0.0f)), select(two, T(-0.25f), T(1.0f)), q};
}
template <class T> LOAM_FN Mat3<T> complete_gradient(const Mat3<T> &H, Vec3<T> q) {
  const auto some = dot(q, q) > T(0.0f);
  if (!any(some)) return H;
  const UnknownDirections<T> n = unknown_directions(q);
  const Vec3<T> column = {H.m[0][0] * q.x + (H.m[1][0] * q.y + H.m[2][0] * q.z),
                          H.m[0][1] * q.x + (H.m[1][1] * q.y + H.m[2][1] * q.z),
                          H.m[0][2] * q.x + (H.m[1][2] * q.y + H.m[2][2] * q.z)}; // H^T q
  return select(some, H - (n.isotropic * transpose(H) + outer(n.along * column, q)),
                H); // of others, 0 times infinity is none
}
template <class T> LOAM_FN Mat3<T> restrict_impulse(const Mat3<T> &impulse, Vec3<T> q) {
  const auto some = dot(q, q) > T(0.0f);
  if (!any(some)) return impulse;
  const UnknownDirections<T> n = unknown_directions(q);
  // N T^T = isotropic T^T + along q (T q)^T
  return select(some, impulse - (n.isotropic * transpose(impulse) + outer(n.along * q, impulse * q)), impulse);
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
