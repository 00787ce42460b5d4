// What the runner stops with: one text that the user can act on.
#pragma once

#include <stdexcept>
#include <string>

namespace runner {

// The text names the file, and the line or the key where there is one.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

} // namespace runner
