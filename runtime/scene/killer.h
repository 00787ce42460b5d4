// The killers of a world. See include/loam/killer.h.
#pragma once

#include <vector>

#include <loam/killer.h>

#include "scene/slot_table.h"
#include "solver/backend.h"

namespace loam {

loam_killer_def default_killer();

class KillerScene {
public:
  struct Killer {
    loam_killer_def def{};
    KillerView view{};
    std::uint64_t total = 0;           // killed so far
    std::vector<std::uint32_t> killed; // in the last step
  };

  explicit KillerScene(std::uint16_t world_tag) : table_(IdKind::killer, "killer", world_tag, 1024) {}
  // `material`: the slot of the definition's; -1: any. Throws Error.
  loam_killer_id create(const loam_killer_def &def, int material);
  void set(loam_killer_id id, const loam_killer_def &def, int material);
  void destroy(loam_killer_id id) { table_.remove(id, "killer"); }
  const Killer &at(loam_killer_id id) const { return table_.at(id, "killer"); }
  static void check(const loam_killer_def &def);

  bool any() const;
  bool any_of_age(const Killer *but = nullptr) const;
  bool any_of_material(int material) const;
  void begin_step(std::vector<KillerState> &states); // forgets whom the last one killed
  void end_step();                                   // counts
  void shift_origin(const Vec3<float> &by);
  std::size_t slot_count() const { return table_.size(); }
  const Killer *at_slot(std::size_t slot) const { return table_.at_index(slot); }
  Killer *at_slot(std::size_t slot) { return table_.at_index(slot); }

private:
  template <class F> bool any_that(F &&f) const {
    for (std::size_t i = 0; i < table_.size(); ++i)
      if (const Killer *killer = table_.at_index(i); killer != nullptr && f(*killer)) return true;
    return false;
  }
  SlotTable<Killer> table_;
};

} // namespace loam
