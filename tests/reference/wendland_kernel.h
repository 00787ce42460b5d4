/* The smoothing kernel of the method: Wendland's C2 function with support 2r,
 *   W(d) = 21 / (16 pi r^3) (1 - q/2)^4 (1 + 2q),   q = d / r,
 * (Wendland 1995; normalised to integrate to 1 over space). */
#pragma once

#include <numbers>

namespace loam::reference {

template <typename Real> class WendlandKernel {
public:
  explicit WendlandKernel(Real radius)
      : radius_(radius), normalisation_(Real(21) / (Real(16) * std::numbers::pi_v<Real> * radius * radius * radius)) {}

  Real support() const { return 2 * radius_; }

  Real value(Real distance) const {
    const Real q = distance / radius_;
    const Real u = 1 - q / 2;
    return q < 2 ? normalisation_ * u * u * u * u * (1 + 2 * q) : Real(0);
  }

  /* -dW/dd: the length of the gradient, which at a particle points toward its neighbour. */
  Real steepness(Real distance) const {
    const Real q = distance / radius_;
    const Real u = 1 - q / 2;
    return q < 2 ? normalisation_ * 5 * q * u * u * u / radius_ : Real(0);
  }

private:
  Real radius_;
  Real normalisation_;
};

} // namespace loam::reference
