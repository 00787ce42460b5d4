// The iterations of a substep start from the stress that the impulses of the last one stood for: they only have to find what has changed, so what is at rest is in
// equilibrium with any number of them. Without it, iterations that are cut short leave matter too soft.
//
// At the end of a substep T = -h V0 tau D^-T. In the next the gradients are those of the moved neighbourhood, D^-T G, so the same stress tau gives the same
// impulses -h V0 tau G: tau is what is kept (UpdateStrain), symmetric and independent of the substep, and beside it the drift that has been answered
// (non_affine.h). It is the multiplier's stress, not that of the strain: where iterations are cut short the strain is rough, and its stress would be
// rough impulses, amplified by the square of what a wave travels in a substep.
//
// What the start overshoots, the iterations must take back. They can while no wave crosses more kernel radii in a substep than `radii_per_iteration` times
// their number, and no neighbour is so light that it is moved by much more than the particle's own kind: elsewhere matter starts from zero. Measured
// on cantilevers: with 0.58 and 0.78 radii an iteration they rest where those solved exactly do, with 1.2 they shake. A block that hits sand a
// thousand times lighter gained energy without the second bound.
#pragma once

#include "kernels/inelastic/projected_tensor.h"
#include "kernels/inelastic/solve_inelastic.h"

namespace loam {

constexpr float radii_per_iteration = 2.0f / 3.0f;
constexpr float greatest_response = 1.6f; // over (c h / r)^2: 0.2 inside a body, 0.9 at its edges

template <class Law, class Multiplier> struct WarmStart {
  Law law;
  float substep;
  Multiplier multiplier;
  const float *stresses;        // 6 a particle: tau
  const float *answered_drifts; // 3 a particle; null without NonAffine
  float inverse_radius;         // 1 / r
  float iterations;             // 0: from zero

  // Sets the multiplier's state and answers with its impulse. Of the constraint it fills in what spread_impulse() reads.
  template <class Team>
  LOAM_FN Impulse<typename Team::Real> start(Team &team, typename Team::Item p, Constraint<typename Team::Real> &c) const {
    using Real = typename Team::Real;
    const Real zero(0.0f), one(1.0f), h(substep), most(iterations);
    c.gradient_sum = team.vector(p, Record::gradient_sum);
    c.unknown = team.vector(p, Record::unknown);
    const Real volume = one / team.field(p, Record::inverse_volume);
    const Real stiffness = law.stiffness(team.field(p, Record::history));
    const Real twice_mu = stiffness * Real(law.twice_mu()), bulk = stiffness * Real(law.bulk());

    // (c h / r)^2 with the particle's own mass, and what its stress does to the velocity gradient with those of its neighbours.
    const Real waves = (bulk + Real(2.0f / 3.0f) * twice_mu) * (volume * team.velocity(p).w) *
                       Real(substep * inverse_radius * (substep * inverse_radius));
    const Real N = trace(team.symmetric(p, Record::gradient_square)) +
                   team.field(p, Record::inverse_mass) * dot(c.gradient_sum, c.gradient_sum);
    const Real response = (twice_mu + bulk) * (h * h * volume) * (Real(1.0f / 3.0f) * N);
    const Real greatest_waves = Real(radii_per_iteration * radii_per_iteration) * (most * most);
    const auto held = team.velocity(p).w <= zero; // it has the neighbours' inertia only
    const auto safe =
        both(waves <= greatest_waves, response <= Real(greatest_response) * select(held, greatest_waves, waves));

    const auto kept = [&](int i) { return select(safe, team.own_value(p, stresses, 6, i), zero); };
    const Mat3<Real> sigma = full(Sym3<Real>{kept(0), kept(1), kept(2), kept(3), kept(4), kept(5)});
    for (int i = 0; i < 9; ++i) team.set_field(p, Record::multiplier + i, sigma.m[i / 3][i % 3]);
    Impulse<Real> impulse;
    impulse.tensor = (zero - h * volume) * sigma;
    if constexpr (Multiplier::non_affine) {
      c.motion.moment = team.vector(p, Record::weight_moment);
      c.motion.scale = team.field(p, Record::weight_scale);
      const auto answered = [&](int i) { return select(safe, team.own_value(p, answered_drifts, 3, i), zero); };
      const Vec3<Real> drift = {answered(0), answered(1), answered(2)};
      team.set_vector(p, Record::drift_multiplier, drift);
      impulse.along_drift = (zero - h * twice_mu * volume * Real(multiplier.drift_stiffness)) * drift;
    }
    return impulse;
  }
};

// Before the iterations of Gauss-Seidel.
template <class Law, class Multiplier> struct StartInelastic : WarmStart<Law, Multiplier> {
  template <class Team> LOAM_FN void operator()(Team &team, typename Team::Item p) const {
    using Real = typename Team::Real;
    const Vec4<Real> own = team.velocity(p);
    Constraint<Real> c;
    const Impulse<Real> impulse = this->start(team, p, c);
    push_neighbours<Multiplier::non_affine>(team, p, own, spread_impulse<Multiplier::non_affine>(impulse, c));
  }
};

} // namespace loam
