// One run from the scene file to the last file written.
#pragma once

#include "options.h"

namespace runner {

// Returns the exit status of the program: 0, or 130 if an interrupt ended the run early (its results so far are written all the same).
// Throws Error.
int run(const Options &options);

// The scene with what the command line changes. Throws Error.
Scene prepare_scene(const Options &options);

} // namespace runner
