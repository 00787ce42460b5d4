// Free particles and colliders, driven by the three contact kernels alone.
#pragma once

#include <memory>
#include <vector>

#include "kernels/contact/find_contacts.h"
#include "kernels/contact/solve_contacts.h"
#include "kernels/contact/sweep_contacts.h"
#include "scene/bounding_volume_hierarchy.h"
#include "unit/test_meshes.h"

namespace loam::test {

inline Vec4<float> turn(Vec3<float> axis, float angle) {
  const Vec3<float> v = (std::sin(angle / 2) / length(axis)) * axis;
  return {v.x, v.y, v.z, std::cos(angle / 2)};
}

struct ContactScene {
  float radius = 0.01f; // r
  float substep = 5e-4f;
  int iterations = 5;
  bool solve = true;      // false: the sweep alone has to hold
  bool backwards = false; // the particles are visited in reverse
  Vec3<float> gravity{0, -9.81f, 0};
  std::vector<Row> positions, velocities;
  std::vector<ColliderView> colliders;
  std::vector<Contact> contacts;
  int contact_count = 0;

  float stand_off() const { return 0.5f * radius; }
  float margin() const { return 0.05f * stand_off(); }

  void add(Vec3<float> x, Vec3<float> v = {0, 0, 0}) {
    positions.push_back({x.x, x.y, x.z, 1e-6f});
    velocities.push_back({v.x, v.y, v.z, 1000.0f});
  }
  int add_plane(float friction, Pose pose = {{0, 0, 0}, {0, 0, 0, 1}}) {
    Shape shape{};
    shape.kind = LOAM_COLLIDER_PLANE;
    return add_shape(shape, friction, pose);
  }
  int add_mesh(const MeshData &data, float friction, Pose pose = {{0, 0, 0}, {0, 0, 0, 1}}) {
    hierarchies.push_back(
        std::make_unique<BoundingVolumeHierarchy>(build_bounding_volume_hierarchy(make_triangle_mesh(data.view(), "mesh"))));
    const BoundingVolumeHierarchy &h = *hierarchies.back();
    Shape shape{};
    shape.kind = LOAM_COLLIDER_MESH;
    shape.mesh = {h.nodes.data(), h.packets.data(), h.features.data(), h.ring.data(), nullptr, 0};
    return add_shape(shape, friction, pose);
  }
  int add_shape(const Shape &shape, float friction, Pose pose = {{0, 0, 0}, {0, 0, 0, 1}}) {
    colliders.push_back({{friction, 0, 0}, nullptr, pose, pose, shape});
    return int(colliders.size()) - 1;
  }
  // Where a collider is to be at the end of the next substep.
  void move(int collider, const Pose &pose) { colliders[std::size_t(collider)].end = pose; }

  Vec3<float> x(std::size_t i) const { return xyz(positions[i]); }
  Vec3<float> v(std::size_t i) const { return xyz(velocities[i]); }

  void find() {
    contacts.resize(positions.size());
    contact_count = 0;
    const FindContacts kernel{
        positions.data(), velocities.data(), colliders.data(),     int(colliders.size()), substep, stand_off(),
        radius,           contacts.data(),   int(contacts.size()), &contact_count};
    const int count = int(positions.size());
    for (int i = 0; i < count; ++i) kernel(backwards ? count - 1 - i : i);
  }

  void step() {
    for (Row &row : velocities) {
      Vec3<float> v = xyz(row) + substep * gravity;
      const float fastest = radius / substep, speed = length(v);
      if (speed > fastest) v = (fastest / speed) * v;
      row = {v.x, v.y, v.z, row.w};
    }
    find();
    const SolveContacts solver{contacts.data(), velocities.data(), substep};
    for (int k = 0; k < iterations && solve; ++k) {
      for (int c = 0; c < contact_count; ++c) solver(c);
    }
    const SweepContacts sweep{contacts.data(),       positions.data(), velocities.data(), colliders.data(),
                              int(colliders.size()), substep,          margin()};
    for (int c = 0; c < contact_count; ++c) sweep(c);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3<float> moved = x(i) + substep * v(i);
      positions[i] = {moved.x, moved.y, moved.z, positions[i].w};
    }
    for (ColliderView &collider : colliders) collider.start = collider.end;
  }

private:
  std::vector<std::unique_ptr<BoundingVolumeHierarchy>> hierarchies;
};

} // namespace loam::test
