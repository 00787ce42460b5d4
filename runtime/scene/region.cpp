#include "scene/region.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "scene/error.h"
#include "scene/random.h"

namespace loam {
namespace {

using std::numbers::pi;
constexpr float max_length = 1e12f; // a million of the largest kernel radii

void check_finite(float value, const char *field, const char *name) {
  if (!(std::fabs(value) <= max_length)) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("%s.%s is %g, must be finite and within +-%g", field, name, double(value), double(max_length)));
  }
}

void check_positive(float value, const char *field, const char *name) {
  if (!(value > 0.0f && value <= max_length)) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("%s.%s is %g, must be over 0 and at most %g", field, name, double(value), double(max_length)));
  }
}

Vec4<double> checked_rotation(const float rotation[4], const char *field) {
  double norm_squared = 0;
  for (int i = 0; i < 4; ++i) {
    check_finite(rotation[i], field, format("rotation[%d]", i).c_str());
    norm_squared += double(rotation[i]) * rotation[i];
  }
  if (norm_squared == 0) return {0, 0, 0, 1};
  const double scale = 1.0 / std::sqrt(norm_squared);
  return {scale * rotation[0], scale * rotation[1], scale * rotation[2], scale * rotation[3]};
}

double outside_part(double x) { return std::max(x, 0.0); }

Vec3<double> corner_of(Vec3<double> lower, Vec3<double> upper, int corner) {
  return {(corner & 1) != 0 ? upper.x : lower.x, (corner & 2) != 0 ? upper.y : lower.y,
          (corner & 4) != 0 ? upper.z : lower.z};
}

bool within(Vec3<double> point, Vec3<double> lower, Vec3<double> upper) {
  return point.x >= lower.x && point.y >= lower.y && point.z >= lower.z && point.x <= upper.x && point.y <= upper.y &&
         point.z <= upper.z;
}

} // namespace

Region::Region(const loam_region &region, const char *field) : kind_(region.kind) {
  if (kind_ < LOAM_REGION_BOX || kind_ > LOAM_REGION_MESH) {
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("%s.kind is %u, must be BOX (1), SPHERE (2), CYLINDER (3) or MESH (4)", field, kind_));
  }
  for (int i = 0; i < 3; ++i) check_finite(region.center[i], field, format("center[%d]", i).c_str());
  centre_ = {region.center[0], region.center[1], region.center[2]};
  rotation_ = checked_rotation(region.rotation, field);
  if (kind_ == LOAM_REGION_MESH) {
    take_mesh(region.mesh, field);
  } else {
    check_primitive(region, field);
  }
}

void Region::check_primitive(const loam_region &region, const char *field) {
  if (kind_ == LOAM_REGION_BOX) {
    for (int i = 0; i < 3; ++i) check_positive(region.half_extents[i], field, format("half_extents[%d]", i).c_str());
    half_extents_ = {region.half_extents[0], region.half_extents[1], region.half_extents[2]};
  } else {
    check_positive(region.radius, field, "radius");
    radius_ = region.radius;
    half_height_ = radius_;
    if (kind_ == LOAM_REGION_CYLINDER) {
      check_positive(region.half_height, field, "half_height");
      half_height_ = region.half_height;
    }
    half_extents_ = {radius_, half_height_, radius_};
  }
  lower_ = -1.0 * half_extents_;
  upper_ = half_extents_;
}

void Region::take_mesh(const loam_mesh &source, const char *field) {
  const std::string name = std::string(field) + ".mesh";
  const TriangleMesh mesh = make_triangle_mesh(source, name.c_str());
  if (mesh.report.closed == 0) {
    throw Error(LOAM_ERROR_INVALID_MESH, name + " does not close, so it has no inside: " + mesh.first_flaw);
  }
  mesh_ = std::make_unique<WindingNumber>(mesh);
  orientation_ = mesh_->signed_volume() < 0 ? -1 : 1;
  lower_ = {mesh_->lower().x, mesh_->lower().y, mesh_->lower().z};
  upper_ = {mesh_->upper().x, mesh_->upper().y, mesh_->upper().z};
}

double Region::winding_number(Vec3<double> own) const {
  if (mesh_ == nullptr) return depth(own) > 0 ? 1 : 0;
  if (!within(own, lower_, upper_)) return 0;
  const double quick = orientation_ * mesh_->at(own);
  return std::fabs(quick - std::round(quick)) < 0.25 ? quick : orientation_ * mesh_->exactly_at(own);
}

bool Region::contains(Vec3<double> own, double inset) const {
  if (mesh_ == nullptr) return depth(own) > inset;
  if (!(winding_number(own) > 0.5)) return false;
  const float limit = float(inset);
  return inset == 0 || mesh_->distance({float(own.x), float(own.y), float(own.z)}, limit) >= limit;
}

double Region::depth(Vec3<double> own) const {
  switch (kind_) {
  case LOAM_REGION_SPHERE:
    return radius_ - length(own);
  case LOAM_REGION_BOX: {
    const Vec3<double> beyond = {std::fabs(own.x) - half_extents_.x, std::fabs(own.y) - half_extents_.y,
                                 std::fabs(own.z) - half_extents_.z};
    const double furthest = std::max({beyond.x, beyond.y, beyond.z});
    if (furthest <= 0) return -furthest;
    return -length(Vec3<double>{outside_part(beyond.x), outside_part(beyond.y), outside_part(beyond.z)});
  }
  case LOAM_REGION_CYLINDER: {
    const double around = std::sqrt(own.x * own.x + own.z * own.z) - radius_;
    const double along = std::fabs(own.y) - half_height_;
    const double furthest = std::max(around, along);
    if (furthest <= 0) return -furthest;
    return -length(Vec3<double>{outside_part(around), outside_part(along), 0});
  }
  default: {
    const double distance = mesh_->distance({float(own.x), float(own.y), float(own.z)}, 1e15f);
    return winding_number(own) > 0.5 ? distance : -distance;
  }
  }
}

double Region::exact_volume(double inset) const {
  const auto left = [inset](double half) { return std::max(half - inset, 0.0); };
  switch (kind_) {
  case LOAM_REGION_BOX:
    return 8.0 * left(half_extents_.x) * left(half_extents_.y) * left(half_extents_.z);
  case LOAM_REGION_SPHERE:
    return 4.0 / 3.0 * pi * left(radius_) * left(radius_) * left(radius_);
  case LOAM_REGION_CYLINDER:
    return pi * left(radius_) * left(radius_) * 2.0 * left(half_height_);
  default:
    return inset == 0 ? std::fabs(mesh_->signed_volume()) : -1.0;
  }
}

RegionSampler::RegionSampler(const loam_region &region, const loam_region &cut, double inset)
    : region_(region, "region"), inset_(inset) {
  if (cut.kind != LOAM_REGION_NONE) cut_ = std::make_unique<Region>(cut, "cut");
  const Vec3<double> margin = {inset, inset, inset};
  lower_ = region_.lower() + margin;
  upper_ = region_.upper() - margin;
  if (cut_ != nullptr) clip_bounds();
  volume_ = measured_volume();
}

void RegionSampler::clip_bounds() {
  Vec3<double> lowest{1e300, 1e300, 1e300}, highest{-1e300, -1e300, -1e300};
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3<double> p = region_.to_own(cut_->to_world(corner_of(cut_->lower(), cut_->upper(), corner)));
    lowest = {std::min(lowest.x, p.x), std::min(lowest.y, p.y), std::min(lowest.z, p.z)};
    highest = {std::max(highest.x, p.x), std::max(highest.y, p.y), std::max(highest.z, p.z)};
  }
  lower_ = {std::max(lower_.x, lowest.x), std::max(lower_.y, lowest.y), std::max(lower_.z, lowest.z)};
  upper_ = {std::min(upper_.x, highest.x), std::min(upper_.y, highest.y), std::min(upper_.z, highest.z)};
}

Vec3<float> RegionSampler::to_world(Vec3<double> own) const {
  const Vec3<double> world = region_.to_world(own);
  return {float(world.x), float(world.y), float(world.z)};
}

Vec3<double> RegionSampler::to_own(Vec3<float> world) const { return region_.to_own({world.x, world.y, world.z}); }

bool RegionSampler::contains(Vec3<double> own) const {
  if (!within(own, lower_, upper_)) return false;
  if (cut_ != nullptr && !cut_->contains(cut_->to_own(region_.to_world(own)), 0)) return false;
  return region_.contains(own, inset_);
}

double RegionSampler::depth(Vec3<double> own) const {
  const double depth = region_.depth(own) - inset_;
  return cut_ == nullptr ? depth : std::min(depth, cut_->depth(cut_->to_own(region_.to_world(own))));
}

double RegionSampler::measured_volume() const {
  if (!(lower_.x < upper_.x && lower_.y < upper_.y && lower_.z < upper_.z)) return 0;
  const double exact = cut_ == nullptr ? region_.exact_volume(inset_) : -1.0;
  if (exact == 0) return 0;
  if (exact > 0 && region_.is_primitive()) return exact;
  // A mesh that overlaps itself counts the overlap twice in its signed volume, but it can be filled only once.
  bool overlaps_itself = false;
  const double counted = lattice_volume(overlaps_itself);
  return exact > 0 && !overlaps_itself ? exact : counted;
}

// Cubes that the boundary does not reach count whole or not at all; the others are cut into eight until there are too many. What the
// boundary leaves of a smallest cube is estimated as if it cut it straight along an axis.
double RegionSampler::lattice_volume(bool &overlaps_itself) const {
  constexpr std::size_t max_cubes = 100000;
  constexpr int max_levels = 24;
  const Vec3<double> extent = upper_ - lower_;
  double side = std::max({extent.x, extent.y, extent.z});
  std::vector<Vec3<double>> cubes{0.5 * (lower_ + upper_)}, finer;
  std::vector<double> depths;
  double volume = 0;
  for (int level = 0; level < max_levels && cubes.size() <= max_cubes / 8; ++level) {
    side *= 0.5;
    const double half_diagonal = std::sqrt(3.0) / 2 * side;
    const Vec3<double> quarter = {0.5 * side, 0.5 * side, 0.5 * side};
    finer.clear();
    depths.clear();
    for (const Vec3<double> &cube : cubes) {
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3<double> centre = corner_of(cube - quarter, cube + quarter, corner);
        const double here = depth(centre);
        if (std::fabs(here) <= half_diagonal) {
          finer.push_back(centre);
          depths.push_back(here);
          continue;
        }
        if (here > 0) volume += side * side * side;
        const double winding = region_.winding_number(centre);
        overlaps_itself = overlaps_itself || winding > 1.5 || winding < -0.5;
      }
    }
    cubes.swap(finer);
  }
  // Where a mesh overlaps itself, the surface that lies inside bounds nothing: there a cube counts by one point in it, taken at random so
  // that no row of cubes is counted wrong together.
  Random random{1};
  for (std::size_t i = 0; i < depths.size(); ++i) {
    double share = std::clamp(0.5 + depths[i] / side, 0.0, 1.0);
    if (overlaps_itself) {
      const Vec3<double> offset = {random.between(-0.5, 0.5), random.between(-0.5, 0.5), random.between(-0.5, 0.5)};
      share = contains(cubes[i] + side * offset) ? 1.0 : 0.0;
    }
    volume += share * side * side * side;
  }
  return volume;
}

} // namespace loam
