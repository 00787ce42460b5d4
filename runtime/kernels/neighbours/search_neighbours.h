// Neighbour search, in two passes over the candidates of the 27 cells around a particle: count, then (when the lists have their places)
// fill. Nothing is written before it is known that it fits.
//
// A team tests a packet of candidates at once, one per lane; what it found comes as a word of bits, one per lane.
//
// Close pairs, which position correction looks at, stand first in a list. In turn-by-turn solving each close pair has one owner: the lower
// index where the indices' sum is even, the higher one where it is odd, which spreads the work evenly.
#pragma once

#include "math/vector.h"

namespace loam {

struct CandidateTest {
  float support_squared;
  float close_squared; // 0: no position correction
  bool shared;         // close pairs stand in both lists

  struct Found {
    unsigned near, close;
  };
  template <class Team, class K> LOAM_FN Found operator()(Team &team, const K &packet) const {
    const auto squared = team.distance_squared(packet);
    // Without branches: what a packet finds is hard to predict.
    const unsigned near = team.bits_below(squared, support_squared) & team.other_bits(packet);
    const unsigned owned = shared ? ~0u : team.owned_bits(packet);
    return {near, near & owned & team.bits_below(squared, close_squared)};
  }
};

struct CountNeighbours {
  CandidateTest test;
  int *neighbour_counts;
  int *close_counts;

  template <class Team> LOAM_FN void operator()(Team &team, int i) const {
    int total = 0, close = 0;
    for (auto packet : team.candidates(i)) {
      const CandidateTest::Found found = test(team, packet);
      total += team.count(found.near);
      close += team.count(found.close);
    }
    team.store(neighbour_counts, i, total);
    team.store(close_counts, i, close);
  }
};

struct FillNeighbours {
  CandidateTest test;
  const int *neighbour_counts;
  const int *close_counts;

  template <class Team> LOAM_FN void operator()(Team &team, int i) const {
    auto list = team.open_list(i, neighbour_counts[i], close_counts[i]);
    for (auto packet : team.candidates(i)) {
      const CandidateTest::Found found = test(team, packet);
      team.append(list, packet, found.near, found.close);
    }
    team.close_list(list);
  }
};

} // namespace loam
