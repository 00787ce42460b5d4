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
    first_edge,      // 3: e1 at the start of the substep, m
    second_edge = 8, // 3
    force = 11,      // 3: along warp, along weft, shear; N m
    count = 14
  };
  static constexpr int vertices = 3;
};

// What a hinge keeps: two triangles that share an edge. See bending.h.
struct HingeField {
  enum : int {
    weight = 0,       // 3: of vertices 1 to 3; that of vertex 0 is minus their sum
    inverse_area = 3, // 1 / (area of both triangles), 1/m^2
    rest = 4,         // sum of weight times position, in the rest shape, along the normal; 0 in flat cloth
    offset = 5,       // 3: how far the sum is from that at the start of the substep, m
    force = 8,        // 3: N
    count = 11
  };
  static constexpr int vertices = 4;
};

} // namespace loam
