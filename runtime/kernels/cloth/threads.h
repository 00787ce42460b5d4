// The threads of a cloth: chains of edges along warp and weft that are hardly longer than at rest. A chain is solved as a whole.
//
// Constraints that are solved one by one pass a load on by an edge a visit, so that a few iterations on a long sheet leave it hanging on rubber. Fabric does not stretch
// much, however: a thread bears whatever it must. Its links are one-sided constraints on their lengths,
//
//   C_j = |x_j+1 - x_j| - l_j <= 0        l_j = rest length times (1 + greatest stretch)
//
// and the tensions p_j (impulses) that answer them in a visit are those of the whole chain, from a tridiagonal system, exact in one go for a chain of any length:
//
//   (w_j + w_j+1 + a_j / h^2) p_j - w_j n_j.n_j-1 p_j-1 - w_j+1 n_j.n_j+1 p_j+1 = (C_j - a_j T_j) / h
//
// with w the inverse masses, n_j the link's direction, T_j its tension so far and a_j a small compliance. A link that is slack and bears nothing has no part in it. A tension
// that would push is none. At rest, threads that are shorter than their greatest length bear nothing: the stiffness of the membrane alone says how the cloth hangs.
#pragma once

#include "kernels/cloth/membrane.h"

namespace loam {

// What a thread keeps at each of its vertices, for the link to the next.
struct LinkField {
  enum : int {
    greatest_length = 0, // m
    compliance,          // m/N
    edge,                // 3: at the start of the substep, m
    tension = 5,         // N
    direction = 6,       // 3
    coupling = 9,        // of the elimination
    impulse = 10,        // N s
    bound = 11,          // m: the length that is allowed in this substep
    count = 12
  };
  static constexpr int vertices = 1;
};

// A thread's places: starts[batch] is the first of a batch's.
struct ClothThreads {
  ClothConstraints places;
  const int *starts;
};

// A link that is too long already gets no longer, and loses the excess over a few substeps: all at once would be a velocity.
constexpr float kept_excess = 0.5f;

struct PrepareThreads {
  ClothThreads threads;
  const Row *positions;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item i) const {
    using F = LinkField;
    using Real = typename Team::Real;
    const ClothConstraints &places = threads.places;
    const int links = team.place_count(threads.starts, i) - 1;
    Vec3<Real> x = team.template row<F>(places, team.place(threads.starts, i, 0), 0, positions).xyz();
    for (int j = 0; j < links; ++j) {
      const Vec3<Real> next = team.template row<F>(places, team.place(threads.starts, i, j + 1), 0, positions).xyz();
      const auto link = team.place(threads.starts, i, j);
      const Vec3<Real> edge = next - x;
      team.template set_vector<F>(places, link, F::edge, edge);
      const Real longest = team.template field<F>(places, link, F::greatest_length), zero(0.0f);
      team.template set_field<F>(places, link, F::bound,
                                 longest + Real(kept_excess) * maximum(length(edge) - longest, zero));
      team.template set_field<F>(places, link, F::tension, Real(0.0f));
      x = next;
    }
  }
};

// A link that is shorter than its bound by less than this share of it has a part in the visit: it gets no longer. The links above it would otherwise be
// pulled away from what hangs on it, and a load would travel down a thread by one link a visit.
constexpr float nearly_taut = 0.02f;

struct SolveThreads {
  ClothThreads threads;
  Row *velocities;
  float substep;

  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item i) const {
    using F = LinkField;
    using Real = typename Team::Real;
    const ClothConstraints &places = threads.places;
    const Real h(substep), inverse_h(1.0f / substep), zero(0.0f), one(1.0f);
    const int links = team.place_count(threads.starts, i) - 1;

    // Elimination, from the first link to the last.
    Vec4<Real> v = team.template row<F>(places, team.place(threads.starts, i, 0), 0, velocities);
    Vec3<Real> n_before = {zero, zero, zero};
    Real pivot_before = zero,
         impulse_before = zero; // 1 / pivot of the row before, 0 if it has no part; its right side over its pivot
    auto some = zero > zero;
    for (int j = 0; j < links; ++j) {
      const auto link = team.place(threads.starts, i, j);
      const Vec4<Real> next = team.template row<F>(places, team.place(threads.starts, i, j + 1), 0, velocities);
      const Vec3<Real> e = team.template vector<F>(places, link, F::edge) + h * (next.xyz() - v.xyz());
      const Real size = length(e), tension = team.template field<F>(places, link, F::tension);
      const Real compliance = team.template field<F>(places, link, F::compliance);
      const Vec3<Real> n = (one / maximum(size, Real(1e-12f))) * e;
      const Real bound = team.template field<F>(places, link, F::bound), excess = size - bound;
      const auto loaded = tension > zero;
      const auto bears = either(excess > Real(0.0f - nearly_taut) * bound, loaded);
      const Real missing = select(loaded, excess, maximum(excess, zero));
      some = either(some, bears);
      const Real bond = select(bears, v.w * dot(n, n_before), zero);
      const Real coupling = bond * pivot_before; // minus the factor of this row's impulse in the row before
      const Real pivot = ((v.w + next.w) + compliance * (inverse_h * inverse_h)) - bond * coupling;
      const auto can = both(bears, pivot > zero);
      const Real inverse_pivot = select(can, one / select(can, pivot, one), zero);
      const Real right = inverse_h * (missing - compliance * tension) + bond * impulse_before;
      team.template set_vector<F>(places, link, F::direction, n);
      team.template set_field<F>(places, link, F::coupling, coupling);
      team.template set_field<F>(places, link, F::impulse, inverse_pivot * right);
      pivot_before = inverse_pivot;
      impulse_before = inverse_pivot * right;
      n_before = n;
      v = next;
    }
    if (!any(some)) return;

    // Back, with the velocities.
    Vec3<Real> behind = {zero, zero, zero}; // the impulse of the link behind on its first vertex
    Real impulse = zero, factor = zero;     // of the link behind, and what it adds to the impulse of the one before it
    for (int j = links - 1; j >= -1; --j) {
      Vec3<Real> own = {zero, zero, zero};
      Real own_impulse = zero, own_factor = zero;
      if (j >= 0) {
        const auto link = team.place(threads.starts, i, j);
        const Real tension = team.template field<F>(places, link, F::tension);
        const Real wanted = tension + inverse_h * (team.template field<F>(places, link, F::impulse) + factor * impulse);
        const Real kept = maximum(wanted, zero);
        own_impulse = h * (kept - tension);
        own_factor = team.template field<F>(places, link, F::coupling);
        team.template set_field<F>(places, link, F::tension, kept);
        own = own_impulse * team.template vector<F>(places, link, F::direction);
      }
      const auto vertex = team.place(threads.starts, i, j + 1);
      Vec4<Real> u = team.template row<F>(places, vertex, 0, velocities);
      add_velocity(u, u.w * (behind - own));
      team.template set_row<F>(places, vertex, 0, velocities, u);
      behind = own;
      impulse = own_impulse;
      factor = own_factor;
    }
  }
};

} // namespace loam
