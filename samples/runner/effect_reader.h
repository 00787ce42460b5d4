// The tables of a scene file that describe streams, fields, killers and hinges.
#pragma once

#include <array>

#include "scene.h"
#include "toml_table.h"

namespace runner {

// A table's rotation_axis and rotation_degrees.
std::array<float, 4> read_rotation(TomlTable &table);

// The keys of a stream in the table of an emitter that names a nozzle. `nozzle_file`: receives the file of a mesh as the scene names it.
loam_emitter_def read_stream(TomlTable &table, std::string &nozzle_file);
SceneField read_field(TomlTable &table);
SceneKiller read_killer(TomlTable &table, const std::vector<SceneMaterial> &materials);
SceneHinge read_hinge(TomlTable table);

} // namespace runner
