// Reads a table of [[cloths]].
#pragma once

#include "mesh.h"
#include "scene.h"
#include "toml_table.h"

namespace runner {

// A flat sheet of columns by rows squares in the plane y = 0 with its middle at the origin, columns along x and rows along z, two triangles a square.
Mesh make_grid(std::uint32_t columns, std::uint32_t rows, float spacing);

// All keys of the table but those of the shape and the place, which are read already; `mesh` is the shape, and colliders are found among the scene's. Throws Error naming
// file, line and key.
void read_cloth(TomlTable &table, const Scene &scene, const Mesh &mesh, SceneCloth &cloth);

} // namespace runner
