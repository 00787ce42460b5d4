// The CPU team for a cloth's constraints: an item is a batch, a lane a constraint.
#pragma once

#include "kernels/cloth/constraints.h"
#if defined(LOAM_PORTABLE_KERNELS)
#include "math/pack_portable.h"
#else
#include "math/pack.h"
#endif

namespace loam::LOAM_INSTRUCTION_SET {

struct TeamOverConstraints {
  using Real = Pack;
  using Item = int; // a batch
  static constexpr int W = Pack::width;

  // Of threads: how many places an item has, and the batch of its j-th.
  LOAM_FN static int place_count(const int *starts, int b) { return starts[b + 1] - starts[b]; }
  LOAM_FN static int place(const int *starts, int b, int j) { return starts[b] + j; }

  template <class Field> LOAM_FN static const int *indices(const ClothConstraints &c, int b, int k) {
    return c.indices + (static_cast<long>(b) * Field::vertices + k) * W;
  }
  template <class Field> LOAM_FN static float *values(const ClothConstraints &c, int b, int f) {
    return c.fields + (static_cast<long>(b) * Field::count + f) * W;
  }
  template <class Field> LOAM_FN Vec4<Pack> row(const ClothConstraints &c, int b, int k, const Row *rows) const {
    return load_rows(rows, indices<Field>(c, b, k));
  }
  template <class Field>
  LOAM_FN void set_row(const ClothConstraints &c, int b, int k, Row *rows, const Vec4<Pack> &value) const {
    store_rows(rows, indices<Field>(c, b, k), value);
  }
  template <class Field> LOAM_FN Pack field(const ClothConstraints &c, int b, int f) const {
    return Pack::load(values<Field>(c, b, f));
  }
  template <class Field> LOAM_FN void set_field(const ClothConstraints &c, int b, int f, Pack value) const {
    value.store(values<Field>(c, b, f));
  }
  template <class Field> LOAM_FN Vec3<Pack> vector(const ClothConstraints &c, int b, int f) const {
    return {field<Field>(c, b, f), field<Field>(c, b, f + 1), field<Field>(c, b, f + 2)};
  }
  template <class Field> LOAM_FN void set_vector(const ClothConstraints &c, int b, int f, const Vec3<Pack> &v) const {
    set_field<Field>(c, b, f, v.x);
    set_field<Field>(c, b, f + 1, v.y);
    set_field<Field>(c, b, f + 2, v.z);
  }
};

} // namespace loam::LOAM_INSTRUCTION_SET
