#include "finite_elements.h"

#include <Eigen/SparseCholesky>
#include <stdexcept>

namespace loam::reference {

namespace {

/* Quadratic Lagrange polynomials on nodes -1, 0, 1, and their derivatives. */
void line_functions(double x, double value[3], double slope[3]) {
  value[0] = x * (x - 1) / 2, value[1] = 1 - x * x, value[2] = x * (x + 1) / 2;
  slope[0] = x - 0.5, slope[1] = -2 * x, slope[2] = x + 0.5;
}

const double gauss_place[3] = {-std::sqrt(0.6), 0, std::sqrt(0.6)};
const double gauss_weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};

} // namespace

FiniteElements::FiniteElements(const HenckySolid &solid, const Vector3<double> &size, const int elements[3])
    : solid_(solid) {
  const int lattice[3] = {2 * elements[0] + 1, 2 * elements[1] + 1, 2 * elements[2] + 1};
  for (int k = 0; k < lattice[2]; ++k)
    for (int j = 0; j < lattice[1]; ++j)
      for (int i = 0; i < lattice[0]; ++i)
        rest_.emplace_back(size[0] * i / (lattice[0] - 1), size[1] * j / (lattice[1] - 1), size[2] * k / (lattice[2] - 1));
  positions_ = rest_;
  forces_.assign(rest_.size(), Vector3<double>::Zero());
  reactions_ = forces_;
  held_.assign(rest_.size(), {});
  held_displacements_.assign(rest_.size(), {});
  for (int k = 0; k < elements[2]; ++k)
    for (int j = 0; j < elements[1]; ++j)
      for (int i = 0; i < elements[0]; ++i) {
        Element element;
        for (int node = 0; node < nodes_of_element; ++node) {
          const int x = 2 * i + node % 3, y = 2 * j + node / 3 % 3, z = 2 * k + node / 9;
          element.nodes[node] = x + lattice[0] * (y + lattice[1] * z);
        }
        elements_.push_back(element);
      }
}

void FiniteElements::hold(std::size_t node, int axis, double displacement) {
  held_[node][std::size_t(axis)] = true;
  held_displacements_[node][std::size_t(axis)] = displacement;
}

void FiniteElements::integrate_elements() {
  for (Element &element : elements_) {
    element.points.clear();
    for (int place = 0; place < 27; ++place) {
      const int at[3] = {place % 3, place / 3 % 3, place / 9};
      double value[3][3], slope[3][3];
      for (int axis = 0; axis < 3; ++axis) line_functions(gauss_place[at[axis]], value[axis], slope[axis]);
      GaussPoint point;
      Matrix3<double> jacobian = Matrix3<double>::Zero(); // of the undeformed position by the element's coordinates
      for (int node = 0; node < nodes_of_element; ++node) {
        const int x = node % 3, y = node / 3 % 3, z = node / 9;
        point.values[node] = value[0][x] * value[1][y] * value[2][z];
        point.gradients.col(node) << slope[0][x] * value[1][y] * value[2][z], value[0][x] * slope[1][y] * value[2][z],
            value[0][x] * value[1][y] * slope[2][z];
        jacobian += rest_[std::size_t(element.nodes[node])] * point.gradients.col(node).transpose();
      }
      point.gradients = (jacobian.inverse().transpose() * point.gradients).eval();
      point.volume = jacobian.determinant() * gauss_weight[at[0]] * gauss_weight[at[1]] * gauss_weight[at[2]];
      if (!(point.volume > 0)) throw std::runtime_error("finite elements: the mesh has an inverted element");
      element.points.push_back(point);
    }
  }
}

Matrix3<double> FiniteElements::deformation(const Element &element, const GaussPoint &point,
                                            const std::vector<Vector3<double>> &positions) const {
  Matrix3<double> F = Matrix3<double>::Zero();
  for (int node = 0; node < nodes_of_element; ++node)
    F += positions[std::size_t(element.nodes[node])] * point.gradients.col(node).transpose();
  return F;
}

double FiniteElements::potential(const std::vector<Vector3<double>> &positions,
                                 const std::vector<Vector3<double>> &loads) const {
  double sum = 0;
  for (const Element &element : elements_)
    for (const GaussPoint &point : element.points)
      sum += point.volume * solid_.energy_density(deformation(element, point, positions));
  for (std::size_t node = 0; node < rest_.size(); ++node) sum -= loads[node].dot(positions[node] - rest_[node]);
  return sum;
}

double FiniteElements::energy() const {
  return potential(positions_, std::vector<Vector3<double>>(rest_.size(), Vector3<double>::Zero()));
}

/* The linear systems. Unknowns are the coordinates that are not held. */
struct FiniteElements::Newton {
  FiniteElements &body;
  std::vector<int> unknown; // of 3 node + axis; -1: held
  int count = 0;
  bool analysed = false;
  Eigen::SparseMatrix<double> matrix;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors;

  explicit Newton(FiniteElements &of) : body(of), unknown(3 * of.rest_.size(), -1) {
    for (std::size_t i = 0; i < unknown.size(); ++i)
      if (!of.held_[i / 3][i % 3]) unknown[i] = count++;
  }

  /* Elastic forces less the loads, at all nodes. */
  std::vector<Vector3<double>> residual(const std::vector<Vector3<double>> &loads) const {
    std::vector<Vector3<double>> sum(loads.size());
    for (std::size_t node = 0; node < loads.size(); ++node) sum[node] = -loads[node];
    for (const Element &element : body.elements_)
      for (const GaussPoint &point : element.points) {
        const Matrix3<double> stress = point.volume * body.solid_.stress(body.deformation(element, point, body.positions_));
        for (int node = 0; node < nodes_of_element; ++node)
          sum[std::size_t(element.nodes[node])] += stress * point.gradients.col(node);
      }
    return sum;
  }

  /* False where the matrix is not positive definite. */
  bool factorise(bool definite) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(body.elements_.size() * 3 * nodes_of_element * (3 * nodes_of_element + 1) / 2);
    using Operator = Eigen::Matrix<double, 9, 3 * nodes_of_element>;
    for (const Element &element : body.elements_) {
      Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(3 * nodes_of_element, 3 * nodes_of_element);
      for (const GaussPoint &point : element.points) {
        Operator to_deformation = Operator::Zero();
        for (int node = 0; node < nodes_of_element; ++node)
          for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
              to_deformation(row + 3 * column, 3 * node + row) = point.gradients(column, node);
        const Matrix9 tangent = body.solid_.stiffness(body.deformation(element, point, body.positions_), definite);
        const Operator stressed = point.volume * tangent * to_deformation;
        stiffness.noalias() += to_deformation.transpose() * stressed;
      }
      for (int i = 0; i < 3 * nodes_of_element; ++i)
        for (int j = 0; j < 3 * nodes_of_element; ++j) {
          const int row = unknown[std::size_t(3 * element.nodes[i / 3] + i % 3)];
          const int column = unknown[std::size_t(3 * element.nodes[j / 3] + j % 3)];
          if (row >= column && column >= 0) entries.emplace_back(row, column, stiffness(i, j));
        }
    }
    matrix.resize(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    if (!analysed) factors.analyzePattern(matrix);
    analysed = true;
    factors.factorize(matrix);
    return factors.info() == Eigen::Success && factors.vectorD().minCoeff() > 0;
  }

  /* The displacement that Newton's method proposes, zero where held. */
  std::vector<Vector3<double>> direction(const std::vector<Vector3<double>> &residual) {
    if (!factorise(false) && !factorise(true)) throw std::runtime_error("finite elements: the body is not held");
    Eigen::VectorXd right(count);
    for (std::size_t i = 0; i < unknown.size(); ++i)
      if (unknown[i] >= 0) right[unknown[i]] = -residual[i / 3][Eigen::Index(i % 3)];
    const Eigen::VectorXd solution = factors.solve(right);
    std::vector<Vector3<double>> step(residual.size(), Vector3<double>::Zero());
    for (std::size_t i = 0; i < unknown.size(); ++i)
      if (unknown[i] >= 0) step[i / 3][Eigen::Index(i % 3)] = solution[unknown[i]];
    return step;
  }
};

int FiniteElements::solve(int load_steps) {
  integrate_elements();
  std::vector<Vector3<double>> full_loads = forces_;
  for (const Element &element : elements_)
    for (const GaussPoint &point : element.points)
      for (int node = 0; node < nodes_of_element; ++node)
        full_loads[std::size_t(element.nodes[node])] += point.volume * point.values[node] * body_force_;

  constexpr double tolerance = 1e-9; // of the forces at the nodes
  constexpr int most_iterations = 100;
  int iterations = 0;
  Newton newton(*this);
  const std::vector<Vector3<double>> start = positions_;
  for (int load_step = 1; load_step <= load_steps; ++load_step) {
    const double share = double(load_step) / load_steps;
    std::vector<Vector3<double>> loads = full_loads;
    for (Vector3<double> &load : loads) load *= share;
    for (std::size_t node = 0; node < rest_.size(); ++node)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (held_[node][axis])
          positions_[node][Eigen::Index(axis)] = start[node][Eigen::Index(axis)] + share * held_displacements_[node][axis];

    for (int iteration = 0;; ++iteration) {
      reactions_ = newton.residual(loads);
      double squared = 0, scale = 0;
      for (std::size_t i = 0; i < newton.unknown.size(); ++i) {
        const double value = reactions_[i / 3][Eigen::Index(i % 3)];
        scale += value * value + std::pow(loads[i / 3][Eigen::Index(i % 3)], 2);
        if (newton.unknown[i] >= 0) squared += value * value;
      }
      if (squared <= tolerance * tolerance * scale) break;
      if (iteration == most_iterations) throw std::runtime_error("finite elements: no equilibrium was found");
      ++iterations;

      const std::vector<Vector3<double>> step = newton.direction(reactions_);
      double slope = 0;
      for (std::size_t node = 0; node < rest_.size(); ++node) slope += reactions_[node].dot(step[node]);
      const double before = potential(positions_, loads);
      const std::vector<Vector3<double>> from = positions_;
      for (double length = 1; length > 1e-8; length /= 2) {
        for (std::size_t node = 0; node < rest_.size(); ++node) positions_[node] = from[node] + length * step[node];
        const double now = potential(positions_, loads);
        if (now < before + 1e-4 * length * slope) break;
        // Close to the minimum the change is lost in rounding; the slope is not.
        if (now > before + 1e-6 * std::fabs(before)) continue;
        const std::vector<Vector3<double>> forces = newton.residual(loads);
        double slope_now = 0;
        for (std::size_t node = 0; node < rest_.size(); ++node) slope_now += forces[node].dot(step[node]);
        if (std::fabs(slope_now) < -0.5 * slope) break;
      }
    }
  }
  return iterations;
}

} // namespace loam::reference
