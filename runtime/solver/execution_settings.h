// What an executor is made with.
#pragma once

#include <cstdint>

#include <loam/base.h>
#include <loam/particles.h>

namespace loam {

struct ExecutionSettings {
  loam_allocator allocator;
  loam_job_system job_system;
  unsigned thread_count;    // 0: all of the machine
  unsigned instruction_set; // a LOAM_INSTRUCTION_SET_* that this machine has
};

} // namespace loam
