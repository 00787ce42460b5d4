#include "accuracy.h"

#include <array>
#include <charconv>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "error.h"

namespace runner {
namespace {

constexpr std::array<std::pair<std::string_view, std::uint32_t>, 4> presets = {
    {{"fast", LOAM_ACCURACY_PRESET_FAST},
     {"balanced", LOAM_ACCURACY_PRESET_BALANCED},
     {"accurate", LOAM_ACCURACY_PRESET_ACCURATE},
     {"reference", LOAM_ACCURACY_PRESET_REFERENCE}}};

template <class Number> bool read_whole(std::string_view text, Number &number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

void check(loam_status status) {
  if (status != LOAM_OK) throw Error(loam_last_error());
}

// A world of one particle tells what the library thinks of the numbers.
void check_by_library(const loam_accuracy_def &def) {
  loam_world_def world_def;
  check(loam_world_def_default(&world_def, sizeof world_def));
  world_def.backend = LOAM_BACKEND_CPU;
  world_def.thread_count = 1;
  world_def.particle_capacity = 1;
  loam_world *world = nullptr;
  check(loam_world_create(&world_def, &world));
  const loam_status status = loam_world_use_accuracy(world, &def);
  const std::string text = loam_last_error();
  loam_world_destroy(world);
  if (status != LOAM_OK) throw Error(text);
}

} // namespace

loam_accuracy_def parse_accuracy(const std::string &text) {
  loam_accuracy_def def;
  check(loam_accuracy_def_default(&def, sizeof def));
  const std::string_view all = text;
  const std::size_t equals = all.find('='), times = all.find('x');
  const std::string_view name = all.substr(0, equals);
  bool understood = false;
  for (const auto &[preset_name, preset] : presets)
    if (all == preset_name) {
      check(loam_accuracy_def_preset(preset, &def, sizeof def));
      return def;
    }
  if (equals != std::string_view::npos && name == "tolerance") {
    understood = read_whole(all.substr(equals + 1), def.tolerance);
    def.mode = LOAM_ACCURACY_TOLERANCE;
    def.substeps = 0;
    def.iterations = 200;
    def.courant = 1; // iterations converge slowly where waves go farther
  } else if (equals != std::string_view::npos && name == "budget") {
    float milliseconds = 0;
    understood = read_whole(all.substr(equals + 1), milliseconds);
    def.mode = LOAM_ACCURACY_BUDGET;
    def.substeps = 0;
    def.budget = 1e-3f * milliseconds;
  } else if (times != std::string_view::npos) {
    understood = read_whole(all.substr(0, times), def.substeps) && read_whole(all.substr(times + 1), def.iterations);
    if (understood && def.substeps == 0) throw Error("accuracy \"" + text + "\": substeps must be from 1 to 10000");
  }
  if (!understood)
    throw Error(fmt::format(
        "accuracy \"{}\" is none of fast, balanced, accurate, reference, tolerance=SHARE, budget=MILLISECONDS and "
        "SUBSTEPSxITERATIONS, such as 16x5",
        text));
  try {
    check_by_library(def);
  } catch (const Error &error) {
    throw Error(fmt::format("accuracy \"{}\": {}", text, error.what()));
  }
  return def;
}

std::string accuracy_text(const loam_accuracy_def &def) {
  for (const auto &[name, preset] : presets) {
    loam_accuracy_def known;
    check(loam_accuracy_def_preset(preset, &known, sizeof known));
    if (def.mode == known.mode && def.substeps == known.substeps && def.iterations == known.iterations &&
        def.most_substeps == known.most_substeps && def.courant == known.courant && def.tolerance == known.tolerance)
      return std::string(name);
  }
  switch (def.mode) {
  case LOAM_ACCURACY_TOLERANCE:
    return fmt::format("tolerance={:g}", def.tolerance);
  case LOAM_ACCURACY_BUDGET:
    return fmt::format("budget={:g}", 1e3f * def.budget);
  default:
    return def.substeps == 0 ? fmt::format("{} iterations", def.iterations)
                             : fmt::format("{}x{}", def.substeps, def.iterations);
  }
}

} // namespace runner
