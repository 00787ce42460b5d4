// What the command line asks for.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "scene.h"

namespace runner {

struct Options {
  std::filesystem::path scene, output;
  std::optional<std::uint64_t> frames;
  double scale = 1;
  std::uint32_t backend = LOAM_BACKEND_AUTO;
  std::uint32_t instruction_set = LOAM_INSTRUCTION_SET_AUTO;
  std::optional<std::uint32_t> solver;
  std::optional<loam_accuracy_def> accuracy;
  bool tune = false;
  std::uint32_t threads = 0; // 0: as many as the machine has
  bool pictures = true;
  std::uint64_t picture_every = 1;
  std::uint64_t ply_every = 1;       // 0: none
  std::optional<double> until_still; // seconds
};

} // namespace runner
