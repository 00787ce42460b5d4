// Position correction: particles keep a least distance, |x_p - x_b| >= d_min, at the end of the substep (section 4.4 of the XPBI paper).
//
// It acts on the velocity, inside the solve loop: shifting positions afterwards would let F lie about the shape. Each close pair is owned by one of its
// ends and stands first in the owner's list. A visit takes the owner's pairs in turn, so it is sequential for a team of any kind.
//
// Particles of materials that meet by contact (meetings.h) keep `contact_distance` instead, with Coulomb friction on what each visit pushes them apart.
#pragma once

#include "kernels/inelastic/record.h"
#include "kernels/neighbours/meetings.h"
#include "math/matrix.h"

namespace loam {

// Coincident particles have no direction to part in: they take one by turns.
LOAM_FN Vec3<float> fallback_direction(int turn) {
  const float a = 0.57735027f;
  return {(turn & 1) != 0 ? a : -a, (turn & 2) != 0 ? a : -a, (turn & 4) != 0 ? a : -a};
}

struct CorrectPositions {
  const Row *positions;
  float substep;
  float least_distance, contact_distance;
  float share; // of the violation that one visit removes: 1 in turn, less for all at once
  Vec3<float> up;
  Meetings meetings;

  // The distance that a pair keeps; `friction` as in Meetings.
  template <class T> LOAM_FN T kept_distance(T friction) const {
    const T kept = select(friction < T(0.0f), T(least_distance), T(contact_distance));
    return select(friction < T(-1.5f), T(0.0f), kept);
  }

  // Most pairs are far enough apart: then there is nothing to do, and nothing to write.
  template <class T> LOAM_FN auto violated(Vec3<T> d, T least, T turn, T close) const {
    return both(dot(d, d) < least * least, turn < close);
  }

  // One-sided: the pair's impulse along its direction and, in contact, against its sliding at `velocity`; and its moment.
  template <class T, class Mask>
  LOAM_FN Vec3<T> impulse(Vec3<T> d, Vec3<T> velocity, T least, T friction, T weight, Mask active, int turn,
                          T &moment) const {
    const T zero(0.0f), one(1.0f), h(substep);
    const T squared = dot(d, d);
    const auto coincident = squared < T(1e-10f) * least * least;
    const Vec3<float> f = fallback_direction(turn);
    const T distance = square_root(squared);
    const T reciprocal = one / select(coincident, one, distance);
    const Vec3<T> n = select(coincident, Vec3<T>{T(f.x), T(f.y), T(f.z)}, reciprocal * d);
    const T violation = maximum(least - distance, zero);
    const auto movable = weight > zero;
    const T change = select(movable, T(share) * violation / (h * select(movable, weight, one)), zero);
    const T along = n.x * T(up.x) + (n.y * T(up.y) + n.z * T(up.z));
    moment = moment + select(active, change * along * along * distance, zero);
    Vec3<T> result = change * n;
    if (meetings.any()) {
      const Vec3<T> sliding = velocity - dot(n, velocity) * n;
      const T speed = square_root(dot(sliding, sliding));
      const auto slides = both(friction > zero, speed > T(1e-12f));
      const T most = minimum(friction * change, select(movable, speed / select(movable, weight, one), zero));
      result = result - select(slides, most / select(slides, speed, one), zero) * sliding;
    }
    return select(active, result, Vec3<T>{zero, zero, zero});
  }
};

// Gauss-Seidel: colours as for the constraints.
struct CorrectPositionsInTurn : CorrectPositions {
  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p);
    const Vec3<Real> x = team.own_row(p, positions).xyz();
    Vec3<Real> v = own.xyz();
    const Real close = team.field(p, Record::close_count), h(substep);
    Real moment = team.field(p, Record::pair_moment);
    int turn = 0;
    for (auto k : team.close_neighbours(p)) {
      const Vec4<Real> other = team.neighbour_velocity(k);
      const Vec3<Real> d = (x - team.neighbour_row(k, positions).xyz()) + h * (v - other.xyz());
      Real friction(-1.0f);
      if (meetings.any()) friction = meetings.friction(team, k);
      const Real least = kept_distance(friction);
      const auto too_near = violated(d, least, Real(static_cast<float>(turn)), close);
      ++turn;
      if (!any(too_near)) continue;
      const Vec3<Real> j = impulse(d, v - other.xyz(), least, friction, own.w + other.w, too_near, turn, moment);
      const Vec3<Real> u = other.xyz() - other.w * j;
      team.set_neighbour_velocity(k, {u.x, u.y, u.z, other.w});
      v = v + own.w * j;
    }
    team.set_velocity(p, {v.x, v.y, v.z, own.w});
    team.set_field(p, Record::pair_moment, moment);
  }
};

// Jacobi: every particle sums its own side of all its close pairs; the result goes to another array, so nobody reads what is being written.
struct CorrectPositionsAtOnce : CorrectPositions {
  Row *corrected;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p);
    const Vec3<Real> x = team.own_row(p, positions).xyz();
    Vec3<Real> sum = {Real(0.0f), Real(0.0f), Real(0.0f)};
    const Real close = team.field(p, Record::close_count), h(substep);
    Real moment(0.0f);
    int turn = 0;
    for (auto k : team.close_neighbours(p)) {
      const Vec4<Real> other = team.neighbour_velocity(k);
      const Vec3<Real> d = (x - team.neighbour_row(k, positions).xyz()) + h * (own.xyz() - other.xyz());
      Real friction(-1.0f);
      if (meetings.any()) friction = meetings.friction(team, k);
      const Real least = kept_distance(friction);
      const auto too_near = violated(d, least, Real(static_cast<float>(turn)), close);
      ++turn;
      if (!any(too_near)) continue;
      sum = sum + impulse(d, own.xyz() - other.xyz(), least, friction, own.w + other.w, too_near, turn, moment);
    }
    const Vec3<Real> v = own.xyz() + own.w * sum;
    team.set_own_row(p, corrected, {v.x, v.y, v.z, own.w});
    // each pair is seen from both its ends
    team.set_field(p, Record::pair_moment, team.field(p, Record::pair_moment) + Real(0.5f) * moment);
  }
};

} // namespace loam
