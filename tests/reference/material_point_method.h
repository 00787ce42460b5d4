/* The method that games' sand and snow mostly come from, as a yardstick: explicit MPM with affine transfers and quadratic B-splines, in double precision.
 *
 * A step of length h (Jiang et al. 2015, "The affine particle-in-cell method"; Hu et al. 2018, "A moving least squares material point method", whose force is used), with cells
 * of width d and w_ip the spline of node i at particle p:
 *   m_i = sum_p w_ip m_p,   (m v)_i = sum_p w_ip (m_p (v_p + C_p (x_i - x_p)) - h V0_p (4 / d^2) tau_p (x_i - x_p)),   v_i += h g, then the planes,
 *   v_p = sum_i w_ip v_i,   C_p = (4 / d^2) sum_i w_ip v_i (x_i - x_p)^T,   x_p += h v_p,   b_p = Z((I + h C_p) b_p (I + h C_p)^T).
 * tau and the return mapping Z are those of material.h: elastic, Von Mises, and the sand of Klar et al. 2016 with the volume correction of Tampubolon et al. 2017. */
#pragma once

#include "material.h"
#include <vector>

namespace loam::reference {

enum class Boundary {
  sticky, // nothing moves at it
  slip,   // no motion across it, no friction: also a plane of symmetry
  coulomb // matter may leave; friction is bounded by the pressure
};

class MaterialPointMethod {
public:
  struct Settings {
    Vector3<double> gravity = {0, -9.81, 0};
    double cell = 0.01;
    double courant = 0.4; // h (c + |v|) / d of `run`
  };
  struct Point {
    Vector3<double> position, velocity;
    Matrix3<double> affine = Matrix3<double>::Zero(); // C
    Matrix3<double> strain = Matrix3<double>::Zero(); // b - I
    double mass, volume, volume_correction = 0;
  };

  MaterialPointMethod(const Settings &settings, const Material<double> &material)
      : settings_(settings), material_(material) {}

  void add_point(const Vector3<double> &position, const Vector3<double> &velocity, double volume);

  /* `normal` points away from the solid side. Nodes on the plane and behind it obey it, so a plane should lie on nodes. */
  void add_plane(const Vector3<double> &point, const Vector3<double> &normal, Boundary boundary, double friction = 0);
  void set_gravity(const Vector3<double> &gravity) { settings_.gravity = gravity; }

  double stable_step() const;

  /* Throws std::runtime_error if a position is not finite, or the points lie too far apart for a dense grid. */
  void advance(double step);

  /* In steps no longer than stable ones. */
  void run(double seconds);

  const std::vector<Point> &points() const { return points_; }

private:
  struct Plane {
    Vector3<double> point, normal;
    Boundary boundary;
    double friction;
  };
  struct Node {
    Vector3<double> velocity; // first momentum
    double mass;
  };
  struct Stencil; // 3 x 3 x 3 nodes around a point

  void fit_grid();
  Stencil stencil(const Vector3<double> &position) const;
  void scatter(double step);
  void move_nodes(double step);
  void gather(double step);

  Settings settings_;
  Material<double> material_;
  std::vector<Point> points_;
  std::vector<Plane> planes_;
  std::vector<Node> nodes_;
  int first_[3], size_[3]; // of the grid, in cells
};

} // namespace loam::reference
