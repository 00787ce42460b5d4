/* The true solution of an implicit step: what the method's iterations, of whatever form, should converge to on the same particles.
 *
 * With the corrected gradients G_b of the positions at the step's start (neighbours.h), a step of length h minimises over the velocities v
 *   1/2 sum_p m_p |v_p - v~_p|^2 + sum_p V0_p psi(D_p F_p^n) + 1/2 sum_p k_p |u_p|^2,
 *   v~ = v^n + h g,   D_p = I + H - H^T N_p,   H = h sum_b (v_b - v_p) G_b^T
 * (variational form of implicit Euler: Martin et al. 2011, "Example-based elastic materials"; the discretisation: equations 1 to 6 of XPBI). Then x, F and the true volume
 * advance with v. N_p = I - sum_b G_b (x_b - x_p)^T projects onto the directions in which the neighbours of a surface's particle do not reach: there the matter turns with the
 * rest and is not strained.
 *
 * The last term resists motion of neighbours that no velocity gradient shows. From
 *   n_p = kappa sum_b |G_b|^2 (v_p - v_b) + (D_p - I) m / h,   kappa = 1 / sum_b |G_b|^2,   m = kappa sum_b |G_b|^2 (x_b - x_p),
 * which vanishes for linear fields, the drift u_p = Q u_p^n + h n_p adds up; Q turns it by the spin of D without changing its length, and is no part of the
 * minimisation: it is taken from the last minimum and found anew until it does not change. k_p = 2 mu V0_p stiffness / r^2.
 *
 * The minimum is found by Newton's method with a line search, its linear systems by conjugate gradients. Elastic energies only, no contacts. A particle with too few
 * neighbours has no stress. */
#pragma once

#include "hencky_solid.h"
#include "neighbours.h"

namespace loam::reference {

/* A column a particle. */
using Vectors = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/* The function of the velocities that a step minimises. Keeps references to what it is made from. */
class StepEnergy {
public:
  StepEnergy(const HenckySolid &solid, const Particles<double> &particles, const Neighbourhoods<double> &neighbourhoods,
             std::size_t fewest_neighbours, double drift_stiffness, const Vector3<double> &gravity, double step);

  /* The drifts at the step's start, turned. Zero at first. */
  void set_drifts(const Vectors &drifts) { drifts_ = drifts; }

  const Vectors &free_motion() const { return free_motion_; } // v~; 0 where pinned

  double value(const Vectors &velocities) const;     // but for the constant m |v~|^2 / 2
  Vectors gradient(const Vectors &velocities) const; // 0 where pinned

  /* Prepares `multiply` and `precondition` at these velocities; `definite`: with what negative curvature psi has left out. */
  void linearise(const Vectors &velocities, bool definite);
  Vectors multiply(const Vectors &direction) const; // by the second derivative
  Vectors precondition(const Vectors &residual) const;

  Matrix3<double> gradient_step(std::size_t particle, const Vectors &velocities) const;   // h grad v
  Vector3<double> non_affine_step(std::size_t particle, const Vectors &velocities) const; // h n_p

private:
  bool stressed(std::size_t particle) const { return neighbourhoods_.count(particle) >= fewest_neighbours_; }
  void scatter(std::size_t particle, const Matrix3<double> &stress, const Vector3<double> &drift_force, Vectors &to) const;
  void hold_pinned(Vectors &vectors) const;

  HenckySolid solid_;
  const Particles<double> &particles_;
  const Neighbourhoods<double> &neighbourhoods_;
  std::size_t fewest_neighbours_;
  double drift_stiffness_, step_; // 2 mu stiffness / r^2; h
  Vectors free_motion_, drifts_;
  std::vector<Matrix3<double>> deformations_; // F^n
  std::vector<Matrix3<double>> unknown_;      // N
  std::vector<double> scales_;                // kappa
  std::vector<Vector3<double>> moments_;      // m
  std::vector<Matrix9> tangents_;             // d^2 psi / dD^2
  std::vector<Matrix3<double>> inverse_diagonals_;
};

class ImplicitStep {
public:
  struct Settings {
    Vector3<double> gravity = {0, -9.81, 0};
    double kernel_radius = 0.01;
    double gradient_cutoff = 0.2;      // of a full neighbourhood's value
    std::size_t fewest_neighbours = 3; // of a particle with stress
    double zero_energy_stiffness = 10;
    double tolerance = 1e-9; // of the gradient, relative to the impulses at work
  };

  ImplicitStep(const Settings &settings, const Material<double> &material) : settings_(settings), material_(material) {}

  /* Each of `volume`; pinned ones keep their velocity, which is 0. Ids follow the order of creation. */
  void add_particles(const Vectors &positions, const Vectors &velocities, double volume, bool pinned = false);

  /* By id. Pinned particles are left out. */
  void set_velocities(const Vectors &velocities);
  Vectors velocities_by_id() const;

  /* Throws std::runtime_error if no minimum is found. */
  void advance(double step);

  /* Static equilibrium: gravity is raised from nothing in `increments`, each a step so long that inertia does not count (`long_step` seconds), from rest; then it stays until
   * nothing moves by more than 1e-4 r. The path counts little, and less the more increments there are. */
  void settle(int increments, double long_step);

  const Particles<double> &particles() const { return particles_; }
  const std::vector<Vector3<double>> &drifts() const { return drifts_; } // by id
  Vectors positions_by_id() const;
  int newton_iterations() const { return newton_iterations_; } // of the last step

private:
  Vectors minimise(StepEnergy &energy, const Vectors &start, double scale);

  Settings settings_;
  Material<double> material_;
  Particles<double> particles_;
  std::vector<Vector3<double>> drifts_;
  int newton_iterations_ = 0;
};

} // namespace loam::reference
