// What accuracy costs in a scene on this machine, and which setting to take.
#pragma once

#include "options.h"

namespace runner {

// Measures settings at moments of the scene, prints a table of their costs and errors and a recommendation. Returns the exit status of the program. Throws Error.
int tune(const Options &options);

} // namespace runner
