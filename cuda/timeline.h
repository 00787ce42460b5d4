// What each stage took on the device, by events in the stream between them: nothing waits until the times are asked for.
#pragma once

#include <cstdint>
#include <vector>

#include <cuda_runtime_api.h>

#include "schedule/schedule.h"

namespace loam {

class Timeline {
public:
  explicit Timeline(cudaStream_t stream) : stream_(stream) {}
  ~Timeline();
  Timeline(const Timeline &) = delete;
  Timeline &operator=(const Timeline &) = delete;

  // Forgets what was not told yet, and begins anew.
  void begin();
  // The work since the last mark belongs to `stage`.
  void mark(Schedule &schedule, int stage, std::uint64_t items);
  // Tells the schedule the times of all marks. Waits for the last of them.
  void finish();

private:
  static constexpr std::size_t most_marks = 1024; // then they are told, to keep the events few
  void record();

  cudaStream_t stream_;
  std::vector<cudaEvent_t> events_; // made so far
  std::vector<int> stages_;         // of the mark after each event but the last
  std::size_t marks_ = 0;           // events in use
  Schedule *schedule_ = nullptr;
};

} // namespace loam
