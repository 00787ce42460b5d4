// Reads a scene file's [[materials]]: by law or by preset, with the law's own numbers or with what a designer knows about the matter.
#pragma once

#include "scene.h"
#include "toml_table.h"

namespace runner {

// `gravity` is its size in m/s^2, for what follows from a weight. Throws Error naming file, line and key.
SceneMaterial read_material(TomlTable &table, double gravity);

} // namespace runner
