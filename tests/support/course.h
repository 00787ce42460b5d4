/* What a study changes of an experiment that a test runs too: the world's definition, and how its steps are taken, so that they can be timed. */
#pragma once

#include <functional>

#include "support/scenes.h"

namespace loam::test {

struct Course {
  std::function<void(loam_world_def &)> change = [](loam_world_def &) {};
  std::function<void(scenes::World &, float)> step = [](scenes::World &world, float seconds) { world.step(seconds); };
};

} // namespace loam::test
