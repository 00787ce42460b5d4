// A collider's mesh whose vertices the host moves: where they are, where they go in the next step, and what contact queries see of it in each substep.
#pragma once

#include <vector>

#include "kernels/contact/deforming_mesh.h"
#include "kernels/integration/measures.h"
#include "scene/bounding_volume_hierarchy.h"
#include "solver/state_section.h"

namespace loam {

template <class Executor> class DeformingMesh {
public:
  template <class T> using Array = typename Executor::template Array<T>;
  // The shape's own arrays, which are placed anew.
  struct Surface {
    Array<BvhNode> &nodes;
    Array<TrianglePacket> &packets;
    Array<Vec3<float>> &ring;
  };

  // Throws Error OUT_OF_MEMORY.
  DeformingMesh(Executor &executor, const BoundingVolumeHierarchy &mesh)
      : executor_(executor), end_packets_(executor.template array<TrianglePacket>()), from_(executor.template array<Row>()),
        to_(executor.template array<Row>()), vertices_of_triangles_(executor.template array<std::uint32_t>()),
        vertices_of_ring_(executor.template array<std::uint32_t>()), node_order_(executor.template array<std::uint32_t>()),
        levels_(mesh.vertices.levels), packet_count_(static_cast<int>(mesh.packets.size())),
        ring_count_(static_cast<int>(mesh.ring.size())), rows_(mesh.vertices.positions.size()) {
    copy_in(end_packets_, mesh.packets);
    copy_in(vertices_of_triangles_, mesh.vertices.of_triangles);
    copy_in(vertices_of_ring_, mesh.vertices.of_ring);
    copy_in(node_order_, mesh.vertices.nodes);
    from_.reserve(rows_.size());
    to_.reserve(rows_.size());
    move(&mesh.vertices.positions[0].x, true);
  }

  // 3 floats a vertex, where they are to be at the end of the next step. At once: they are there now.
  void move(const float *positions, bool at_once) {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows_[i] = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2], 0.0f};
    executor_.upload(to_.data(), rows_.data(), rows_.size());
    if (at_once) executor_.copy(from_.data(), to_.data(), rows_.size());
    is_placed_ = is_placed_ && !at_once;
    is_measured_ = false;
  }

  void begin_step() {
    placed_end_ = -1;
    if (is_measured_) return;
    const MeasureWays::Value most = executor_.reduce(vertex_count(), MeasureWays{ways()});
    way_ = most.way;
    extent_ = 1.00001f * most.extent;
    is_measured_ = true;
  }
  // Places what is seen in a substep, number `index` of the step.
  void place(std::uint32_t index, std::uint32_t substeps, const Surface &surface) {
    if (!moves()) {
      if (is_placed_) return;
      place_triangles(surface.packets, 0.0f);
      finish_placing(surface, surface.packets, 0.0f);
      is_placed_ = true;
      return;
    }
    const float start = share(index, substeps), end = share(index + 1, substeps);
    if (placed_end_ == static_cast<int>(index))
      surface.packets.swap(end_packets_);
    else if (!is_placed_ || index > 0)
      place_triangles(surface.packets, start);
    place_triangles(end_packets_, end);
    finish_placing(surface, end_packets_, start);
    placed_end_ = static_cast<int>(index) + 1;
    is_placed_ = false;
  }
  // The step is over, or was given up after this share of it.
  void end_step(double share) {
    if (!moves()) return;
    if (share < 1)
      executor_.for_each(vertex_count(), StopVertices{from_.data(), to_.data(), static_cast<float>(share)});
    else
      executor_.copy(from_.data(), to_.data(), rows_.size());
    way_ = 0;
    is_measured_ = false;
  }
  // Positions were written.
  void renew() { is_placed_ = is_measured_ = false; }

  // In this step.
  bool moves() const { return way_ > 0.0f; }
  // The most that a vertex moves in a substep, with what is rounded.
  float motion(std::uint32_t substeps) const {
    return moves() ? 1.00001f * way_ / static_cast<float>(substeps) + 1e-6f * extent_ : 0.0f;
  }
  // The greatest distance of a vertex from the origin in this step.
  float extent() const { return extent_; }
  const TrianglePacket *end_packets() const { return moves() ? end_packets_.data() : nullptr; }

  std::uint64_t hash(std::uint64_t hash) {
    hash = StateHash::mix(hash, executor_.reduce(vertex_count(), HashRows{from_.data()}));
    return StateHash::mix(hash, executor_.reduce(vertex_count(), HashRows{to_.data()}));
  }
  void list_state(std::uint32_t object, std::vector<StateSection> &list) {
    list.push_back({StateKind::collider_vertices, object, reinterpret_cast<std::byte *>(from_.data()), 4, 3, rows_.size()});
    list.push_back({StateKind::collider_targets, object, reinterpret_cast<std::byte *>(to_.data()), 4, 3, rows_.size()});
  }
  std::uint64_t bytes() const {
    return end_packets_.bytes() + from_.bytes() + to_.bytes() + vertices_of_triangles_.bytes() + vertices_of_ring_.bytes() +
           node_order_.bytes();
  }

private:
  template <class T> void copy_in(Array<T> &array, const std::vector<T> &values) {
    array.reserve(std::max<std::size_t>(values.size(), 1));
    executor_.upload(array.data(), values.data(), values.size());
  }
  int vertex_count() const { return static_cast<int>(rows_.size()); }
  VertexWays ways() { return {from_.data(), to_.data()}; }
  static float share(std::uint32_t index, std::uint32_t substeps) {
    return static_cast<float>(static_cast<double>(index) / substeps);
  }
  void place_triangles(Array<TrianglePacket> &packets, float at) {
    executor_.for_each(packet_count_, PlaceTriangles{ways(), vertices_of_triangles_.data(), at, packets.data()});
  }
  void finish_placing(const Surface &surface, Array<TrianglePacket> &end, float at) {
    executor_.for_each(ring_count_, PlaceRing{ways(), vertices_of_ring_.data(), at, surface.ring.data()});
    for (std::size_t level = 0; level + 1 < levels_.size(); ++level)
      executor_.for_each(
          static_cast<int>(levels_[level + 1] - levels_[level]),
          RefitNodes{surface.nodes.data(), surface.packets.data(), end.data(), node_order_.data() + levels_[level]});
  }

  Executor &executor_;
  Array<TrianglePacket> end_packets_;
  Array<Row> from_, to_; // at the start and the end of the step
  Array<std::uint32_t> vertices_of_triangles_, vertices_of_ring_, node_order_;
  std::vector<std::uint32_t> levels_; // of the nodes in their order
  int packet_count_, ring_count_;
  std::vector<Row> rows_; // of the host
  float way_ = 0, extent_ = 0;
  bool is_measured_ = false;
  bool is_placed_ = false; // the surface is where `from_` is
  int placed_end_ = -1;    // the substep that begins where end_packets_ are
};

} // namespace loam
