/* The method, plainly: one substep of XPBI (Yu, Li, Lan, Yang and Jiang, SIGGRAPH Asia 2024, algorithm 1) with the scalar multiplier,
 * serial Gauss-Seidel, one thread, no explicit SIMD. The library is compared with it: in double precision for accuracy, in single
 * precision for speed. Read `substep` in scalar_solver.cpp first.
 *
 * The constraint of a particle is C = sqrt(2 psi(F)) with compliance alpha = 1/V0 (equations 6 to 9 of the paper): at alpha~ = alpha / h^2 its
 * fixed point is implicit Euler. F is the elastic deformation after the return mapping, in every iteration: that is what makes
 * plasticity implicit.
 *
 * The sum in the denominator of the multiplier costs O(1): with A the derivative of C by the velocity gradient,
 *   sum_b w_b |A G_b|^2 + w_p |A s|^2 = tr(A M A^T) + w_p |A s|^2,   M = sum_b w_b G_b G_b^T,   s = sum_b G_b,
 * and M and s stay fixed during the substep. */
#pragma once

#include "contact.h"
#include "neighbours.h"
#include "particles.h"
#include "strain.h"

namespace loam::reference {

enum class Plasticity { implicit, semi_implicit };

struct Settings {
  double gravity[3] = {0, -9.81, 0};
  double kernel_radius = 0.01;
  int iterations = 5;
  Plasticity plasticity = Plasticity::implicit;
  double velocity_smoothing = 20; // 1/s: XSPH's coefficient is this times the substep
  double minimum_distance = 0.75; // of r: what position correction keeps
  double gradient_cutoff = 0.2;   // of a full neighbourhood's value
  double hencky_bound = 0.5;      // of each principal trial strain; keeps impacts from running away
};

/* Wall time since the start, in seconds. */
struct StageSeconds {
  double sort = 0, neighbour_search = 0, gradients = 0, solve = 0, position_correction = 0, contacts = 0,
         velocity_smoothing = 0, strain = 0, advance = 0;
  double total() const {
    return sort + neighbour_search + gradients + solve + position_correction + contacts + velocity_smoothing + strain +
           advance;
  }
};

template <typename Real> class ScalarSolver {
public:
  ScalarSolver(const Settings &settings, const Material<Real> &material);

  /* Arrays of 3 x count; velocities may be null: at rest. Ids follow the order of creation. */
  void add_particles(const float *positions, const float *velocities, std::size_t count, double volume, bool pinned = false);
  void add_plane(const float point[3], const float normal[3], double friction);

  /* Advances by h seconds. Throws std::runtime_error if a position is not finite. */
  void substep(Real h);

  const Settings &settings() const { return settings_; }
  const Material<Real> &material() const { return material_; }
  const Particles<Real> &particles() const { return particles_; }
  const Neighbourhoods<Real> &neighbourhoods() const { return neighbourhoods_; } // of the last substep's start
  const Contacts<Real> &contacts() const { return contacts_; }
  const StageSeconds &seconds() const { return seconds_; }
  std::uint64_t pair_visits() const { return pair_visits_; } // pairs x iterations since the start
  double last_step() const { return last_step_; }

  /* Of the last iteration: sqrt( sum (C + alpha~ lambda)^2 / sum C^2 ). */
  double residual() const { return constraint_squares_ > 0 ? std::sqrt(residual_squares_ / constraint_squares_) : 0.0; }

  /* Sum over the close pairs of impulse x distance along `gravity`, both of the last substep, in kg m^2/s: the part of position correction
   * in the virial. */
  double correction_virial() const { return correction_virial_; }

private:
  void accelerate(Real h);
  void solve_all(Real h);
  void solve_particle(std::size_t particle, Real h);
  void correct_positions(Real h);
  void smooth_velocities(Real h);
  void limit_speeds(Real h);
  void advance_strains(Real h);
  void advance_positions(Real h);
  Matrix3<Real> velocity_gradient(std::size_t particle) const;

  Settings settings_;
  Material<Real> material_;
  WendlandKernel<Real> kernel_;
  Vector3<Real> gravity_;
  Particles<Real> particles_;
  Neighbourhoods<Real> neighbourhoods_;
  Contacts<Real> contacts_;
  std::vector<Real> multipliers_; // lambda

  StageSeconds seconds_;
  std::uint64_t pair_visits_ = 0;
  double last_step_ = 0;
  double residual_squares_ = 0, constraint_squares_ = 0;
  double correction_virial_ = 0;
};

} // namespace loam::reference
