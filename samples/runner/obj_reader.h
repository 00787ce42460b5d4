// Reads triangle meshes from Wavefront OBJ files.
#pragma once

#include <filesystem>
#include <string>

#include "mesh.h"

namespace runner {

// Polygons are split into triangles. Throws Error naming the file, and the vertex or face where one is at fault.
Mesh read_obj(const std::filesystem::path &path);
// The same for a file's text; `name` is what messages call it.
Mesh parse_obj(const std::string &name, const std::string &text);

} // namespace runner
