// A solid given by its signed distance at the points of a grid, trilinear in between. Beyond the grid there is nothing: the solid ends there.
//
// A point outside of the grid projects onto it at c, a distance D away. Whatever the grid holds lies behind c as seen from the point, at an angle of
// 90 degrees or more, and no nearer to c than the value f there; so it is sqrt(D^2 + f^2) away, at least.
#pragma once

#include "kernels/contact/surface.h"

namespace loam {

struct GridShape {
  const float *values; // x fastest, then y, then z
  int size[3];
  Vec3<float> origin; // of the first value
  float spacing;
  float certainty; // 1 over the greatest slope between values, at most 1: what share of a value is free for certain

  LOAM_FN Surface surface(Vec3<float> point) const {
    const Place x = place(point.x - origin.x, size[0]), y = place(point.y - origin.y, size[1]),
                z = place(point.z - origin.z, size[2]);
    const long row = size[0], layer = row * size[1];
    const float *v = values + x.cell + y.cell * row + z.cell * layer;
    const float c[8] = {v[0], v[1], v[row], v[row + 1], v[layer], v[layer + 1], v[layer + row], v[layer + row + 1]};
    const float along_x[4] = {c[1] - c[0], c[3] - c[2], c[5] - c[4], c[7] - c[6]};
    float edge[4];
    for (int k = 0; k < 4; ++k) edge[k] = c[2 * k] + x.share * along_x[k];
    const float face[2] = {edge[0] + y.share * (edge[1] - edge[0]), edge[2] + y.share * (edge[3] - edge[2])};
    const float value = face[0] + z.share * (face[1] - face[0]);

    const float low = along_x[0] + y.share * (along_x[1] - along_x[0]),
                high = along_x[2] + y.share * (along_x[3] - along_x[2]);
    const Vec3<float> slope = {low + z.share * (high - low),
                               (edge[1] - edge[0]) + z.share * ((edge[3] - edge[2]) - (edge[1] - edge[0])),
                               face[1] - face[0]};

    const Vec3<float> out = {x.out, y.out, z.out};
    const float beyond = length(out);
    if (beyond > 0.0f) {
      const float within = maximum(value, 0.0f), distance = square_root(beyond * beyond + within * within);
      const Vec3<float> away = out + (within / spacing) * slope;
      return {distance, direction_of(away, length(away))};
    }
    const float to_side = maximum(x.to_side, maximum(y.to_side, z.to_side));
    if (to_side > value) { // the solid's cut at the end of the grid is the nearest
      const Vec3<float> side = x.to_side == to_side   ? Vec3<float>{x.side, 0.0f, 0.0f}
                               : y.to_side == to_side ? Vec3<float>{0.0f, y.side, 0.0f}
                                                      : Vec3<float>{0.0f, 0.0f, z.side};
      return {to_side, side};
    }
    return {value, direction_of(slope, length(slope))};
  }

private:
  // Where a coordinate is along one axis.
  struct Place {
    int cell;
    float share;   // within the cell, 0 to 1
    float out;     // beyond the grid, with its sign; 0 within
    float to_side; // signed distance to the nearer end of the grid: under 0 within
    float side;    // which: -1 or 1
  };
  LOAM_FN Place place(float from_origin, int count) const {
    const float extent = spacing * static_cast<float>(count - 1);
    const float within =
        from_origin > 0.0f ? (from_origin < extent ? from_origin : extent) : 0.0f; // what is no number counts as 0
    const float at = within / spacing;
    Place p;
    const int last = count - 2, cell = static_cast<int>(at);
    p.cell = cell < last ? cell : last;
    p.share = minimum(1.0f, at - static_cast<float>(p.cell));
    p.out = from_origin - within;
    const bool lower = from_origin < 0.5f * extent;
    p.side = lower ? -1.0f : 1.0f;
    p.to_side = lower ? 0.0f - from_origin : from_origin - extent;
    return p;
  }
};

} // namespace loam
