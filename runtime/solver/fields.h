// The fields of a solver. Where there are none, this holds no memory and runs no stage.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/integration/fields.h"
#include "kernels/integration/sleep.h"
#include "solver/backend.h"

namespace loam {

// The substep in which a blast comes that is `wait` seconds off at the step's beginning; -1: in none of this step.
inline int blast_substep(double wait, double substep, std::uint32_t substeps) {
  if (!(wait >= 0 && wait < substep * substeps)) return -1;
  return std::min(static_cast<int>(wait / substep), static_cast<int>(substeps) - 1);
}

template <class Executor> class Fields {
public:
  explicit Fields(Executor &executor) : executor_(executor), views_(executor.template array<FieldView>()) {}

  bool any() const { return !list_.empty(); }

  // Before a step. Throws Error OUT_OF_MEMORY.
  void prepare(const std::vector<FieldState> &fields, double substep, std::uint32_t substeps) {
    list_.clear();
    for (const FieldState &field : fields) {
      FieldView view = {field.kind, -1, field.centre, field.velocity, field.radius, 0, field.softening * field.softening};
      if (field.kind == FieldKind::wind) view.strength = static_cast<float>(-std::expm1(-field.strength * substep));
      if (field.kind == FieldKind::attractor) view.strength = static_cast<float>(field.strength * substep);
      if (field.kind == FieldKind::blast) {
        view.strength = static_cast<float>(field.strength);
        view.substep = blast_substep(field.wait, substep, substeps);
      }
      list_.push_back(view);
    }
    if (list_.empty()) {
      views_.free();
      return;
    }
    if (views_.capacity() < list_.size()) views_.reserve(list_.size());
    executor_.upload(views_.data(), list_.data(), list_.size());
  }

  // Changes velocities in a substep.
  void apply(int count, const Row *positions, Row *velocities, std::uint32_t substep, bool winds, float greatest_speed,
             int *limited) {
    executor_.for_each(count, ApplyFields{positions, velocities, views_.data(), static_cast<int>(list_.size()),
                                          static_cast<int>(substep), winds, greatest_speed, limited});
  }

  // Whom a blast of this substep reaches must be awake. Answers whether there is one.
  bool wake(int count, const Row *positions, float *rests, std::uint32_t substep) {
    bool any = false;
    for (const FieldView &field : list_)
      if (field.kind == FieldKind::blast && field.substep == static_cast<int>(substep)) {
        executor_.for_each(count, WakeWithin{positions, rests, field.centre, field.radius});
        any = true;
      }
    return any;
  }
  std::uint64_t bytes() const { return views_.bytes(); }

private:
  Executor &executor_;
  typename Executor::template Array<FieldView> views_;
  std::vector<FieldView> list_;
};

} // namespace loam
