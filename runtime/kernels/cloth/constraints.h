// How the constraints of a cloth lie in memory: in batches of W, field by field, a lane each.
//
//   indices[batch][k][W]   the k-th vertex of each lane's constraint
//   fields[batch][f][W]
//
// A batch holds constraints of one colour: no two of a colour share a vertex, so their order cannot change the result. The lanes that are left over in a
// colour's last batch work on spare vertices without mass, one each, behind the cloth's own.
#pragma once

#include "math/vector.h"

namespace loam {

struct ClothConstraints {
  const int *indices;
  float *fields;
};

// What a triangle keeps: it holds the cloth together in its plane. See membrane.h.
struct MembraneField {
  enum : int {
    warp_of_first = 0, // w_u = warp_of_first e1 + warp_of_second e2, e1 and e2 the edges from vertex 0 to vertices 1 and 2
    warp_of_second,
    weft_of_first, // w_v, likewise
    weft_of_second,
    area,
    warp,          // 3: w_u at the start of the substep
    weft = 8,      // 3
    answered = 11, // 3: along warp, along weft, shear: the strains that their forces answer, see membrane.h
    count = 14
  };
  static constexpr int vertices = 3;
};

// What a hinge keeps: two triangles that share an edge. See bending.h.
struct HingeField {
  enum : int {
    weight = 0, // 3: of vertices 1 to 3, over the root of both triangles' area, 1/m; that of vertex 0 is minus their sum
    rest = 3,   // sum of weight times position, in the rest shape, along the normal; 0 in flat cloth
    offset = 4, // 3: how far the sum is from that at the start of the substep, less what its force answers
    count = 7
  };
  static constexpr int vertices = 4;
};

// The rows of a constraint's vertices. Written out: in a loop they would go through memory.
template <class Field, class Team>
LOAM_FN void load_vertices(Team &team, const ClothConstraints &constraints, typename Team::Item i, const Row *rows,
                           Vec4<typename Team::Real> *v) {
  v[0] = team.template row<Field>(constraints, i, 0, rows);
  v[1] = team.template row<Field>(constraints, i, 1, rows);
  v[2] = team.template row<Field>(constraints, i, 2, rows);
  if constexpr (Field::vertices == 4) v[3] = team.template row<Field>(constraints, i, 3, rows);
}
template <class Field, class Team>
LOAM_FN void store_vertices(Team &team, const ClothConstraints &constraints, typename Team::Item i, Row *rows,
                            const Vec4<typename Team::Real> *v) {
  team.template set_row<Field>(constraints, i, 0, rows, v[0]);
  team.template set_row<Field>(constraints, i, 1, rows, v[1]);
  team.template set_row<Field>(constraints, i, 2, rows, v[2]);
  if constexpr (Field::vertices == 4) team.template set_row<Field>(constraints, i, 3, rows, v[3]);
}

template <class Real> LOAM_FN void add_velocity(Vec4<Real> &v, Vec3<Real> change) {
  v.x = v.x + change.x;
  v.y = v.y + change.y;
  v.z = v.z + change.z;
}

} // namespace loam
