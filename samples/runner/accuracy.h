// Settings of accuracy as people write them.
#pragma once

#include <string>

#include <loam/loam.h>

namespace runner {

// fast, balanced, accurate or reference; tolerance=SHARE; budget=MILLISECONDS of a frame; SUBSTEPSxITERATIONS.
// Throws Error that says what is wrong with the text.
loam_accuracy_def parse_accuracy(const std::string &text);

// The other way round, in the form in which it can be given again where there is one.
std::string accuracy_text(const loam_accuracy_def &def);

} // namespace runner
