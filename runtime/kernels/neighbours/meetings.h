// How particles of two materials meet. Most share gradients: they are one continuum where they touch, mix and stick together. Two materials whose bodies should
// separate take gradients from their own kind only, and meet by contact: a least distance of r, with Coulomb friction (kernels/integration/position_correction.h).
#pragma once

#include <cstdint>

#include "math/qualifiers.h"

namespace loam {

struct Meetings {
  const std::uint32_t *materials; // of each particle
  const float *
      row; // for the item's material, by the other's: the friction of contact, negative where gradients are shared. Null: shared with all

  LOAM_FN bool any() const { return row != nullptr; }
  template <class Team, class Neighbour> LOAM_FN auto friction(Team &team, const Neighbour &k) const {
    return team.neighbour_lookup(k, materials, row);
  }
  // 1 where gradients are shared, 0 in contact.
  template <class Team, class Neighbour> LOAM_FN auto shared(Team &team, const Neighbour &k) const {
    using Lane = typename Team::Lane;
    return select(friction(team, k) < Lane(0.0f), Lane(1.0f), Lane(0.0f));
  }
};

} // namespace loam
