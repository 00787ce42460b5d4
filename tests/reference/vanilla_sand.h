/* Sand as most games that have particles make it: grains that keep their distance, with Coulomb friction at the level of positions (Macklin et al. 2014, "Unified particle
 * physics for real-time applications", algorithm 1 and section 6.1). Plain, in double precision, serial Gauss-Seidel.
 *
 * A step of length h: x* = x + h v + h^2 g; then, `iterations` times, every contact of depth d > 0, along n, is undone and rubbed against,
 *   dx_i = w_i / (w_i + w_j) d n,   s = what dx_i - dx_j of this step is across n,   dx_i -= w_i / (w_i + w_j) s min(1, bound / |s|),
 * with bound = |s| while |s| < static friction times d, and kinetic friction times d beyond; then v = (x* - x) / h and x = x*.
 * Left out of the paper: averaging and over-relaxation, which Jacobi iterations need; scaled masses and pre-stabilisation, which speed stacks up. Grains do not turn. */
#pragma once

#include "neighbours.h"

namespace loam::reference {

class VanillaSand {
public:
  struct Settings {
    Vector3<double> gravity = {0, -9.81, 0};
    double diameter = 0.01;
    int iterations = 5;
    double static_friction = 0.6, kinetic_friction = 0.5; // between grains
    double sleep_speed = 0; // m/s: a grain that would be slower stays where it is (algorithm 1, the last lines)
  };

  explicit VanillaSand(const Settings &settings) : settings_(settings) {}

  /* Ids follow the order of creation. */
  void add_grain(const Vector3<double> &position, const Vector3<double> &velocity, double mass);

  /* Grains touch it when their centres are half a diameter off. `normal` points away from the solid side. */
  void add_plane(const Vector3<double> &point, const Vector3<double> &normal, double static_friction,
                 double kinetic_friction);

  /* Throws std::runtime_error if a position is not finite. */
  void advance(double step);

  const Particles<double> &particles() const { return particles_; }

private:
  struct Plane {
    Vector3<double> point, normal;
    double static_friction, kinetic_friction;
  };
  void solve_pair(std::uint32_t first, std::uint32_t second);
  void solve_plane(std::size_t grain, const Plane &plane);

  Settings settings_;
  Particles<double> particles_;
  std::vector<Vector3<double>> predicted_; // x*
  std::vector<Plane> planes_;
};

} // namespace loam::reference
