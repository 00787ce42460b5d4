// What is inside a mesh, and how far its surface is.
#pragma once

#include <vector>

#include "scene/bounding_volume_hierarchy.h"

namespace loam {

// The generalised winding number of a mesh (Jacobson, Kavan, Sorkine-Hornung, "Robust inside-outside segmentation using generalized
// winding numbers", 2013): the solid angle of the mesh seen from a point, over 4 pi. 1 inside a closed mesh, 0 outside, more where it
// overlaps itself. Not to be copied while in use; any thread may ask.
class WindingNumber {
public:
  explicit WindingNumber(const TriangleMesh &mesh);

  // Quickly; within about 0.1 of the exact sum.
  double at(Vec3<double> point) const;

  // The exact sum over all triangles, slowly.
  double exactly_at(Vec3<double> point) const;

  // The distance to the surface, or `limit` if that is less.
  float distance(Vec3<float> point, float limit) const;

  // The volume that a closed mesh encloses: negative if it is inside out.
  double signed_volume() const { return signed_volume_; }

  Vec3<float> lower() const { return lower_; }
  Vec3<float> upper() const { return upper_; }

private:
  // A part of the surface seen from afar: its area vector at its centre.
  struct Dipole {
    Vec3<double> area{};
    Vec3<double> centre{};
    double total_area = 0;
    double far_squared = 0; // from this squared distance on it may stand for its triangles
  };

  void build_dipoles();

  BoundingVolumeHierarchy hierarchy_;
  std::vector<Dipole> dipoles_; // two a node, one for each child
  Vec3<float> lower_{}, upper_{};
  double signed_volume_ = 0;
};

} // namespace loam
