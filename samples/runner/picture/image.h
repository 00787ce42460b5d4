// A picture: eight bits each of red, green and blue, rows from the top.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace runner {

struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

// The bytes of a PNG file.
std::string make_png(const Image &image);

} // namespace runner
