/* Planes that particles rest on and run into, with Coulomb friction.
 *
 * Velocities are clipped so that the end of the substep lies outside the plane, half a kernel radius off. The normal impulse and the
 * friction impulse are accumulated over the iterations of a substep and clamped as totals, as in sequential impulses (Catto 2005): a later
 * iteration may take back what an earlier one gave too much of, and friction is bounded by the whole normal impulse. */
#pragma once

#include "particles.h"

namespace loam::reference {

template <typename Real> struct Plane {
  Vector3<Real> point;
  Vector3<Real> normal; // of length 1, away from the solid side
  Real friction;
};

/* Impulses per mass, that is changes of velocity, of one particle at one plane within a substep. */
template <typename Real> struct ContactImpulse {
  Real normal = 0;
  Vector3<Real> friction = Vector3<Real>::Zero();
};

template <typename Real> class Contacts {
public:
  void add(const Plane<Real> &plane) { planes_.push_back(plane); }
  const std::vector<Plane<Real>> &planes() const { return planes_; }

  /* At the start of a substep. */
  void reset(std::size_t particle_count) { impulses_.assign(particle_count * planes_.size(), ContactImpulse<Real>()); }

  const ContactImpulse<Real> &impulse(std::size_t particle, std::size_t plane) const {
    return impulses_[particle * planes_.size() + plane];
  }

  void solve(Particles<Real> &particles, Real stand_off, Real step) {
    for (std::size_t particle = 0; particle < particles.size(); ++particle) {
      if (particles.motions[particle].inverse_mass == 0) continue;
      for (std::size_t plane = 0; plane < planes_.size(); ++plane)
        solve_one(planes_[plane], impulses_[particle * planes_.size() + plane], particles.positions[particle],
                  particles.motions[particle].velocity, stand_off, step);
    }
  }

private:
  static void solve_one(const Plane<Real> &plane, ContactImpulse<Real> &impulse, const Vector3<Real> &position,
                        Vector3<Real> &velocity, Real stand_off, Real step) {
    const Real gap = plane.normal.dot(position + step * velocity - plane.point) - stand_off;
    if (gap >= 0 && impulse.normal == 0) return;
    const Real normal = std::max(Real(0), impulse.normal - gap / step);
    velocity += (normal - impulse.normal) * plane.normal;
    impulse.normal = normal;

    const Vector3<Real> sliding = velocity - plane.normal.dot(velocity) * plane.normal;
    Vector3<Real> friction = impulse.friction - sliding;
    const Real length = friction.norm();
    const Real bound = plane.friction * normal;
    if (length > bound) friction *= bound / length;
    velocity += friction - impulse.friction;
    impulse.friction = friction;
  }

  std::vector<Plane<Real>> planes_;
  std::vector<ContactImpulse<Real>> impulses_;
};

} // namespace loam::reference
