// Walking a mesh's bounding volume hierarchy: the triangles near a point, and the distance to the nearest.
#pragma once

#include "kernels/contact/closest_point_on_triangle.h"
#include "kernels/contact/triangle_mesh.h"

namespace loam {

// What closest_point_on_triangle() says of each triangle of a packet.
struct PacketPoints {
  static constexpr int width = TrianglePacket::width;
  float x[width], y[width], z[width], distance_squared[width];
  int feature[width];

  LOAM_FN ClosestPoint<float> at(int lane) const {
    return {{x[lane], y[lane], z[lane]}, distance_squared[lane], feature[lane]};
  }
};

LOAM_FN Vec3<float> lane_of(const float (&rows)[3][TrianglePacket::width], int lane) {
  return {rows[0][lane], rows[1][lane], rows[2][lane]};
}

LOAM_FN PacketPoints closest_points(const TrianglePacket &packet, Vec3<float> point) {
  PacketPoints points;
  for (int k = 0; k < TrianglePacket::width; ++k) {
    const ClosestPoint<float> closest = closest_point_on_triangle(lane_of(packet.a, k) - point, lane_of(packet.b, k) - point,
                                                                  lane_of(packet.c, k) - point, lane_of(packet.normal, k));
    points.x[k] = closest.point.x;
    points.y[k] = closest.point.y;
    points.z[k] = closest.point.z;
    points.distance_squared[k] = closest.distance_squared;
    points.feature[k] = closest.feature;
  }
  return points;
}

// Visits the packets whose boxes lie within a distance that may shrink on the way, nearer boxes first. The tree has four children a
// node and stands for a binary radix tree over 30-bit codes with the index (under 2^28) as tie-break, at most 58 deep: two levels of
// that are one here, and a level leaves three entries at most.
struct BallQuery {
  static constexpr int width = BvhNode::width;
  const BvhNode *nodes;
  Vec3<float> centre;
  float open_squared;      // boxes within this distance are opened even where they are too far to be visited
  float unvisited_squared; // every triangle that was not visited is at least so far away
  int size;
  std::uint32_t entries[96];
  float distances[96];

  LOAM_FN BallQuery(const BvhNode *tree, Vec3<float> point, float open = 0.0f)
      : nodes(tree), centre(point), open_squared(open), unvisited_squared(1e30f), size(1) {
    entries[0] = 0;
    distances[0] = 0.0f;
  }

  // The index of the next packet, or -1 when there is none left.
  LOAM_FN int next(float radius_squared) {
    while (size > 0) {
      --size;
      const std::uint32_t entry = entries[size];
      const float distance = distances[size];
      const bool is_leaf = (entry & BvhNode::leaf) != 0;
      // Beyond the nearest box that was left out there is nothing more to be learned.
      const float limit = is_leaf ? radius_squared : maximum(radius_squared, minimum(open_squared, unvisited_squared));
      if (!(distance <= limit))
        unvisited_squared = minimum(unvisited_squared, distance);
      else if (is_leaf)
        return static_cast<int>(entry & ~BvhNode::leaf);
      else
        open(nodes[entry], limit);
    }
    return -1;
  }

private:
  // How far an offset is beyond a half extent; 0 if it is not.
  LOAM_FN static float beyond(float offset, float half) {
    const float excess = absolute(offset) - half;
    return 0.5f * (excess + absolute(excess));
  }

  LOAM_FN void open(const BvhNode &node, float limit) {
    float squared[width];
    for (int k = 0; k < width; ++k) {
      const float x = beyond(centre.x - node.centre[0][k], node.half[0][k]);
      const float y = beyond(centre.y - node.centre[1][k], node.half[1][k]);
      const float z = beyond(centre.z - node.centre[2][k], node.half[2][k]);
      squared[k] = x * x + (y * y + z * z);
    }
    const int bottom = size;
    for (int k = 0; k < width; ++k) {
      if (!(squared[k] <= limit)) {
        unvisited_squared = minimum(unvisited_squared, squared[k]);
        continue;
      }
      int at = size++;
      for (; at > bottom && distances[at - 1] < squared[k]; --at) {
        entries[at] = entries[at - 1];
        distances[at] = distances[at - 1];
      }
      entries[at] = node.child[k];
      distances[at] = squared[k];
    }
  }
};

// The distance from a point in the mesh's frame to the mesh, or `limit` if that is less.
LOAM_FN float distance_to_mesh(const BvhNode *nodes, const TrianglePacket *packets, Vec3<float> point, float limit) {
  float best = limit * limit;
  BallQuery query(nodes, point);
  for (int i = query.next(best); i >= 0; i = query.next(best)) {
    const PacketPoints points = closest_points(packets[i], point);
    for (int k = 0; k < TrianglePacket::width; ++k) best = minimum(best, points.distance_squared[k]);
  }
  return minimum(limit, square_root(best));
}

} // namespace loam
