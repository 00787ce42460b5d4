// The shapes of a world's colliders where the kernels find them, over any executor.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <type_traits>

#include "solver/collider_shape.h"
#include "solver/deforming_mesh.h"

namespace loam {

// Calls f(std::true_type) or f(std::false_type): the contact kernels of worlds where no mesh deforms do not ask for it.
template <class F> void with_deforming(bool deforms, F &&f) {
  if (deforms)
    f(std::true_type());
  else
    f(std::false_type());
}

template <class Executor> class ColliderShapes {
public:
  explicit ColliderShapes(Executor &executor) : executor_(executor) {}

  // Answers with the shape's number. Throws Error OUT_OF_MEMORY.
  int add(const ColliderShape &shape) {
    Stored stored = {executor_.template array<BvhNode>(),
                     executor_.template array<TrianglePacket>(),
                     executor_.template array<BvhFeatures>(),
                     executor_.template array<Vec3<float>>(),
                     executor_.template array<HullFace>(),
                     executor_.template array<float>(),
                     nullptr,
                     Shape{},
                     0,
                     true};
    std::visit([&](const auto &each) { store(stored, each); }, shape);
    stored.extent *= 1.00001f;
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      if (!shapes_[i].in_use) {
        shapes_[i] = std::move(stored);
        return static_cast<int>(i);
      }
    shapes_.push_back(std::move(stored));
    return static_cast<int>(shapes_.size()) - 1;
  }
  void remove(int shape) {
    Stored &stored = shapes_[static_cast<std::size_t>(shape)];
    stored.nodes.free();
    stored.packets.free();
    stored.features.free();
    stored.ring.free();
    stored.faces.free();
    stored.values.free();
    stored.deforming.reset();
    stored.in_use = false;
  }

  // The greatest distance of a point of the surface from the shape's origin.
  float extent(int shape) const {
    const Stored &stored = shapes_[static_cast<std::size_t>(shape)];
    return stored.deforming != nullptr ? stored.deforming->extent() : stored.extent;
  }
  std::uint64_t bytes() const {
    std::uint64_t bytes = 0;
    for (const Stored &s : shapes_)
      bytes += s.nodes.bytes() + s.packets.bytes() + s.features.bytes() + s.ring.bytes() + s.faces.bytes() +
               s.values.bytes() + (s.deforming != nullptr ? s.deforming->bytes() : 0);
    return bytes;
  }

  // ------------------------------------------------------------------------------------ meshes that deform ---

  // Null where the shape does not.
  DeformingMesh<Executor> *deforming(int shape) { return shapes_[static_cast<std::size_t>(shape)].deforming.get(); }
  template <class F> void for_each_deforming(F &&f) {
    for (Stored &stored : shapes_)
      if (stored.deforming != nullptr) f(*stored.deforming);
  }
  // Does its surface move in its own frame, in this step?
  bool moves(int shape) const {
    const Stored &stored = shapes_[static_cast<std::size_t>(shape)];
    return stored.deforming != nullptr && stored.deforming->moves();
  }
  float motion(int shape, std::uint32_t substeps) const { // the most in a substep
    return moves(shape) ? shapes_[static_cast<std::size_t>(shape)].deforming->motion(substeps) : 0.0f;
  }
  // What is seen of it in a substep of this step.
  const Shape &place(int shape, std::uint32_t index, std::uint32_t substeps) {
    Stored &stored = shapes_[static_cast<std::size_t>(shape)];
    if (stored.deforming != nullptr) {
      stored.deforming->place(index, substeps, {stored.nodes, stored.packets, stored.ring});
      stored.shape.mesh.packets = stored.packets.data();
      stored.shape.mesh.end_packets = stored.deforming->end_packets();
      stored.shape.mesh.motion = stored.deforming->motion(substeps);
    }
    return stored.shape;
  }

private:
  template <class T> using Array = typename Executor::template Array<T>;
  struct Stored {
    Array<BvhNode> nodes;
    Array<TrianglePacket> packets;
    Array<BvhFeatures> features;
    Array<Vec3<float>> ring;
    Array<HullFace> faces;
    Array<float> values;
    std::unique_ptr<DeformingMesh<Executor>> deforming; // null: its vertices stay
    Shape shape;
    float extent;
    bool in_use;
  };
  template <class T> void copy_in(Array<T> &array, const std::vector<T> &values) {
    array.reserve(std::max<std::size_t>(values.size(), 1));
    executor_.upload(array.data(), values.data(), values.size());
  }

  void store(Stored &stored, const PlaneShape &plane) {
    stored.shape.kind = LOAM_COLLIDER_PLANE;
    stored.shape.plane = plane;
    stored.extent = std::numeric_limits<float>::infinity();
  }
  void store(Stored &stored, const SphereShape &sphere) {
    stored.shape.kind = LOAM_COLLIDER_SPHERE;
    stored.shape.sphere = sphere;
    stored.extent = sphere.radius;
  }
  void store(Stored &stored, const CapsuleShape &capsule) {
    stored.shape.kind = LOAM_COLLIDER_CAPSULE;
    stored.shape.capsule = capsule;
    stored.extent = capsule.radius + capsule.half_height;
  }
  void store(Stored &stored, const BoxShape &box) {
    stored.shape.kind = LOAM_COLLIDER_BOX;
    stored.shape.box = box;
    stored.extent = length(box.half_extents);
  }
  void store(Stored &stored, const ConvexHull &hull) {
    copy_in(stored.faces, hull.faces);
    float squared = 0, size = 0;
    for (const HullFace &face : hull.faces)
      for (const Vec3<float> &v : {face.a, face.b, face.c}) {
        squared = std::max(squared, dot(v, v));
        size = std::max({size, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
      }
    stored.shape.kind = LOAM_COLLIDER_HULL;
    stored.shape.hull = {stored.faces.data(), static_cast<int>(hull.faces.size()), size};
    stored.extent = square_root(squared);
  }
  void store(Stored &stored, const DistanceGrid &grid) {
    copy_in(stored.values, grid.values);
    stored.shape.kind = LOAM_COLLIDER_GRID;
    stored.shape.grid = grid.shape;
    stored.shape.grid.values = stored.values.data();
    const Vec3<float> low = grid.shape.origin;
    const auto farther = [&](float from, int count) {
      return std::max(std::abs(from), std::abs(from + grid.shape.spacing * static_cast<float>(count - 1)));
    };
    stored.extent = length(Vec3<float>{farther(low.x, grid.shape.size[0]), farther(low.y, grid.shape.size[1]),
                                       farther(low.z, grid.shape.size[2])});
  }
  void store(Stored &stored, const BoundingVolumeHierarchy &mesh) {
    copy_in(stored.nodes, mesh.nodes);
    copy_in(stored.packets, mesh.packets);
    copy_in(stored.features, mesh.features);
    copy_in(stored.ring, mesh.ring);
    float squared = 0;
    for (const BvhTriangle &t : mesh.triangles) squared = std::max({squared, dot(t.a, t.a), dot(t.b, t.b), dot(t.c, t.c)});
    stored.shape.kind = LOAM_COLLIDER_MESH;
    stored.shape.mesh = {stored.nodes.data(), stored.packets.data(), stored.features.data(), stored.ring.data(), nullptr, 0};
    if (!mesh.vertices.positions.empty()) stored.deforming = std::make_unique<DeformingMesh<Executor>>(executor_, mesh);
    stored.extent = square_root(squared);
  }

  Executor &executor_;
  std::vector<Stored> shapes_;
};

} // namespace loam
