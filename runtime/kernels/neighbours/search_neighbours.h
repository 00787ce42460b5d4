// Neighbour search among the candidates of the 27 cells around a particle. Where lists are written to their places at once it takes two passes: count, then
// (when the lists have their places) fill. Where a cache holds the lists of a while it takes one: FindNeighbours.
//
// A team tests a packet of candidates at once, one per lane; what it found comes as a set of lanes.
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

  template <class Lanes> struct Found { Lanes near, close; };
  // Without branches: what a packet finds is hard to predict.
  template <class Team, class K> LOAM_FN auto operator()(Team &team, const K &packet) const {
    const auto squared = team.distance_squared(packet);
    const auto near = team.others_below(packet, squared, support_squared);
    const auto close = team.below(squared, close_squared, near);
    return Found<decltype(team.below(squared, close_squared, near))>{near, shared ? close : team.owned(packet, close)};
  }
};

struct CountNeighbours {
  CandidateTest test;
  int *neighbour_counts;
  int *close_counts;
  const std::uint32_t *keys;
  const std::uint8_t *active_cells; // null: all

  template <class Team> LOAM_FN void operator()(Team &team, int i) const {
    int total = 0, close = 0;
    if (active_cells != nullptr && active_cells[keys[i]] == 0) { // not visited
      team.store(neighbour_counts, i, 0);
      team.store(close_counts, i, 0);
      return;
    }
    for (auto packet : team.candidates(i)) {
      const auto found = test(team, packet);
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
      const auto found = test(team, packet);
      team.append(list, packet, found.near, found.close);
    }
  }
};

// Both at once. A list is put behind those before it; where there is no more room it is only counted.
struct FindNeighbours {
  CandidateTest test;
  int *neighbour_counts;
  int *close_counts;

  template <class Team> LOAM_FN void operator()(Team &team, int i) const {
    auto list = team.begin_list();
    for (auto packet : team.candidates(i)) {
      const auto found = test(team, packet);
      team.append(list, packet, found.near, found.close);
    }
    neighbour_counts[i] = list.close + list.far;
    close_counts[i] = list.close;
    if (!team.end_list(list)) { // unusually long: walk again, once for each part
      for (auto packet : team.candidates(i)) team.append_close(list, packet, test(team, packet).close);
      for (auto packet : team.candidates(i)) {
        const auto found = test(team, packet);
        team.append_far(list, packet, found.near, found.close);
      }
    }
  }
};

} // namespace loam
