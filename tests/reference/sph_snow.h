/* Snow by particles that carry pressure: the semi-implicit SPH solver of Gissler et al. 2020, "An implicit compressible SPH solver for snow simulation", in double precision.
 *
 * A step of length h, after algorithm 1 of the paper, with V = m / rho, gradW by x_i, and L_i the correction that makes gradients of linear fields exact:
 *   rho = sum_j m_j W_ij,   rest density rho0 = rho |det F|,   lambda and G times e^(xi (rho0 - rho00) / rho0), rho00 being rho0 when the particle was new,
 *   v* = v + h g,
 *   rho0 p / lambda - h^2 rho div(grad p / rho) = rho* - rho0,   rho* = rho - h rho div v*,   a_lambda = -grad p / rho,
 *   a - (h^2 / rho) div(2G sym(grad a F)) = (1 / rho) div(2G (sym F' - I)),   F' = F + h grad(v* + h a_lambda) F,   a_G = a,
 *   v = v* + h (a_lambda + a_G),   F <- Z(F + h grad v F),   x += h v,
 * where div v and grad p use plain kernel gradients, and grad v corrected ones but for its trace. Z bounds the stretches by 1 - theta_c and 1 + theta_s (Stomakhin et al.
 * 2013) and takes the rotation out of F.
 *
 * Simplified: both systems are solved by the biconjugate gradient method to a tolerance (the paper relaxes the first by Jacobi); Z keeps the left stretch U diag(s) U^T, which
 * turns with the matter (the right one would not); planes hold the particles in contact with them within both solves, with Coulomb friction after them, in place of
 * boundary particles; no adhesion; rho00 is each particle's own, so that a surface is at rest at its start; Wendland's kernel instead of a cubic spline. */
#pragma once

#include "neighbours.h"

namespace loam::reference {

struct SnowMaterial {
  double density = 400, youngs_modulus = 1.4e5, poissons_ratio = 0.2;
  double hardening = 10;                                           // xi
  double critical_compression = 2.5e-2, critical_stretch = 7.5e-3; // theta_c, theta_s

  /* Z: each singular value of F, which has a positive determinant, brought into [1 - theta_c, 1 + theta_s]; then without the rotation. */
  Matrix3<double> project(const Matrix3<double> &F) const;
};

class SphSnow {
public:
  struct Settings {
    Vector3<double> gravity = {0, -9.81, 0};
    double kernel_radius = 0.01; // half the support; the spacing of the particles
    double tolerance = 1e-6;     // of the linear systems, relative
  };

  SphSnow(const Settings &settings, const SnowMaterial &material) : settings_(settings), material_(material) {}

  /* Ids follow the order of creation. */
  void add_particle(const Vector3<double> &position, const Vector3<double> &velocity, double volume);

  /* Particles touch it when they are half a kernel radius off. `normal` points away from the solid side. */
  void add_plane(const Vector3<double> &point, const Vector3<double> &normal, double friction);

  /* Throws std::runtime_error if a position is not finite or a system is not solved. */
  void advance(double step);

  const Particles<double> &particles() const { return particles_; }

  /* By id; densities as of the last step's start. */
  double density(std::uint32_t id) const { return states_[id].density; }
  double first_density(std::uint32_t id) const { return states_[id].first_rest_density; }
  const Matrix3<double> &deformation(std::uint32_t id) const { return states_[id].deformation; }

private:
  struct Plane {
    Vector3<double> point, normal;
    double friction;
  };
  struct State { // by id
    Matrix3<double> deformation = Matrix3<double>::Identity();
    double density = 0, first_rest_density = 0;
  };
  struct Solve; // of one step

  Settings settings_;
  SnowMaterial material_;
  Particles<double> particles_;
  std::vector<State> states_;
  std::vector<Plane> planes_;
};

} // namespace loam::reference
