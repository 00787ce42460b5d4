#include "obj_reader.h"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "error.h"

namespace runner {
namespace {

std::string read_text(const std::filesystem::path &path) {
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem))
    throw Error(fmt::format("{}: is a folder, not an OBJ file", path.string()));
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

// The lines (from 1) on which the file's vertices and faces stand, in their order: tinyobjloader does not keep them. It also reads
// coordinates that are no numbers, NaN among them, as zero without a word; hence the check here.
struct Lines {
  std::vector<std::size_t> vertices, faces;

  Lines(const std::string &name, const std::string &text) {
    std::istringstream stream(text);
    std::string line;
    for (std::size_t number = 1; std::getline(stream, line); ++number) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "v") {
        vertices.push_back(number);
        for (const char axis : {'x', 'y', 'z'}) {
          word.clear();
          words >> word;
          check_coordinate(fmt::format("{}:{}: vertex {}: {}", name, number, vertices.size(), axis), word);
        }
      } else if (word == "f") {
        faces.push_back(number);
        std::size_t corners = 0;
        while (words >> word && word[0] != '#') ++corners;
        if (corners < 3)
          throw Error(fmt::format("{}:{}: face {} has {} corners, not three or more", name, number, faces.size(), corners));
      }
    }
  }

  static void check_coordinate(const std::string &where, const std::string &word) {
    float value = 0;
    const char *begin = word.data() + (word.starts_with('+') ? 1 : 0), *end = word.data() + word.size();
    const std::from_chars_result read = std::from_chars(begin, end, value);
    const bool too_large = read.ec == std::errc::result_out_of_range;
    if (word.empty() || read.ptr != end || (read.ec != std::errc() && !too_large))
      throw Error(fmt::format("{} is not a number: \"{}\"", where, word));
    // Numbers too small for a float are out of range as well, and harmless.
    if (!std::isfinite(value) || (too_large && std::fabs(std::strtod(word.c_str(), nullptr)) > 1))
      throw Error(fmt::format("{} is not finite: {}", where, word));
  }
};

std::string line_of(const std::vector<std::size_t> &lines, std::size_t which) {
  return which < lines.size() ? fmt::format(":{}", lines[which]) : std::string();
}

} // namespace

Mesh read_obj(const std::filesystem::path &path) {
  const std::string name = path.string();
  const std::string text = read_text(path);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) throw Error(fmt::format("{}: the file is empty", name));
  const Lines lines(name, text);

  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, problem;
  std::istringstream stream(text);
  // Polygons are split below, so that a face keeps its place in the file; material files are of no use here.
  const bool read = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &problem, &stream, nullptr, false);
  while (!problem.empty() && (problem.back() == '\n' || problem.back() == ' ')) problem.pop_back();
  if (!read) throw Error(fmt::format("{}: not a valid OBJ file: {}", name, problem));
  if (attributes.vertices.empty()) throw Error(fmt::format("{}: no vertices (\"v x y z\" lines)", name));

  Mesh mesh;
  for (std::size_t i = 0; i + 2 < attributes.vertices.size(); i += 3)
    mesh.vertices.push_back({attributes.vertices[i], attributes.vertices[i + 1], attributes.vertices[i + 2]});

  std::size_t face = 0;
  for (const tinyobj::shape_t &shape : shapes) {
    std::size_t corner = 0;
    for (const unsigned corners : shape.mesh.num_face_vertices) {
      for (unsigned c = 0; c < corners; ++c) {
        const int vertex = shape.mesh.indices[corner + c].vertex_index;
        if (vertex < 0 || static_cast<std::size_t>(vertex) >= mesh.vertices.size())
          throw Error(fmt::format("{}{}: face {} refers to vertex {}, but the file has {} vertices", name,
                                  line_of(lines.faces, face), face + 1, vertex + 1, mesh.vertices.size()));
      }
      for (unsigned c = 1; c + 1 < corners; ++c)
        for (const unsigned k : {0u, c, c + 1})
          mesh.indices.push_back(static_cast<std::uint32_t>(shape.mesh.indices[corner + k].vertex_index));
      corner += corners;
      ++face;
    }
  }
  if (mesh.indices.empty()) throw Error(fmt::format("{}: no faces (\"f a b c\" lines)", name));
  return mesh;
}

} // namespace runner
