// What the scene says to the solver about cloth. Part of the interface in backend.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <loam/cloth.h>

#include "math/vector.h"
#include "solver/state_section.h"

namespace loam {

// A vertex, an edge or a triangle as an index.
inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Constraints of one kind, colour by colour.
struct ClothConstraintList {
  std::vector<int> indices;  // vertices, so many a constraint as the kind has
  std::vector<float> fields; // its first fields, see kernels/cloth/constraints.h
  std::vector<int> starts;   // of each colour, in constraints; one more entry than colours
};

// Threads, colour by colour, and in each from long to short.
struct ClothThreadList {
  static constexpr float no_link = 1e30f;
  std::vector<int> vertices;                        // of all threads
  std::vector<float> greatest_lengths, compliances; // at each vertex: of the link to the thread's next; no_link at its last
  std::vector<int> link_triangles;                  // likewise: one of the link's; -1 where there is none
  std::vector<int> starts;                          // of each thread in `vertices`; one more entry than threads
  std::vector<int> colours;                         // of each colour, in threads; one more entry than colours
};

struct ClothMaterial {
  float stretch, shear; // N/m
  float bending;        // N m
  float damping;        // s
  float areal_density;  // kg/m^2
  float thickness;      // m: the distance that is kept from colliders
  float friction;       // against particles
  float self_distance;  // m: between its vertices and those of other cloth that has one; 0: none is kept
  float self_friction;
  float tear_strain; // 0: never
};

struct ClothWind {
  Vec3<float> velocity; // m/s
  float drag, lift;     // coefficients
};

struct SolverCloth {
  std::vector<Row> positions, velocities; // as for particles; positions.w is 0
  std::vector<Row> rest;                  // in the mesh's frame
  std::vector<int> triangles;             // three vertices each
  ClothConstraintList membrane, hinges;
  ClothThreadList threads;
  ClothMaterial material;
  // Of cloth that tears: which triangles make up what.
  struct Parts {
    std::vector<int> membrane_triangles; // one a membrane constraint
    std::vector<int> hinge_triangles;    // two a hinge: that with its vertex 2, and that with its vertex 3
    std::vector<int> link_triangles;     // at each vertex of a thread: of the link to the next
    std::vector<float> areas;            // of the triangles
    std::vector<Row> shapes;             // of the triangles: the first four fields of their constraints
  } parts;
};

// A corner of a triangle, counted three a triangle, that has another vertex than in the mesh.
struct TornCorner {
  int corner, vertex;
};

struct SolverAttachment {
  int vertex;
  int collider;      // index in StepInput::colliders; -1: space
  Vec3<float> point; // in the collider's frame, or in space
  float stiffness;   // N/m; 0: rigid
};

class ClothBackend {
public:
  virtual ~ClothBackend() = default;
  virtual int add(const SolverCloth &cloth) = 0;
  virtual void remove(int cloth) = 0;
  // All attachments of a cloth, in place of those before.
  virtual void set_attachments(int cloth, const std::vector<SolverAttachment> &attachments) = 0;
  virtual void set_wind(int cloth, const ClothWind &wind) = 0;
  // More than the mesh has if it is torn.
  virtual std::uint32_t vertex_count(int cloth) const = 0;
  virtual std::vector<Row> positions(int cloth) = 0;
  // How it is torn, and whether it could be torn so; in a cloth that cannot tear, no corner is torn.
  virtual std::vector<TornCorner> torn_corners(int cloth) const = 0;
  virtual bool could_be_torn(int cloth, const std::vector<TornCorner> &torn) const = 0;
  virtual void set_torn_corners(int cloth, const std::vector<TornCorner> &torn) = 0;
  // Puts the cloth's state, were it torn so, into a list, as that of `object`. Inverse masses are not in it: they follow from the attachments.
  virtual void list_state(int cloth, const std::vector<TornCorner> &torn, std::uint32_t object,
                          std::vector<StateSection> &list) = 0;
  virtual void map(int cloth, loam_cloth_view &view) = 0;
};

} // namespace loam
