// How much a cloth's triangles are stretched, for tearing.
//
// Two answers: the strain that the vertices' positions show, and the strain that goes with the forces that the triangle's constraints gave in the last substep. Where the
// solver has converged they are the same. Where iterations are too few for a cloth's size, or damping makes it slow to answer, its positions show far more than the load
// would stretch it, while forces balance the load all the same; in a sudden jerk forces go beyond what the positions show. The lesser of the two counts;
// but a fifth of what shows at least, for where iterations are far too few, forces show nothing.
#pragma once

#include "kernels/cloth/constraints.h"

namespace loam {

// The greatest stretch of a triangle in any direction, less 1, and that direction in space, as long as the stretch.
struct TriangleStrain {
  float strain;
  Vec3<float> direction;
};

// The greatest eigenvalue of the matrix of the products of w_u and w_v, the images of the unit vectors along warp and weft (see membrane.h), is the greatest
// squared stretch.
struct SquaredStretch {
  float uu, vv, uv;
  LOAM_FN float half() const { return 0.5f * (uu - vv); }
  LOAM_FN float root() const { return square_root(half() * half() + uv * uv); }
  LOAM_FN float strain() const { return square_root(maximum(0.0f, 0.5f * (uu + vv) + root())) - 1.0f; }
};

// Three fields of a membrane's constraint, which stand `width` apart; `place` is batch times width plus lane.
LOAM_FN Vec3<float> membrane_vector(const float *fields, int width, int place, int field) {
  const float *own = fields + (static_cast<long>(place / width) * MembraneField::count + field) * width + place % width;
  return {own[0], own[width], own[2 * static_cast<long>(width)]};
}

struct TriangleStrains {
  const Row *positions;
  const int *triangles;
  const Row *shapes;   // the four numbers of MembraneField that turn edges into w_u and w_v
  const int *places;   // of the triangles' constraints: batch times width plus lane
  const float *fields; // of the constraints
  int width;
  float damping; // tau / h of the last substep

  LOAM_FN TriangleStrain of(int i) const {
    const int *t = triangles + 3 * static_cast<long>(i);
    const Row shape = shapes[i];
    const Vec3<float> x = xyz(positions[t[0]]), e1 = xyz(positions[t[1]]) - x, e2 = xyz(positions[t[2]]) - x;
    const Vec3<float> u = shape.x * e1 + shape.y * e2, v = shape.z * e1 + shape.w * e2;
    const SquaredStretch shown = {dot(u, u), dot(v, v), dot(u, v)};
    const float along = shown.uu >= shown.vv ? shown.half() + shown.root() : shown.uv;
    const float across = shown.uu >= shown.vv ? shown.uv : shown.root() - shown.half();
    const float size = square_root(along * along + across * across);
    const Vec3<float> direction = size > 0.0f ? (1.0f / size) * (along * u + across * v) : u;
    const float strain = shown.strain();
    return {maximum(minimum(strain, borne(i).strain()), 0.2f * strain), direction};
  }

private:
  // From what membrane.h keeps of the multipliers.
  LOAM_FN SquaredStretch borne(int i) const {
    const Vec3<float> warp = membrane_vector(fields, width, places[i], MembraneField::warp);
    const Vec3<float> weft = membrane_vector(fields, width, places[i], MembraneField::weft);
    const Vec3<float> answered = membrane_vector(fields, width, places[i], MembraneField::answered);
    const float u = 1.0f + (answered.x - damping * (length(warp) - 1.0f));
    const float v = 1.0f + (answered.y - damping * (length(weft) - 1.0f));
    return {u * u, v * v, answered.z - damping * dot(warp, weft)};
  }
};

// What the constraints' triangles show, at the start of the substep; places without a triangle show nothing.
struct GreatestStretch {
  using Value = float;
  const float *fields;
  int width;
  LOAM_FN static Value identity() { return 0.0f; }
  LOAM_FN Value operator()(int place) const {
    const Vec3<float> warp = membrane_vector(fields, width, place, MembraneField::warp);
    const Vec3<float> weft = membrane_vector(fields, width, place, MembraneField::weft);
    const float strain = SquaredStretch{dot(warp, warp), dot(weft, weft), dot(warp, weft)}.strain();
    return is_finite(strain) ? strain : 0.0f;
  }
  LOAM_FN static Value combine(Value a, Value b) { return maximum(a, b); }
};

struct GreatestStrain {
  using Value = float;
  TriangleStrains strains;
  LOAM_FN static Value identity() { return -1.0f; }
  LOAM_FN Value operator()(int i) const {
    const float strain = strains.of(i).strain;
    return is_finite(strain) ? strain : -1.0f;
  }
  LOAM_FN static Value combine(Value a, Value b) { return maximum(a, b); }
};

} // namespace loam
