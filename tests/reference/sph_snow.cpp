#include "sph_snow.h"

#include <stdexcept>

namespace loam::reference {

namespace {

using Vector = Eigen::VectorXd;

/* BiCGSTAB (van der Vorst 1992) for  apply(x) = right. */
template <typename Apply> Vector biconjugate_gradients(const Apply &apply, const Vector &right, double tolerance) {
  constexpr int most_iterations = 2000;
  Vector x = Vector::Zero(right.size()), residual = right, direction = right;
  const Vector shadow = right;
  double along = shadow.dot(residual);
  const double target = tolerance * right.norm();
  for (int iteration = 0; residual.norm() > target; ++iteration) {
    if (iteration == most_iterations) throw std::runtime_error("SPH snow: a linear system was not solved");
    const Vector product = apply(direction);
    const double length = along / shadow.dot(product);
    const Vector half = residual - length * product, smoothed = apply(half);
    const double weight = smoothed.squaredNorm() > 0 ? smoothed.dot(half) / smoothed.squaredNorm() : 0;
    x += length * direction + weight * half;
    residual = half - weight * smoothed;
    const double next = shadow.dot(residual);
    direction = residual + next / along * length / weight * (direction - weight * product);
    along = next;
  }
  return x;
}

Matrix3<double> symmetric(const Matrix3<double> &matrix) { return (matrix + matrix.transpose()) / 2; }

} // namespace

Matrix3<double> SnowMaterial::project(const Matrix3<double> &F) const {
  // The left stretch, from F F^T.
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> eigen(F * F.transpose());
  const Vector3<double> stretches =
      eigen.eigenvalues().cwiseSqrt().cwiseMax(1 - critical_compression).cwiseMin(1 + critical_stretch);
  return eigen.eigenvectors() * stretches.asDiagonal() * eigen.eigenvectors().transpose();
}

void SphSnow::add_particle(const Vector3<double> &position, const Vector3<double> &velocity, double volume) {
  particles_.ids.push_back(std::uint32_t(particles_.ids.size()));
  particles_.positions.push_back(position);
  particles_.motions.push_back({velocity, 1 / (material_.density * volume)});
  particles_.rest_volumes.push_back(volume);
  particles_.strains.push_back(Matrix3<double>::Zero());
  particles_.volume_corrections.push_back(0);
  particles_.log_volume_changes.push_back(0);
  states_.emplace_back();
}

void SphSnow::add_plane(const Vector3<double> &point, const Vector3<double> &normal, double friction) {
  planes_.push_back({point, normal.normalized(), friction});
}

/* Vectors hold three numbers a particle, in the order of the particles. */
struct SphSnow::Solve {
  SphSnow &snow;
  double h;
  std::size_t count;
  Neighbourhoods<double> near;
  std::vector<Vector3<double>> plain_gradient; // V_j gradW_ij, per pair
  std::vector<double> density, rest_density, lambda, shear;
  std::vector<Matrix3<double>> deformation;
  std::vector<std::vector<bool>> touching; // of each plane, each particle

  Solve(SphSnow &of, double step) : snow(of), h(step), count(of.particles_.size()) {
    Particles<double> &particles = snow.particles_;
    const WendlandKernel<double> kernel(snow.settings_.kernel_radius);
    const CellGrid<double> grid = sort_by_cell(particles, kernel.support());
    find_neighbours(particles, grid, kernel, 0.0, near);
    const SnowMaterial &material = snow.material_;
    const double E = material.youngs_modulus, nu = material.poissons_ratio;
    for (std::size_t i = 0; i < count; ++i) {
      State &state = snow.states_[particles.ids[i]];
      double sum = kernel.value(0) / particles.motions[i].inverse_mass;
      for (std::uint32_t pair = near.first_pair[i]; pair < near.first_pair[i + 1]; ++pair)
        sum += near.kernel_value[pair] / particles.motions[near.neighbour[pair]].inverse_mass;
      const double rest = sum * std::fabs(state.deformation.determinant());
      if (state.first_rest_density == 0) state.first_rest_density = rest;
      state.density = sum;
      density.push_back(sum);
      rest_density.push_back(rest);
      deformation.push_back(state.deformation);
      const double hardening = std::exp(material.hardening * (1 - state.first_rest_density / rest));
      lambda.push_back(hardening * E * nu / ((1 + nu) * (1 - 2 * nu)));
      shear.push_back(hardening * E / (2 * (1 + nu)));
      particles.rest_volumes[i] = 1 / (particles.motions[i].inverse_mass * sum); // V, what gradients weigh with
    }
    compute_gradients(particles, kernel, 0.2, near);
    for (std::size_t i = 0; i < count; ++i)
      for (std::uint32_t pair = near.first_pair[i]; pair < near.first_pair[i + 1]; ++pair) {
        const std::uint32_t j = near.neighbour[pair];
        const Vector3<double> offset = particles.positions[j] - particles.positions[i];
        const double distance = offset.norm();
        plain_gradient.push_back(
            distance > 0 ? Vector3<double>(particles.rest_volumes[j] * kernel.steepness(distance) / distance * offset)
                         : Vector3<double>::Zero());
      }
  }

  Vector3<double> at(const Vector &vector, std::size_t i) const { return vector.segment<3>(Eigen::Index(3 * i)); }

  double divergence(const Vector &velocity, std::size_t i) const {
    double sum = 0;
    for (std::uint32_t pair = near.first_pair[i]; pair < near.first_pair[i + 1]; ++pair)
      sum += (at(velocity, near.neighbour[pair]) - at(velocity, i)).dot(plain_gradient[pair]);
    return sum;
  }

  Matrix3<double> velocity_gradient(const Vector &velocity, std::size_t i) const {
    Matrix3<double> corrected = Matrix3<double>::Zero();
    for (std::uint32_t pair = near.first_pair[i]; pair < near.first_pair[i + 1]; ++pair)
      corrected += (at(velocity, near.neighbour[pair]) - at(velocity, i)) * near.gradient[pair].transpose();
    return corrected + (divergence(velocity, i) - corrected.trace()) / 3 * Matrix3<double>::Identity();
  }

  /* The acceleration from pressures (one a particle): m a_i = -V_i sum_j (p_i + p_j) V_j gradW_ij. */
  Vector from_pressures(const Vector &pressure) const {
    Vector result = Vector::Zero(Eigen::Index(3 * count));
    for (std::size_t i = 0; i < count; ++i) {
      for (std::uint32_t pair = near.first_pair[i]; pair < near.first_pair[i + 1]; ++pair)
        result.segment<3>(Eigen::Index(3 * i)) -=
            (pressure[Eigen::Index(i)] + pressure[near.neighbour[pair]]) * plain_gradient[pair];
      result.segment<3>(Eigen::Index(3 * i)) /= density[i];
    }
    return result;
  }

  /* The acceleration from stresses: m a_i = sum_j V_i V_j (sigma_i L_i gradW_ij + sigma_j L_j gradW_ij), pair by pair, so that what one gains the other loses. */
  Vector from_stresses(const std::vector<Matrix3<double>> &stress) const {
    Vector result = Vector::Zero(Eigen::Index(3 * count));
    const std::vector<double> &volume = snow.particles_.rest_volumes;
    for (std::size_t i = 0; i < count; ++i)
      for (std::uint32_t pair = near.first_pair[i]; pair < near.first_pair[i + 1]; ++pair) {
        const std::uint32_t j = near.neighbour[pair];
        const Vector3<double> force = volume[i] * stress[i] * near.gradient[pair]; // V_i V_j sigma_i L_i gradW_ij
        result.segment<3>(Eigen::Index(3 * i)) += snow.particles_.motions[i].inverse_mass * force;
        result.segment<3>(Eigen::Index(3 * j)) -= snow.particles_.motions[j].inverse_mass * force;
      }
    return result;
  }

  /* Without what planes hold. */
  Vector held(Vector acceleration) const {
    for (std::size_t k = 0; k < snow.planes_.size(); ++k)
      for (std::size_t i = 0; i < count; ++i)
        if (touching[k][i]) {
          const Vector3<double> &normal = snow.planes_[k].normal;
          acceleration.segment<3>(Eigen::Index(3 * i)) -= normal.dot(at(acceleration, i)) * normal;
        }
    return acceleration;
  }

  /* What pressure does to the velocities v*, times h. */
  Vector pressure_change(const Vector &velocity) const {
    Vector right(static_cast<Eigen::Index>(count));
    for (std::size_t i = 0; i < count; ++i)
      right[Eigen::Index(i)] = density[i] * (1 - h * divergence(velocity, i)) - rest_density[i];
    const auto apply = [&](const Vector &pressure) {
      const Vector acceleration = held(from_pressures(pressure));
      Vector result(pressure.size());
      for (std::size_t i = 0; i < count; ++i)
        result[Eigen::Index(i)] =
            rest_density[i] / lambda[i] * pressure[Eigen::Index(i)] + h * h * density[i] * divergence(acceleration, i);
      return result;
    };
    return h * from_pressures(biconjugate_gradients(apply, right, snow.settings_.tolerance));
  }

  /* What shear does to these velocities, times h. */
  Vector shear_change(const Vector &velocity) const {
    std::vector<Matrix3<double>> stress(count);
    for (std::size_t i = 0; i < count; ++i) {
      const Matrix3<double> F = deformation[i] + h * velocity_gradient(velocity, i) * deformation[i];
      stress[i] = 2 * shear[i] * (symmetric(F) - Matrix3<double>::Identity());
    }
    const Vector right = held(from_stresses(stress));
    if (right.norm() == 0) return right;
    const auto unheld = [&](const Vector &acceleration) {
      std::vector<Matrix3<double>> change(count);
      for (std::size_t i = 0; i < count; ++i)
        change[i] = 2 * h * h * shear[i] * symmetric(velocity_gradient(acceleration, i) * deformation[i]);
      return from_stresses(change);
    };
    const Vector solution =
        biconjugate_gradients([&](const Vector &a) { return Vector(a - held(unheld(a))); }, right, snow.settings_.tolerance);
    return h * (from_stresses(stress) + unheld(solution));
  }
};

void SphSnow::advance(double h) {
  if (particles_.size() == 0) return;
  Solve solve(*this, h);
  const std::size_t count = particles_.size();
  Vector start(static_cast<Eigen::Index>(3 * count));
  for (std::size_t i = 0; i < count; ++i)
    start.segment<3>(Eigen::Index(3 * i)) = particles_.motions[i].velocity + h * settings_.gravity;

  // The contacts that push, and the particles that would cross: found by repeating the step with those of the last try.
  const auto gap_after = [&](const Plane &plane, const Vector &velocity, std::size_t i) {
    return plane.normal.dot(particles_.positions[i] + h * solve.at(velocity, i) - plane.point) - settings_.kernel_radius / 2;
  };
  for (const Plane &plane : planes_) {
    solve.touching.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i) solve.touching.back()[i] = gap_after(plane, start, i) < 0;
  }
  Vector velocity;
  std::vector<std::vector<double>> pushes(planes_.size(), std::vector<double>(count));
  constexpr int most_rounds = 8;
  for (int round = 0; round < most_rounds; ++round) {
    velocity = start;
    for (std::size_t k = 0; k < planes_.size(); ++k)
      for (std::size_t i = 0; i < count; ++i) {
        pushes[k][i] = 0;
        if (!solve.touching[k][i]) continue;
        pushes[k][i] = -gap_after(planes_[k], velocity, i) / h;
        velocity.segment<3>(Eigen::Index(3 * i)) += pushes[k][i] * planes_[k].normal;
      }
    const auto add = [&](const Vector &change) {
      const Vector rest = solve.held(change);
      for (std::size_t k = 0; k < planes_.size(); ++k)
        for (std::size_t i = 0; i < count; ++i)
          if (solve.touching[k][i]) pushes[k][i] += planes_[k].normal.dot(solve.at(rest, i) - solve.at(change, i));
      velocity += rest;
    };
    add(solve.pressure_change(velocity));
    add(solve.shear_change(velocity));
    bool changed = false;
    for (std::size_t k = 0; k < planes_.size(); ++k)
      for (std::size_t i = 0; i < count; ++i) {
        const bool touches =
            solve.touching[k][i] ? pushes[k][i] > 0 : gap_after(planes_[k], velocity, i) < -1e-6 * settings_.kernel_radius;
        changed |= touches != solve.touching[k][i];
        solve.touching[k][i] = touches;
      }
    if (!changed) break;
  }
  for (std::size_t k = 0; k < planes_.size(); ++k)
    for (std::size_t i = 0; i < count; ++i) {
      if (pushes[k][i] <= 0) continue;
      const Vector3<double> now = solve.at(velocity, i);
      const Vector3<double> along = now - planes_[k].normal.dot(now) * planes_[k].normal;
      if (along.norm() > 0)
        velocity.segment<3>(Eigen::Index(3 * i)) -= std::min(1.0, planes_[k].friction * pushes[k][i] / along.norm()) * along;
    }

  for (std::size_t i = 0; i < count; ++i) {
    const Matrix3<double> F = solve.deformation[i] + h * solve.velocity_gradient(velocity, i) * solve.deformation[i];
    states_[particles_.ids[i]].deformation = material_.project(F);
  }
  for (std::size_t i = 0; i < count; ++i) {
    particles_.motions[i].velocity = solve.at(velocity, i);
    particles_.positions[i] += h * solve.at(velocity, i);
  }
}

} // namespace loam::reference
