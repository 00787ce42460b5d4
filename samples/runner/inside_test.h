// Is a point inside a closed mesh? Answered in double precision by the generalised winding number, which knows nothing of the library's
// contact code and so can judge it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "mesh.h"
#include "vector.h"

namespace runner {

// True if every edge belongs to exactly two triangles that run through it in opposite directions.
bool is_closed(const Mesh &mesh);

// The sum of the signed solid angles of all triangles over 4 pi (van Oosterom and Strackee 1983): 1 inside, 0 outside.
double winding_number_of_all_triangles(const Mesh &mesh, Vector3d point);

// The same number, faster: a tree over the triangles. Seen from outside a node's box, its triangles subtend the same solid angle as
// any other surface within the box that has the same boundary; so each node keeps a fan over its boundary edges, which are few
// (Jacobson, Kavan, Sorkine-Hornung 2013). This is exact, not an approximation. Further, the number is the same everywhere in a grid cell
// that no triangle enters, so it is computed once for such a cell.
class InsideTest {
public:
  // The mesh, which must be closed, is moved by rotation (unit quaternion x, y, z, w), then position.
  InsideTest(const Mesh &mesh, Vector3 position, const std::array<float, 4> &rotation);

  double winding_number(Vector3d point) const;
  // Any number of threads may ask at once.
  bool inside(Vector3d point) const;

private:
  using Triangle = std::array<std::uint32_t, 3>;
  struct Node {
    Vector3d low, high;
    std::uint32_t first = 0, count = 0;         // its triangles
    std::uint32_t fan_first = 0, fan_count = 0; // triangles of the fan over its boundary
    std::uint32_t right = 0;                    // the right child; the left one follows the node; 0: a leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t count);
  void add_fan(Node &node);
  double solid_angles(const std::vector<Triangle> &triangles, std::uint32_t first, std::uint32_t count,
                      Vector3d point) const;
  void mark_crossed_cells();
  // The cell of a point, or -1 outside the grid.
  std::int64_t cell_of(Vector3d point) const;

  std::vector<Vector3d> vertices_;
  std::vector<Triangle> triangles_; // in the tree's order
  std::vector<Triangle> fans_;
  std::vector<Node> nodes_;

  enum Cell : std::uint8_t { unknown, crossed, all_inside, all_outside };
  std::array<int, 3> cells_{};
  double cell_size_ = 0;
  // Threads may compute the same cell twice; they store the same value.
  mutable std::vector<std::atomic<std::uint8_t>> cell_states_;
};

} // namespace runner
