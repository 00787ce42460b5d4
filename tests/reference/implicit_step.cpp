#include "implicit_step.h"

#include "strain.h"
#include <stdexcept>

namespace loam::reference {

namespace {

double dot(const Vectors &a, const Vectors &b) { return a.cwiseProduct(b).sum(); }

/* F = b^(1/2): as the law is isotropic, a rotation before it makes no difference. */
Matrix3<double> deformation_of(const Matrix3<double> &strain) {
  const Eigen::SelfAdjointEigenSolver<Matrix3<double>> eigen(strain);
  return eigen.eigenvectors() * (1 + eigen.eigenvalues().array()).sqrt().matrix().asDiagonal() *
         eigen.eigenvectors().transpose();
}

} // namespace

StepEnergy::StepEnergy(const HenckySolid &solid, const Particles<double> &particles,
                       const Neighbourhoods<double> &neighbourhoods, std::size_t fewest_neighbours, double drift_stiffness,
                       const Vector3<double> &gravity, double step)
    : solid_(solid), particles_(particles), neighbourhoods_(neighbourhoods), fewest_neighbours_(fewest_neighbours),
      drift_stiffness_(drift_stiffness), step_(step) {
  const auto count = Eigen::Index(particles.size());
  free_motion_.resize(3, count);
  drifts_ = Vectors::Zero(3, count);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    free_motion_.col(Eigen::Index(p)) = particles.motions[p].velocity + step * gravity;
    deformations_.push_back(deformation_of(particles.strains[p]));

    double squares = 0;
    Vector3<double> moment = Vector3<double>::Zero();
    Matrix3<double> unknown = Matrix3<double>::Identity();
    for (std::uint32_t pair = neighbourhoods.first_pair[p]; pair < neighbourhoods.first_pair[p + 1]; ++pair) {
      const Vector3<double> offset = particles.positions[neighbourhoods.neighbour[pair]] - particles.positions[p];
      const double square = neighbourhoods.gradient[pair].squaredNorm();
      squares += square;
      moment += square * offset;
      unknown -= neighbourhoods.gradient[pair] * offset.transpose();
    }
    unknown_.push_back(unknown);
    scales_.push_back(squares > 0 ? 1 / squares : 0);
    moments_.push_back(scales_[p] * moment);
  }
  hold_pinned(free_motion_);
}

void StepEnergy::hold_pinned(Vectors &vectors) const {
  for (std::size_t p = 0; p < particles_.size(); ++p)
    if (particles_.motions[p].inverse_mass == 0) vectors.col(Eigen::Index(p)).setZero();
}

Matrix3<double> StepEnergy::gradient_step(std::size_t p, const Vectors &velocities) const {
  Matrix3<double> sum = Matrix3<double>::Zero();
  for (std::uint32_t pair = neighbourhoods_.first_pair[p]; pair < neighbourhoods_.first_pair[p + 1]; ++pair)
    sum += (velocities.col(neighbourhoods_.neighbour[pair]) - velocities.col(Eigen::Index(p))) *
           neighbourhoods_.gradient[pair].transpose();
  return step_ * (sum - sum.transpose() * unknown_[p]);
}

Vector3<double> StepEnergy::non_affine_step(std::size_t p, const Vectors &velocities) const {
  Vector3<double> sum = Vector3<double>::Zero();
  for (std::uint32_t pair = neighbourhoods_.first_pair[p]; pair < neighbourhoods_.first_pair[p + 1]; ++pair)
    sum += neighbourhoods_.gradient[pair].squaredNorm() *
           (velocities.col(Eigen::Index(p)) - velocities.col(neighbourhoods_.neighbour[pair]));
  return step_ * scales_[p] * sum + gradient_step(p, velocities) * moments_[p];
}

double StepEnergy::value(const Vectors &velocities) const {
  double sum = 0;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const double inverse_mass = particles_.motions[p].inverse_mass;
    if (inverse_mass > 0)
      sum += velocities.col(Eigen::Index(p)).dot(velocities.col(Eigen::Index(p)) / 2 - free_motion_.col(Eigen::Index(p))) /
             inverse_mass;
    if (!stressed(p)) continue;
    const Matrix3<double> D = Matrix3<double>::Identity() + gradient_step(p, velocities);
    const Vector3<double> drift = drifts_.col(Eigen::Index(p)) + non_affine_step(p, velocities);
    sum += particles_.rest_volumes[p] *
           (solid_.energy_density(D * deformations_[p]) + drift_stiffness_ / 2 * drift.squaredNorm());
  }
  return sum;
}

/* To the velocities of the neighbourhood: the derivative of stress : (D - I) + drift_force . (h n_p). */
void StepEnergy::scatter(std::size_t p, const Matrix3<double> &stress, const Vector3<double> &drift_force,
                         Vectors &to) const {
  const Matrix3<double> whole = stress + drift_force * moments_[p].transpose();
  const Matrix3<double> known = whole - unknown_[p] * whole.transpose();
  for (std::uint32_t pair = neighbourhoods_.first_pair[p]; pair < neighbourhoods_.first_pair[p + 1]; ++pair) {
    const Vector3<double> &G = neighbourhoods_.gradient[pair];
    const Vector3<double> share = step_ * (known * G - scales_[p] * G.squaredNorm() * drift_force);
    to.col(neighbourhoods_.neighbour[pair]) += share;
    to.col(Eigen::Index(p)) -= share;
  }
}

Vectors StepEnergy::gradient(const Vectors &velocities) const {
  Vectors result = velocities - free_motion_;
  for (std::size_t p = 0; p < particles_.size(); ++p)
    if (particles_.motions[p].inverse_mass > 0) result.col(Eigen::Index(p)) /= particles_.motions[p].inverse_mass;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    if (!stressed(p)) continue;
    const double volume = particles_.rest_volumes[p];
    const Matrix3<double> D = Matrix3<double>::Identity() + gradient_step(p, velocities);
    const Vector3<double> drift = drifts_.col(Eigen::Index(p)) + non_affine_step(p, velocities);
    scatter(p, volume * solid_.stress(D * deformations_[p]) * deformations_[p].transpose(),
            volume * drift_stiffness_ * drift, result);
  }
  hold_pinned(result);
  return result;
}

void StepEnergy::linearise(const Vectors &velocities, bool definite) {
  tangents_.assign(particles_.size(), Matrix9::Zero());
  inverse_diagonals_.assign(particles_.size(), Matrix3<double>::Zero());
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const double inverse_mass = particles_.motions[p].inverse_mass;
    if (inverse_mass > 0) inverse_diagonals_[p] += Matrix3<double>::Identity() / inverse_mass;
    if (!stressed(p)) continue;
    const Matrix3<double> F = (Matrix3<double>::Identity() + gradient_step(p, velocities)) * deformations_[p];
    Matrix9 by_step = Matrix9::Zero(); // dF = dD F^n
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) by_step(i + 3 * j, i + 3 * l) = deformations_[p](l, j);
    tangents_[p] = by_step.transpose() * solid_.stiffness(F, definite) * by_step;
    const Matrix9 convex = definite ? tangents_[p] : Matrix9(by_step.transpose() * solid_.stiffness(F, true) * by_step);

    const double scale = step_ * step_ * particles_.rest_volumes[p];
    const auto add = [&](std::size_t particle, const Vector3<double> &G, double share) {
      Matrix3<double> block = drift_stiffness_ * share * share * Matrix3<double>::Identity();
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) block += G[j] * G[l] * convex.block<3, 3>(3 * j, 3 * l);
      inverse_diagonals_[particle] += scale * block;
    };
    const Vector3<double> &sum = neighbourhoods_.gradient_sum[p];
    for (std::uint32_t pair = neighbourhoods_.first_pair[p]; pair < neighbourhoods_.first_pair[p + 1]; ++pair) {
      const Vector3<double> &G = neighbourhoods_.gradient[pair];
      add(neighbourhoods_.neighbour[pair], G, scales_[p] * G.squaredNorm() - moments_[p].dot(G));
    }
    add(p, sum, 1 - moments_[p].dot(sum));
  }
  for (std::size_t p = 0; p < particles_.size(); ++p)
    if (particles_.motions[p].inverse_mass > 0) inverse_diagonals_[p] = inverse_diagonals_[p].inverse().eval();
}

Vectors StepEnergy::multiply(const Vectors &direction) const {
  Vectors result = direction;
  for (std::size_t p = 0; p < particles_.size(); ++p)
    if (particles_.motions[p].inverse_mass > 0) result.col(Eigen::Index(p)) /= particles_.motions[p].inverse_mass;
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    if (!stressed(p)) continue;
    const double volume = particles_.rest_volumes[p];
    const Matrix3<double> change = gradient_step(p, direction);
    Matrix3<double> stress;
    Eigen::Map<Eigen::Matrix<double, 9, 1>>(stress.data()) =
        volume * tangents_[p] * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(change.data());
    scatter(p, stress, volume * drift_stiffness_ * non_affine_step(p, direction), result);
  }
  hold_pinned(result);
  return result;
}

Vectors StepEnergy::precondition(const Vectors &residual) const {
  Vectors result(3, residual.cols());
  for (std::size_t p = 0; p < particles_.size(); ++p)
    result.col(Eigen::Index(p)) = inverse_diagonals_[p] * residual.col(Eigen::Index(p));
  hold_pinned(result);
  return result;
}

namespace {

/* Conjugate gradients for  second derivative x = right  (Hestenes and Stiefel 1952). False where the curvature is found to be negative. */
bool conjugate_gradients(const StepEnergy &energy, const Vectors &right, double tolerance, Vectors &x) {
  constexpr int most_iterations = 5000;
  x = Vectors::Zero(3, right.cols());
  Vectors residual = right, preconditioned = energy.precondition(residual);
  Vectors direction = preconditioned;
  double along = dot(residual, preconditioned);
  const double target = tolerance * tolerance * dot(right, right);
  for (int iteration = 0; iteration < most_iterations && dot(residual, residual) > target; ++iteration) {
    const Vectors product = energy.multiply(direction);
    const double curvature = dot(direction, product), length = along / curvature;
    if (!(curvature > 0)) return false;
    x += length * direction;
    residual -= length * product;
    preconditioned = energy.precondition(residual);
    const double next = dot(residual, preconditioned);
    direction = preconditioned + next / along * direction;
    along = next;
  }
  return true;
}

} // namespace

Vectors ImplicitStep::minimise(StepEnergy &energy, const Vectors &start, double scale) {
  constexpr int most_iterations = 200;
  Vectors velocities = start;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Vectors gradient = energy.gradient(velocities);
    const double length = gradient.norm();
    if (length <= settings_.tolerance * scale) return velocities;
    ++newton_iterations_;
    const double linear_tolerance = std::clamp(length / scale, 1e-6, 0.1);
    Vectors direction;
    energy.linearise(velocities, false);
    if (!conjugate_gradients(energy, -gradient, linear_tolerance, direction)) {
      energy.linearise(velocities, true);
      conjugate_gradients(energy, -gradient, linear_tolerance, direction);
    }
    const double before = energy.value(velocities), slope = dot(gradient, direction);
    double share = 1;
    const auto lowers = [&](const Vectors &at) {
      const double value = energy.value(at);
      if (value < before + 1e-4 * share * slope) return true;
      // Close to the minimum the change is lost in rounding; the slope is not.
      return value <= before + 1e-6 * std::fabs(before) && std::fabs(dot(energy.gradient(at), direction)) < -0.5 * slope;
    };
    while (share > 1e-10 && !lowers(velocities + share * direction)) share /= 2;
    velocities += share * direction;
  }
  throw std::runtime_error("implicit step: no minimum was found");
}

void ImplicitStep::add_particles(const Vectors &positions, const Vectors &velocities, double volume, bool pinned) {
  for (Eigen::Index p = 0; p < positions.cols(); ++p) {
    particles_.ids.push_back(std::uint32_t(particles_.ids.size()));
    particles_.positions.push_back(positions.col(p));
    particles_.motions.push_back({velocities.col(p), pinned ? 0 : 1 / (material_.density * volume)});
    particles_.rest_volumes.push_back(volume);
    particles_.strains.push_back(Matrix3<double>::Zero());
    particles_.volume_corrections.push_back(0);
    particles_.log_volume_changes.push_back(0);
    drifts_.push_back(Vector3<double>::Zero());
  }
}

void ImplicitStep::set_velocities(const Vectors &velocities) {
  for (std::size_t p = 0; p < particles_.size(); ++p)
    if (particles_.motions[p].inverse_mass > 0) particles_.motions[p].velocity = velocities.col(particles_.ids[p]);
}

Vectors ImplicitStep::velocities_by_id() const {
  Vectors velocities(3, Eigen::Index(particles_.size()));
  for (std::size_t p = 0; p < particles_.size(); ++p) velocities.col(particles_.ids[p]) = particles_.motions[p].velocity;
  return velocities;
}

void ImplicitStep::advance(double h) {
  const double r = settings_.kernel_radius;
  const WendlandKernel<double> kernel(r);
  const CellGrid<double> grid = sort_by_cell(particles_, kernel.support());
  Neighbourhoods<double> neighbourhoods;
  find_neighbours(particles_, grid, kernel, 0.0, neighbourhoods);
  compute_gradients(particles_, kernel, settings_.gradient_cutoff, neighbourhoods);

  StepEnergy energy(HenckySolid::from(material_), particles_, neighbourhoods, settings_.fewest_neighbours,
                    2 * material_.shear_modulus * settings_.zero_energy_stiffness / (r * r), settings_.gravity, h);
  // Of gravity, of the stress and of the motion that the step starts with; at least of strains of 1e-5, so that rounding does not count at rest.
  double impulses = 0;
  Vectors drifts(3, energy.free_motion().cols()), velocities = energy.free_motion();
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    drifts.col(Eigen::Index(p)) = drifts_[particles_.ids[p]];
    velocities.col(Eigen::Index(p)) = particles_.motions[p].velocity;
    if (particles_.motions[p].inverse_mass == 0) continue;
    const double modulus = material_.lame_lambda + 2 * material_.shear_modulus;
    impulses += (h * settings_.gravity / particles_.motions[p].inverse_mass).squaredNorm() +
                std::pow(1e-5 * h * particles_.rest_volumes[p] * modulus / r, 2);
  }
  energy.set_drifts(drifts);
  const Vectors rest = Vectors::Zero(3, velocities.cols());
  impulses = std::sqrt(impulses) + energy.gradient(rest).norm();
  if (!std::isfinite(energy.value(velocities))) velocities = rest; // the last step's motion would turn matter inside out

  newton_iterations_ = 0;
  Vectors turned = drifts;
  for (int round = 0;; ++round) {
    energy.set_drifts(turned);
    velocities = minimise(energy, velocities, impulses);
    const Vectors before = turned;
    for (Eigen::Index p = 0; p < turned.cols(); ++p) {
      const Matrix3<double> H = energy.gradient_step(std::size_t(p), velocities);
      const Vector3<double> spin(H(2, 1) - H(1, 2), H(0, 2) - H(2, 0), H(1, 0) - H(0, 1));
      const Vector3<double> drift = drifts.col(p), moved = drift + spin.cross(drift) / 2;
      turned.col(p) = moved.norm() > 0 ? Vector3<double>(moved * (drift.norm() / moved.norm())) : moved;
    }
    if ((turned - before).norm() <= settings_.tolerance * (drifts.norm() + settings_.tolerance * r)) break;
    if (round == 50) throw std::runtime_error("implicit step: the drifts do not settle");
  }

  for (std::size_t p = 0; p < particles_.size(); ++p) {
    const Matrix3<double> H = energy.gradient_step(p, velocities);
    particles_.log_volume_changes[p] += std::log(std::max((Matrix3<double>::Identity() + H).determinant(), 0.1));
    if (neighbourhoods.count(p) >= settings_.fewest_neighbours) {
      particles_.strains[p] = reference::advance(particles_.strains[p], H);
      drifts_[particles_.ids[p]] = turned.col(Eigen::Index(p)) + energy.non_affine_step(p, velocities);
    }
  }
  for (std::size_t p = 0; p < particles_.size(); ++p) {
    particles_.motions[p].velocity = velocities.col(Eigen::Index(p));
    particles_.positions[p] += h * particles_.motions[p].velocity;
  }
}

void ImplicitStep::settle(int increments, double long_step) {
  const Vector3<double> gravity = settings_.gravity;
  constexpr int most_rounds = 100;
  for (int increment = 1; increment < increments + most_rounds; ++increment) {
    settings_.gravity = std::min(1.0, double(increment) / increments) * gravity;
    for (Motion<double> &motion : particles_.motions) motion.velocity.setZero();
    advance(long_step);
    double farthest = 0;
    for (Motion<double> &motion : particles_.motions) {
      farthest = std::max(farthest, long_step * motion.velocity.norm());
      motion.velocity.setZero();
    }
    if (increment >= increments && farthest < 1e-4 * settings_.kernel_radius) return;
  }
  settings_.gravity = gravity;
  throw std::runtime_error("implicit step: the body does not settle");
}

Vectors ImplicitStep::positions_by_id() const {
  Vectors positions(3, Eigen::Index(particles_.size()));
  for (std::size_t p = 0; p < particles_.size(); ++p)
    positions.col(Eigen::Index(particles_.ids[p])) = particles_.positions[p];
  return positions;
}

} // namespace loam::reference
