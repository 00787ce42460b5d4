// The fields of a world. See include/loam/field.h.
#pragma once

#include <vector>

#include <loam/field.h>

#include "scene/slot_table.h"
#include "solver/backend.h"

namespace loam {

loam_field_def default_field();

class FieldScene {
public:
  // What a snapshot needs.
  struct Changes {
    Vec3<float> position;
    std::uint32_t spent; // a blast that is over
    double clock;        // seconds since it was made or set
  };
  struct Field {
    loam_field_def def{};
    Changes changes{};
  };

  FieldScene(std::uint16_t world_tag, float kernel_radius)
      : table_(IdKind::field, "field", world_tag, 1024), radius_(static_cast<double>(kernel_radius)) {}
  loam_field_id create(const loam_field_def &def);
  void set(loam_field_id id, const loam_field_def &def);
  void destroy(loam_field_id id) { table_.remove(id, "field"); }

  bool any() const; // that acts
  void list(std::vector<FieldState> &states) const;
  // After so many whole substeps of a step of `seconds`.
  void advance(double seconds, std::uint32_t substeps, std::uint32_t substeps_done);
  void shift_origin(const Vec3<float> &by);

  std::size_t slot_count() const { return table_.size(); }
  const Field *at_slot(std::size_t slot) const { return table_.at_index(slot); }
  Field *at_slot(std::size_t slot) { return table_.at_index(slot); }
  static void check(const Changes &changes); // throws Error INVALID_ARGUMENT

private:
  SlotTable<Field> table_;
  double radius_;
};

} // namespace loam
