#include "timeline.h"

#include "device.h"

namespace loam {

Timeline::~Timeline() {
  for (cudaEvent_t event : events_) cudaEventDestroy(event);
}

void Timeline::record() {
  if (marks_ == events_.size()) {
    events_.reserve(marks_ + 1);
    cudaEvent_t event = nullptr;
    check_cuda(cudaEventCreate(&event), "cudaEventCreate");
    events_.push_back(event);
  }
  check_cuda(cudaEventRecord(events_[marks_], stream_), "cudaEventRecord");
  ++marks_;
}

void Timeline::begin() {
  marks_ = 0;
  stages_.clear();
  schedule_ = nullptr;
  record();
}

void Timeline::mark(Schedule &schedule, int stage, std::uint64_t items) {
  if (marks_ == 0) record();
  schedule_ = &schedule;
  schedule.record(stage, 0, items);
  stages_.push_back(stage);
  record();
  if (marks_ < most_marks) return;
  finish();
  begin();
}

void Timeline::finish() {
  if (marks_ == 0) return;
  check_cuda(cudaEventSynchronize(events_[marks_ - 1]), "cudaEventSynchronize");
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    float milliseconds = 0;
    check_cuda(cudaEventElapsedTime(&milliseconds, events_[i], events_[i + 1]), "cudaEventElapsedTime");
    schedule_->record(stages_[i], 1e-3 * static_cast<double>(milliseconds), 0);
  }
  marks_ = 0;
  stages_.clear();
}

} // namespace loam
