#include "scalar_solver.h"

#include <chrono>

namespace loam::reference {

namespace {

/* Under this norm of the Hencky strain the direction of the constraint's gradient is 0/0. */
constexpr double smallest_strain = 1e-9;

/* A particle with fewer neighbours has no use for a velocity gradient. */
constexpr std::size_t fewest_neighbours = 3;

/* Adds the wall time of a scope to a stage. */
class Stopwatch {
public:
  explicit Stopwatch(double &seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch &) = delete;
  Stopwatch &operator=(const Stopwatch &) = delete;

private:
  using Clock = std::chrono::steady_clock;
  double &seconds_;
  Clock::time_point start_;
};

template <typename Action> void timed(double &seconds, const Action &action) {
  const Stopwatch stopwatch(seconds);
  action();
}

} // namespace

template <typename Real>
ScalarSolver<Real>::ScalarSolver(const Settings &settings, const Material<Real> &material)
    : settings_(settings), material_(material), kernel_(Real(settings.kernel_radius)),
      gravity_(Real(settings.gravity[0]), Real(settings.gravity[1]), Real(settings.gravity[2])) {}

template <typename Real>
void ScalarSolver<Real>::add_particles(const float *positions, const float *velocities, std::size_t count, double volume,
                                       bool pinned) {
  const Real inverse_mass = pinned ? Real(0) : 1 / (material_.density * Real(volume));
  for (std::size_t k = 0; k < 3 * count; k += 3) {
    Vector3<Real> velocity = Vector3<Real>::Zero();
    if (velocities) velocity = Vector3<Real>(Real(velocities[k]), Real(velocities[k + 1]), Real(velocities[k + 2]));
    particles_.ids.push_back(std::uint32_t(particles_.ids.size()));
    particles_.positions.emplace_back(Real(positions[k]), Real(positions[k + 1]), Real(positions[k + 2]));
    particles_.motions.push_back({velocity, inverse_mass});
    particles_.rest_volumes.push_back(Real(volume));
    particles_.strains.push_back(Matrix3<Real>::Zero());
    particles_.volume_corrections.push_back(0);
    particles_.log_volume_changes.push_back(0);
  }
}

template <typename Real> void ScalarSolver<Real>::add_plane(const float point[3], const float normal[3], double friction) {
  contacts_.add({Vector3<Real>(Real(point[0]), Real(point[1]), Real(point[2])),
                 Vector3<Real>(Real(normal[0]), Real(normal[1]), Real(normal[2])).normalized(), Real(friction)});
}

template <typename Real> void ScalarSolver<Real>::substep(Real h) {
  const Real r = Real(settings_.kernel_radius);
  const Real stand_off = r / 2;
  const Real close_distance = Real(settings_.minimum_distance) * r + r / 2;
  CellGrid<Real> grid;

  timed(seconds_.sort, [&] { grid = sort_by_cell(particles_, kernel_.support()); });
  timed(seconds_.neighbour_search, [&] { find_neighbours(particles_, grid, kernel_, close_distance, neighbourhoods_); });
  timed(seconds_.gradients,
        [&] { compute_gradients(particles_, kernel_, Real(settings_.gradient_cutoff), neighbourhoods_); });

  timed(seconds_.advance, [&] { accelerate(h); });
  multipliers_.assign(particles_.size(), Real(0));
  contacts_.reset(particles_.size());
  correction_virial_ = 0;
  for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
    timed(seconds_.solve, [&] { solve_all(h); });
    timed(seconds_.position_correction, [&] { correct_positions(h); });
    timed(seconds_.contacts, [&] { contacts_.solve(particles_, stand_off, h); });
  }
  timed(seconds_.velocity_smoothing, [&] { smooth_velocities(h); });
  timed(seconds_.contacts, [&] { contacts_.solve(particles_, stand_off, h); });
  timed(seconds_.advance, [&] { limit_speeds(h); });
  timed(seconds_.strain, [&] { advance_strains(h); });
  timed(seconds_.advance, [&] { advance_positions(h); });
  last_step_ = double(h);
}

template <typename Real> void ScalarSolver<Real>::accelerate(Real h) {
  for (Motion<Real> &motion : particles_.motions)
    if (motion.inverse_mass > 0) motion.velocity += h * gravity_;
}

/* sum_b (v_b - v_p) G_b^T. */
template <typename Real> Matrix3<Real> ScalarSolver<Real>::velocity_gradient(std::size_t particle) const {
  const Motion<Real> *motions = particles_.motions.data();
  const std::uint32_t *neighbour = neighbourhoods_.neighbour.data();
  const Vector3<Real> *gradient = neighbourhoods_.gradient.data();
  const std::uint32_t last = neighbourhoods_.first_pair[particle + 1];
  // Column by column, so that the sums stay in registers.
  Vector3<Real> by_x = Vector3<Real>::Zero(), by_y = by_x, by_z = by_x;
  for (std::uint32_t pair = neighbourhoods_.first_pair[particle]; pair < last; ++pair) {
    const Vector3<Real> &velocity = motions[neighbour[pair]].velocity;
    by_x += gradient[pair].x() * velocity;
    by_y += gradient[pair].y() * velocity;
    by_z += gradient[pair].z() * velocity;
  }
  Matrix3<Real> sum;
  sum << by_x, by_y, by_z;
  sum -= motions[particle].velocity * neighbourhoods_.gradient_sum[particle].transpose();
  return sum;
}

template <typename Real> void ScalarSolver<Real>::solve_all(Real h) {
  residual_squares_ = constraint_squares_ = 0;
  for (std::size_t particle = 0; particle < particles_.size(); ++particle)
    if (neighbourhoods_.count(particle) >= fewest_neighbours) solve_particle(particle, h);
  pair_visits_ += neighbourhoods_.pair_count();
}

template <typename Real> void ScalarSolver<Real>::solve_particle(std::size_t particle, Real h) {
  const Matrix3<Real> velocity_gradient_step = h * velocity_gradient(particle);
  const Matrix3<Real> trial = advance(particles_.strains[particle], velocity_gradient_step);
  const PrincipalStrain<Real> principal = principal_hencky_strain(trial, Real(settings_.hencky_bound));
  ReturnMapping<Real> mapped = {principal.strain, 0, false};
  if (settings_.plasticity == Plasticity::implicit)
    mapped = material_.project(principal.strain, particles_.volume_corrections[particle]);
  if (mapped.strain.norm() < Real(smallest_strain)) return;

  // C and A = dC/dF F^T (I + H)^-T, where F^T belongs to the trial: tau / C times the ratio of trial to mapped stretch.
  const Real constraint = std::sqrt(2 * material_.energy_density(mapped.strain));
  Vector3<Real> stress = material_.kirchhoff_stress(mapped.strain);
  if (mapped.yielded) stress.array() *= (principal.strain - mapped.strain).array().exp();
  const Matrix3<Real> derivative =
      compose<Real>(principal.directions, stress / constraint) * inverse_transpose_of_step(velocity_gradient_step);

  const Real compliance = 1 / (particles_.rest_volumes[particle] * h * h);
  const Matrix3<Real> &moment = neighbourhoods_.gradient_moment[particle];
  const Vector3<Real> own_gradient = derivative * neighbourhoods_.gradient_sum[particle];
  Motion<Real> *motions = particles_.motions.data();
  const Real squared_gradient =
      (derivative * moment).cwiseProduct(derivative).sum() + motions[particle].inverse_mass * own_gradient.squaredNorm();
  const Real residual = constraint + compliance * multipliers_[particle];
  const Real change = -residual / (squared_gradient + compliance);
  multipliers_[particle] += change;
  residual_squares_ += double(residual) * double(residual);
  constraint_squares_ += double(constraint) * double(constraint);

  const Matrix3<Real> impulse = derivative * (change / h);
  const Vector3<Real> by_x = impulse.col(0), by_y = impulse.col(1), by_z = impulse.col(2);
  const std::uint32_t *neighbour = neighbourhoods_.neighbour.data();
  const Vector3<Real> *gradient = neighbourhoods_.gradient.data();
  const std::uint32_t last = neighbourhoods_.first_pair[particle + 1];
  for (std::uint32_t pair = neighbourhoods_.first_pair[particle]; pair < last; ++pair) {
    Motion<Real> &motion = motions[neighbour[pair]];
    const Vector3<Real> weighted = motion.inverse_mass * gradient[pair];
    motion.velocity += weighted.x() * by_x;
    motion.velocity += weighted.y() * by_y;
    motion.velocity += weighted.z() * by_z;
  }
  motions[particle].velocity -= motions[particle].inverse_mass * (change / h) * own_gradient;
}

/* |x_a - x_b| >= minimum_distance r at the end of the substep: a rigid constraint, so the impulse is the projection itself. */
template <typename Real> void ScalarSolver<Real>::correct_positions(Real h) {
  const Real distance_bound = Real(settings_.minimum_distance * settings_.kernel_radius);
  for (const ClosePair &pair : neighbourhoods_.close_pairs) {
    Motion<Real> &first = particles_.motions[pair.first], &second = particles_.motions[pair.second];
    const Vector3<Real> start = particles_.positions[pair.first] - particles_.positions[pair.second];
    const Vector3<Real> offset = start + h * (first.velocity - second.velocity);
    const Real squared_distance = offset.squaredNorm();
    const Real inverse_masses = first.inverse_mass + second.inverse_mass;
    if (squared_distance >= distance_bound * distance_bound || squared_distance == 0 || inverse_masses == 0) continue;
    const Real distance = std::sqrt(squared_distance);
    const Vector3<Real> impulse = offset * ((distance_bound - distance) / (distance * h * inverse_masses));
    first.velocity += first.inverse_mass * impulse;
    second.velocity -= second.inverse_mass * impulse;
    correction_virial_ += double(impulse.dot(gravity_) * start.dot(gravity_));
  }
}

/* XSPH (Schechter and Bridson 2012; equation 20 of the paper), with the weight m_p V_b replaced by its mean with m_b V_p: what p gains b
 * loses. Beside a pinned particle, whose mass is infinite, the weight is V_b as in the paper. */
template <typename Real> void ScalarSolver<Real>::smooth_velocities(Real h) {
  const Real coefficient = std::min(Real(settings_.velocity_smoothing) * h, Real(1));
  if (coefficient == 0) return;
  const std::vector<Motion<Real>> before = particles_.motions;
  std::vector<Real> volumes(particles_.size());
  for (std::size_t particle = 0; particle < particles_.size(); ++particle) volumes[particle] = particles_.volume(particle);
  for (std::size_t particle = 0; particle < particles_.size(); ++particle) {
    const Real inverse_mass = before[particle].inverse_mass;
    if (inverse_mass == 0) continue;
    Vector3<Real> change = Vector3<Real>::Zero();
    for (std::uint32_t pair = neighbourhoods_.first_pair[particle]; pair < neighbourhoods_.first_pair[particle + 1];
         ++pair) {
      const std::uint32_t other = neighbourhoods_.neighbour[pair];
      const Real other_inverse_mass = before[other].inverse_mass;
      const Real volume = other_inverse_mass == 0
                              ? volumes[other]
                              : (volumes[other] + volumes[particle] * inverse_mass / other_inverse_mass) / 2;
      change += volume * neighbourhoods_.kernel_value[pair] * (before[other].velocity - before[particle].velocity);
    }
    particles_.motions[particle].velocity += coefficient * change;
  }
}

/* No particle crosses more than r in a substep. */
template <typename Real> void ScalarSolver<Real>::limit_speeds(Real h) {
  const Real bound = Real(settings_.kernel_radius) / h;
  for (Motion<Real> &motion : particles_.motions) {
    const Real squared_speed = motion.velocity.squaredNorm();
    if (motion.inverse_mass > 0 && squared_speed > bound * bound) motion.velocity *= bound / std::sqrt(squared_speed);
  }
}

/* The end of the substep for the strain: the velocity that moves the particles also strains them, and history variables, which the loop read as of
 * the start, advance now. */
template <typename Real> void ScalarSolver<Real>::advance_strains(Real h) {
  for (std::size_t particle = 0; particle < particles_.size(); ++particle) {
    if (neighbourhoods_.count(particle) < fewest_neighbours) {
      if (material_.law != Law::elastic) particles_.strains[particle].setZero();
      continue;
    }
    const Matrix3<Real> velocity_gradient_step = h * velocity_gradient(particle);
    const Real volume_ratio = (Matrix3<Real>::Identity() + velocity_gradient_step).determinant();
    particles_.log_volume_changes[particle] += std::log(std::max(volume_ratio, Real(0.1)));

    const Matrix3<Real> trial = advance(particles_.strains[particle], velocity_gradient_step);
    const PrincipalStrain<Real> principal = principal_hencky_strain(trial, Real(settings_.hencky_bound));
    const ReturnMapping<Real> mapped = material_.project(principal.strain, particles_.volume_corrections[particle]);
    particles_.volume_corrections[particle] = mapped.volume_correction;
    particles_.strains[particle] =
        mapped.yielded || principal.clamped ? strain_from_hencky(principal.directions, mapped.strain) : trial;
  }
}

template <typename Real> void ScalarSolver<Real>::advance_positions(Real h) {
  for (std::size_t particle = 0; particle < particles_.size(); ++particle)
    particles_.positions[particle] += h * particles_.motions[particle].velocity;
}

template class ScalarSolver<float>;
template class ScalarSolver<double>;

} // namespace loam::reference
