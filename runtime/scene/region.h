// A volume that is to be filled: a primitive or the inside of a mesh, cut with another, less an inset.
#pragma once

#include <memory>

#include <loam/particles.h>

#include "math/vector.h"
#include "scene/winding_number.h"

namespace loam {

// One loam_region, checked. Points are given in the region's own frame: its centre (of a mesh: its origin) at zero, its axes turned
// by its rotation.
class Region {
public:
  // `field` names the region in messages, such as "region". Throws Error INVALID_ARGUMENT naming field, value and range; INVALID_MESH
  // for a mesh that does not close.
  Region(const loam_region &region, const char *field);

  Vec3<double> to_world(Vec3<double> own) const { return rotate(rotation_, own) + centre_; }
  Vec3<double> to_own(Vec3<double> world) const { return rotate(conjugate(rotation_), world - centre_); }
  Vec3<double> lower() const { return lower_; }
  Vec3<double> upper() const { return upper_; }
  bool is_primitive() const { return mesh_ == nullptr; }

  // True if the point is inside and at least `inset` away from the boundary.
  bool contains(Vec3<double> own, double inset) const;

  // The distance to the boundary, negative outside.
  double depth(Vec3<double> own) const;

  // The volume of what is at least `inset` away from the boundary, where a formula gives it; otherwise negative.
  double exact_volume(double inset) const;

  // Of a mesh, how often it encloses the point; 0 or 1 for a primitive.
  double winding_number(Vec3<double> own) const;

private:
  void check_primitive(const loam_region &region, const char *field);
  void take_mesh(const loam_mesh &source, const char *field);

  std::uint32_t kind_;
  Vec3<double> centre_{};
  Vec4<double> rotation_{};
  Vec3<double> half_extents_{};
  double radius_ = 0, half_height_ = 0;
  std::unique_ptr<WindingNumber> mesh_;
  double orientation_ = 1; // -1 for a mesh that is inside out
  Vec3<double> lower_{}, upper_{};
};

// What samplers see: a region, a cut and an inset as one volume, in the region's own frame. The inset counts from the region's boundary,
// not from the cut's: a cut leaves a free surface.
class RegionSampler {
public:
  RegionSampler(const loam_region &region, const loam_region &cut, double inset);

  Vec3<double> lower() const { return lower_; }
  Vec3<double> upper() const { return upper_; }
  Vec3<float> to_world(Vec3<double> own) const;
  Vec3<double> to_own(Vec3<float> world) const;

  bool contains(Vec3<double> own) const;

  // A bound for how far the volume's boundary is, negative outside: all within |depth| of the point is on the same side.
  double depth(Vec3<double> own) const;

  // By formula where there is one; otherwise by an adaptive lattice, to about 1 in 1000.
  double volume() const { return volume_; }

private:
  void clip_bounds();
  double measured_volume() const;
  double lattice_volume(bool &overlaps_itself) const;

  Region region_;
  std::unique_ptr<Region> cut_;
  double inset_;
  Vec3<double> lower_{}, upper_{};
  double volume_ = 0;
};

} // namespace loam
