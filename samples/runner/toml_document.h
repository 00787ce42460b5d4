// Parses the text of a TOML file.
#pragma once

#include <filesystem>
#include <string_view>

#include <toml++/toml.h>

namespace runner {

// Throws Error naming the file, the line and what is wrong there.
toml::table parse_toml(const std::filesystem::path &path, std::string_view text);

} // namespace runner
