/* Static equilibrium of an elastic body by finite elements: 27-node hexahedra, Hencky's law, large deformation, in double precision.
 *
 * The equilibrium is the stationary point of the potential energy  sum_e int psi(F) dV - sum_a f_a . x_a  over the nodes that are not held (Bonet and Wood,
 * Nonlinear Continuum Mechanics for Finite Element Analysis, 2008), found by Newton's method with a line search; each of its linear systems is solved by a sparse
 * Cholesky factorisation. Elements are triquadratic with 3 x 3 x 3 Gauss points, which neither lock in bending nor, at Poisson's ratios up to about .4, in
 * compression. */
#pragma once

#include "hencky_solid.h"
#include <array>
#include <vector>

namespace loam::reference {

class FiniteElements {
public:
  static constexpr int nodes_of_element = 27;

  /* A box from the origin to `size`, cut into elements of equal size. Node (i, j, k) of the (2 n + 1)-lattice is i + (2 n_x + 1) (j + (2 n_y + 1) k). */
  FiniteElements(const HenckySolid &solid, const Vector3<double> &size, const int elements[3]);

  std::size_t node_count() const { return rest_.size(); }
  const Vector3<double> &rest_position(std::size_t node) const { return rest_[node]; }
  const Vector3<double> &position(std::size_t node) const { return positions_[node]; }

  /* Moves a node of the undeformed mesh. */
  void place(std::size_t node, const Vector3<double> &at) { rest_[node] = positions_[node] = at; }

  /* Holds a coordinate of a node where it is plus `displacement`. */
  void hold(std::size_t node, int axis, double displacement = 0);

  /* Force over the undeformed volume, N/m^3: density times gravity. */
  void set_body_force(const Vector3<double> &force) { body_force_ = force; }

  /* A force that stays, N. */
  void add_force(std::size_t node, const Vector3<double> &force) { forces_[node] += force; }

  /* Finds the equilibrium, raising loads and displacements in equal steps. Returns the Newton iterations it took; throws std::runtime_error if a step does not
   * converge. */
  int solve(int load_steps = 1);

  double energy() const; // elastic, J

  /* What holds the node, N: zero to rounding at a free one. After solve. */
  Vector3<double> reaction(std::size_t node) const { return reactions_[node]; }

private:
  struct GaussPoint {
    Eigen::Matrix<double, 3, nodes_of_element> gradients; // of the shape functions, by the undeformed position
    Eigen::Matrix<double, nodes_of_element, 1> values;
    double volume;
  };
  struct Element {
    int nodes[nodes_of_element];
    std::vector<GaussPoint> points;
  };
  struct Newton;

  void integrate_elements();
  Matrix3<double> deformation(const Element &element, const GaussPoint &point,
                              const std::vector<Vector3<double>> &positions) const;
  double potential(const std::vector<Vector3<double>> &positions, const std::vector<Vector3<double>> &loads) const;

  HenckySolid solid_;
  std::vector<Vector3<double>> rest_, positions_, forces_, reactions_;
  std::vector<std::array<bool, 3>> held_;
  std::vector<std::array<double, 3>> held_displacements_;
  Vector3<double> body_force_ = Vector3<double>::Zero();
  std::vector<Element> elements_;
};

} // namespace loam::reference
