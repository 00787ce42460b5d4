// How particles of two materials meet. Most share gradients: they are one continuum where they touch, mix and stick together. Two materials whose bodies should
// separate take gradients from their own kind only, and meet by contact: a least distance of r, with Coulomb friction (kernels/integration/position_correction.h).
// A fluid stays out of the gradients of others, and no distance is kept from it: its density does that.
#pragma once

#include <cstdint>

#include "math/qualifiers.h"

namespace loam {

struct Meetings {
  const std::uint32_t *materials; // of each particle
  const float
      *row; // for the item's material, by the other's: the friction of contact; else one of the below. Null: shared with all

  static constexpr float gradients_shared = -1.0f, left_to_density = -2.0f;

  LOAM_FN bool any() const { return row != nullptr; }
  template <class Team, class Neighbour> LOAM_FN auto friction(Team &team, const Neighbour &k) const {
    return team.neighbour_lookup(k, materials, row);
  }
  // 1 where gradients are shared, 0 in contact.
  template <class Team, class Neighbour> LOAM_FN auto shared(Team &team, const Neighbour &k) const {
    using Lane = typename Team::Lane;
    const Lane f = friction(team, k);
    return select(f < Lane(0.0f), select(f < Lane(-1.5f), Lane(0.0f), Lane(1.0f)), Lane(0.0f));
  }
};

} // namespace loam
