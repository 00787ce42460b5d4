#include "obj_reader.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

#include <fmt/format.h>

#include "error.h"

namespace runner {
namespace {

std::string read_text(const std::filesystem::path &path) {
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem))
    throw Error(fmt::format("{}: is a folder, not an OBJ file", path.string()));
  // Devices and pipes may never end.
  if (std::filesystem::exists(path, problem) && !std::filesystem::is_regular_file(path, problem))
    throw Error(fmt::format("{}: is not a regular file", path.string()));
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file) {
    // An empty file sets the fail bit of rdbuf's reader too, without an errno.
    if (errno != 0) throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
  }
  return text.str();
}

// Takes the next word off a line; empty at its end.
std::string_view next_word(std::string_view &line) {
  constexpr std::string_view spaces = " \t\r\v\f";
  line.remove_prefix(std::min(line.find_first_not_of(spaces), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(spaces));
  line.remove_prefix(word.size());
  return word;
}

// Vertices and faces; what else a file holds is passed over. Numbers are read strictly: a typing error must not become a zero.
class Reader {
public:
  Reader(const std::string &name, std::string_view text) : name_(name) {
    for (line_ = 1; !text.empty(); ++line_) {
      std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(line.size() + 1, text.size()));
      const std::string_view statement = next_word(line);
      if (statement == "v") read_vertex(line);
      if (statement == "f") read_face(line);
    }
    if (mesh_.vertices.empty()) throw Error(fmt::format("{}: no vertices (\"v x y z\" lines)", name_));
    if (mesh_.indices.empty()) throw Error(fmt::format("{}: no faces (\"f a b c\" lines)", name_));
    // Faces may come before their vertices.
    for (const Face &face : faces_)
      for (std::size_t i = face.first_index; i < face.end_index; ++i)
        if (mesh_.indices[i] >= mesh_.vertices.size()) refuse_vertex(face, std::int64_t{mesh_.indices[i]} + 1);
  }
  Mesh mesh() { return std::move(mesh_); }

private:
  struct Face {
    std::size_t line, number, first_index, end_index;
  };

  void read_vertex(std::string_view line) {
    Vector3 vertex;
    for (int axis = 0; axis < 3; ++axis) vertex[axis] = coordinate(next_word(line), "xyz"[axis]);
    mesh_.vertices.push_back(vertex);
  }

  float coordinate(std::string_view word, char axis) const {
    float value = 0;
    const char *begin = word.data() + (word.starts_with('+') ? 1 : 0), *end = word.data() + word.size();
    const std::from_chars_result read = std::from_chars(begin, end, value);
    const bool too_large = read.ec == std::errc::result_out_of_range;
    const auto where = [&] { return fmt::format("{}:{}: vertex {}: {}", name_, line_, mesh_.vertices.size() + 1, axis); };
    if (word.empty() || read.ptr != end || (read.ec != std::errc() && !too_large))
      throw Error(fmt::format("{} is not a number: \"{}\"", where(), word));
    // Numbers too small for a float are out of range as well, and harmless.
    if (!std::isfinite(value) || (too_large && std::fabs(std::strtod(std::string(word).c_str(), nullptr)) > 1))
      throw Error(fmt::format("{} is not finite: {}", where(), word));
    return value;
  }

  // A polygon is split into triangles around its first corner.
  void read_face(std::string_view line) {
    Face face = {line_, faces_.size() + 1, mesh_.indices.size(), 0};
    std::vector<std::uint32_t> corners;
    for (std::string_view word = next_word(line); !word.empty() && word[0] != '#'; word = next_word(line))
      corners.push_back(corner(face, word));
    if (corners.size() < 3)
      throw Error(
          fmt::format("{}:{}: face {} has {} corners, not three or more", name_, line_, face.number, corners.size()));
    for (std::size_t c = 1; c + 1 < corners.size(); ++c)
      mesh_.indices.insert(mesh_.indices.end(), {corners[0], corners[c], corners[c + 1]});
    face.end_index = mesh_.indices.size();
    faces_.push_back(face);
  }

  // vertex, vertex/texture, vertex//normal or vertex/texture/normal; a negative vertex counts back from the last one so far.
  std::uint32_t corner(const Face &face, std::string_view word) const {
    const std::string_view number = word.substr(0, word.find('/'));
    std::int64_t vertex = 0;
    const std::from_chars_result read = std::from_chars(number.data(), number.data() + number.size(), vertex);
    if (read.ec == std::errc::invalid_argument || read.ptr != number.data() + number.size())
      throw Error(
          fmt::format("{}:{}: face {}: \"{}\" does not start with a vertex number", name_, line_, face.number, word));
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    if (read.ec != std::errc() || vertex == 0 || vertex < -count || vertex > std::numeric_limits<std::int32_t>::max())
      throw Error(fmt::format("{}:{}: face {} refers to vertex {}; the file has {} up to here, counted from 1", name_, line_,
                              face.number, number, count));
    return static_cast<std::uint32_t>(vertex < 0 ? count + vertex : vertex - 1);
  }

  [[noreturn]] void refuse_vertex(const Face &face, std::int64_t vertex) const {
    throw Error(fmt::format("{}:{}: face {} refers to vertex {}, but the file has {} vertices", name_, face.line,
                            face.number, vertex, mesh_.vertices.size()));
  }

  const std::string &name_;
  std::size_t line_ = 0;
  Mesh mesh_;
  std::vector<Face> faces_;
};

} // namespace

Mesh read_obj(const std::filesystem::path &path) { return parse_obj(path.string(), read_text(path)); }

Mesh parse_obj(const std::string &name, const std::string &text) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw Error(fmt::format("{}: the file is empty", name));
  return Reader(name, text).mesh();
}

} // namespace runner
