#include "toml_document.h"

#include <algorithm>

#include <fmt/format.h>

#include "error.h"

namespace runner {
namespace {

// From a quote on: where the string ends, behind its last quote. A string of one line also ends with the line.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = text.substr(at, 3);
  const bool lines = three.size() == 3 && three[1] == quote && three[2] == quote;
  for (at += lines ? 3 : 1; at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\') {
      ++at;
    } else if (lines ? text.substr(at, 3) == three : text[at] == quote) {
      return at + (lines ? 3 : 1);
    } else if (!lines && text[at] == '\n') {
      return at;
    }
  }
  return text.size();
}

// Characters beyond ASCII are good in strings and comments only. They are refused here because toml++ 3.3, when it meets some of them elsewhere,
// runs into places that it promised the compiler never to reach.
void check_characters(const std::filesystem::path &path, std::string_view text) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  while (at < text.size()) {
    if (text[at] == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (text[at] == '"' || text[at] == '\'') {
      at = end_of_string(text, at);
    } else if (static_cast<unsigned char>(text[at]) >= 0x80) {
      const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      throw Error(
          fmt::format("{}:{}: a character that is not ASCII outside of a string and a comment", path.string(), line));
    } else {
      ++at;
    }
  }
}

} // namespace

toml::table parse_toml(const std::filesystem::path &path, std::string_view text) {
  check_characters(path, text);
  try {
    return toml::parse(text);
  } catch (const toml::parse_error &error) {
    const toml::source_position at = error.source().begin;
    throw Error(fmt::format("{}:{}:{}: {}", path.string(), at.line, at.column, error.description()));
  }
}

} // namespace runner
