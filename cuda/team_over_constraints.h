// The team for a cloth's constraints on machines that give each its own thread: an item is a constraint, so is a lane.
#pragma once

#include "kernels/cloth/constraints.h"

namespace loam {

struct TeamOverConstraints {
  using Real = float;
  using Item = int;
  static constexpr int W = 32; // of a batch

  LOAM_FN static int place_count(const int *starts, int i) { return starts[i / W + 1] - starts[i / W]; }
  LOAM_FN static int place(const int *starts, int i, int j) { return (starts[i / W] + j) * W + i % W; }

  template <class Field> LOAM_FN static int index(const ClothConstraints &c, int i, int k) {
    return c.indices[(static_cast<long>(i / W) * Field::vertices + k) * W + i % W];
  }
  template <class Field> LOAM_FN static float &value(const ClothConstraints &c, int i, int f) {
    return c.fields[(static_cast<long>(i / W) * Field::count + f) * W + i % W];
  }
  template <class Field> LOAM_FN Vec4<float> row(const ClothConstraints &c, int i, int k, const Row *rows) const {
    const Row r = rows[index<Field>(c, i, k)];
    return {r.x, r.y, r.z, r.w};
  }
  template <class Field>
  LOAM_FN void set_row(const ClothConstraints &c, int i, int k, Row *rows, const Vec4<float> &v) const {
    rows[index<Field>(c, i, k)] = {v.x, v.y, v.z, v.w};
  }
  template <class Field> LOAM_FN float field(const ClothConstraints &c, int i, int f) const { return value<Field>(c, i, f); }
  template <class Field> LOAM_FN void set_field(const ClothConstraints &c, int i, int f, float number) const {
    value<Field>(c, i, f) = number;
  }
  template <class Field> LOAM_FN Vec3<float> vector(const ClothConstraints &c, int i, int f) const {
    return {field<Field>(c, i, f), field<Field>(c, i, f + 1), field<Field>(c, i, f + 2)};
  }
  template <class Field> LOAM_FN void set_vector(const ClothConstraints &c, int i, int f, const Vec3<float> &v) const {
    set_field<Field>(c, i, f, v.x);
    set_field<Field>(c, i, f + 1, v.y);
    set_field<Field>(c, i, f + 2, v.z);
  }
};

// A stage over constraints as one over items.
template <class Stage> struct OverConstraints {
  Stage stage;
  int first;
  LOAM_FN void operator()(int i) const {
    TeamOverConstraints team;
    stage(team, first + i);
  }
};

} // namespace loam
