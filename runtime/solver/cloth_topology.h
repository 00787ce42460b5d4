// How a cloth hangs together, and what becomes of that when it tears. On the host; the machine's arrays follow from it.
//
// A tear splits a vertex: some of the triangles around it get another, a copy in the same place. Nothing else changes hands. Constraints of a colour still share no vertex, for two
// that would have the new one shared the old one before. Hinges of edges whose triangles have parted bear nothing, and threads end where their links have.
#pragma once

#include <vector>

#include "kernels/cloth/strain.h"
#include "solver/cloth_backend.h"

namespace loam {

class ClothTopology {
public:
  explicit ClothTopology(const SolverCloth &whole);

  // The vertex at each corner of each triangle.
  const std::vector<int> &corners() const { return corners_; }
  const std::vector<Row> &shapes() const { return whole_.parts.shapes; }
  int vertex_count() const { return vertex_count_; }
  // How many there would be with these corners.
  int vertex_count(const std::vector<TornCorner> &torn) const;
  // As many as there can ever be.
  int most_vertices() const { return static_cast<int>(corners_.size()); }
  // The vertex of the mesh that this one is, or was split from.
  int origin(int vertex) const { return origins_[static_cast<std::size_t>(vertex)]; }

  // Splits vertices of triangles that are strained by more than `bound`: tears go on from their ends, all of them, and where there is none, the most strained triangle begins one.
  // Positions are those of the vertices now. The number of new vertices, which come behind the others; of each, `from` receives the one that it was.
  int tear(const std::vector<Row> &positions, const std::vector<TriangleStrain> &strains, float bound,
           std::vector<int> &from);

  // Corners that have another vertex than in the mesh, in their order: all that a tear is.
  std::vector<TornCorner> torn_corners() const;
  // Could they have come from torn_corners() of this cloth?
  bool accepts(const std::vector<TornCorner> &torn) const;
  // What it accepts.
  void set_torn_corners(const std::vector<TornCorner> &torn);

  // What the constraints are now: as those of the whole cloth, in the same places.
  ClothConstraintList membrane() const;
  ClothConstraintList hinges() const;
  ClothThreadList threads() const;
  std::vector<float> inverse_masses() const;
  // The triangles around vertex i are list[starts[i]] up to list[starts[i + 1]].
  void find_triangles_around(std::vector<int> &starts, std::vector<int> &list) const;

private:
  // The vertex now that a triangle has where the mesh had `origin`.
  int vertex_of(int triangle, int origin) const;
  bool is_whole(std::size_t hinge) const;
  std::vector<bool> find_ends() const;
  struct Splitter;

  SolverCloth whole_; // without positions, velocities
  std::vector<int> corners_, origins_;
  int whole_vertex_count_, vertex_count_;
};

} // namespace loam
