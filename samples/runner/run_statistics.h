// What a run has cost and how it went, gathered frame by frame, for stats.json and series.csv.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <loam/loam.h>

#include "scene.h"

namespace runner {

// One row of series.csv.
struct FrameRecord {
  std::uint64_t frame = 0; // from 1
  double time = 0;         // seconds since the start
  std::uint64_t watched = 0;
  std::uint64_t outside = 0;
  loam_statistics statistics{};
};

struct RunStatistics {
  std::uint64_t particles = 0;
  std::uint32_t threads = 0;
  std::string backend, instruction_set;
  bool interrupted = false;
  bool has_sides = false;  // is there a collider that particles could be on the wrong side of?
  double step_seconds = 0; // wall time of all calls of loam_world_step
  std::vector<FrameRecord> frames;
  std::vector<loam_stage> stages; // summed over the frames
  std::vector<loam_memory> memory;
  std::string accuracy;          // in the words of accuracy.h
  std::uint64_t over_budget = 0; // frames that stability made longer than the budget
  std::uint64_t state_hash = 0;

  void add_stages(const std::vector<loam_stage> &frame);
};

std::string make_statistics_json(const Scene &scene, const RunStatistics &run);
std::string make_series_csv(const RunStatistics &run);

} // namespace runner
