// How many threads work on one particle, stage by stage.
#pragma once

#include <type_traits>

#include "solver/stages.h"

namespace loam {

// A stage whose visit takes its neighbours one after the other (each pair sees what the pair before it changed, or counts the pairs) has
// no lanes to share them out to: one thread does it.
template <class Stage> struct SequentialOverNeighbours : std::is_base_of<CorrectPositions, Stage> {};

// A stage whose visits are ordered: blocks of one colour at once, the particles of a block in turn. All others visit every particle at once.
template <class Stage> struct InTurn : std::is_same<Stage, CorrectPositionsInTurn> {};
template <class Law, class Multiplier> struct InTurn<SolveInelastic<Law, Multiplier>> : std::true_type {};
template <class Law, class Multiplier> struct InTurn<StartInelastic<Law, Multiplier>> : std::true_type {};
template <FluidMotion Motion> struct InTurn<SolveFluid<Motion>> : std::true_type {};
template <FluidMotion Motion> struct InTurn<StartFluid<Motion>> : std::true_type {};

// 16 lanes for the usual 26 to 28 neighbours: two rounds that are mostly full, and the part of a visit that every lane repeats (the law) is
// shared by two particles to a warp.
constexpr int search_tile_width = 16;
template <class Stage> constexpr int tile_width = SequentialOverNeighbours<Stage>::value ? 1 : 16;

} // namespace loam
