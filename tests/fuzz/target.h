/* What libFuzzer calls, and replay.cpp where there is no libFuzzer: returns 0, and ends the program where something is wrong. */
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);
