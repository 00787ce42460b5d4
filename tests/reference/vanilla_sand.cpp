#include "vanilla_sand.h"

namespace loam::reference {

namespace {

/* How much of the sliding s, at a contact of this depth, friction takes back. */
Vector3<double> rubbed(const Vector3<double> &sliding, double depth, double static_friction, double kinetic_friction) {
  const double length = sliding.norm();
  if (length <= static_friction * depth) return sliding;
  return sliding * std::min(1.0, kinetic_friction * depth / length);
}

} // namespace

void VanillaSand::add_grain(const Vector3<double> &position, const Vector3<double> &velocity, double mass) {
  particles_.ids.push_back(std::uint32_t(particles_.ids.size()));
  particles_.positions.push_back(position);
  particles_.motions.push_back({velocity, 1 / mass});
  particles_.rest_volumes.push_back(0);
  particles_.strains.push_back(Matrix3<double>::Zero());
  particles_.volume_corrections.push_back(0);
  particles_.log_volume_changes.push_back(0);
}

void VanillaSand::add_plane(const Vector3<double> &point, const Vector3<double> &normal, double static_friction,
                            double kinetic_friction) {
  planes_.push_back({point, normal.normalized(), static_friction, kinetic_friction});
}

void VanillaSand::solve_pair(std::uint32_t first, std::uint32_t second) {
  const Vector3<double> offset = predicted_[first] - predicted_[second];
  const double distance = offset.norm(), depth = settings_.diameter - distance;
  if (depth <= 0 || distance == 0) return;
  const Vector3<double> normal = offset / distance;
  const double first_weight = particles_.motions[first].inverse_mass,
               second_weight = particles_.motions[second].inverse_mass;
  const double first_share = first_weight / (first_weight + second_weight), second_share = 1 - first_share;
  predicted_[first] += first_share * depth * normal;
  predicted_[second] -= second_share * depth * normal;
  const Vector3<double> moved =
      (predicted_[first] - particles_.positions[first]) - (predicted_[second] - particles_.positions[second]);
  const Vector3<double> friction =
      rubbed(moved - moved.dot(normal) * normal, depth, settings_.static_friction, settings_.kinetic_friction);
  predicted_[first] -= first_share * friction;
  predicted_[second] += second_share * friction;
}

void VanillaSand::solve_plane(std::size_t grain, const Plane &plane) {
  const double depth = settings_.diameter / 2 - plane.normal.dot(predicted_[grain] - plane.point);
  if (depth <= 0) return;
  predicted_[grain] += depth * plane.normal;
  const Vector3<double> moved = predicted_[grain] - particles_.positions[grain];
  predicted_[grain] -=
      rubbed(moved - moved.dot(plane.normal) * plane.normal, depth, plane.static_friction, plane.kinetic_friction);
}

void VanillaSand::advance(double h) {
  // Pairs within 1.5 diameters now are those that may touch within the step.
  const double reach = 1.5 * settings_.diameter;
  const WendlandKernel<double> kernel(reach / 2);
  const CellGrid<double> grid = sort_by_cell(particles_, kernel.support());
  Neighbourhoods<double> near;
  find_neighbours(particles_, grid, kernel, reach, near);

  predicted_.resize(particles_.size());
  for (std::size_t grain = 0; grain < particles_.size(); ++grain)
    predicted_[grain] = particles_.positions[grain] + h * (particles_.motions[grain].velocity + h * settings_.gravity);
  for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
    for (const ClosePair &pair : near.close_pairs) solve_pair(pair.first, pair.second);
    for (std::size_t grain = 0; grain < particles_.size(); ++grain)
      for (const Plane &plane : planes_) solve_plane(grain, plane);
  }
  for (std::size_t grain = 0; grain < particles_.size(); ++grain) {
    const Vector3<double> velocity = (predicted_[grain] - particles_.positions[grain]) / h;
    particles_.motions[grain].velocity = velocity;
    if (velocity.norm() >= settings_.sleep_speed) particles_.positions[grain] = predicted_[grain];
  }
}

} // namespace loam::reference
