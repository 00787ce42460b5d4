// Reads scene files (TOML). samples/scenes/hourglass/scene.toml shows every table, samples/scenes/noodles colliders that move.
#pragma once

#include <filesystem>
#include <string_view>

#include "scene.h"

namespace runner {

// Reads a scene and the meshes that it names; mesh paths are relative to the scene file. Throws Error naming file, line and key for
// anything that is unknown, missing or of the wrong type. Ranges of physical values are left to the library.
Scene read_scene(const std::filesystem::path &path);
// The same for a scene file's text; `path` is where it would stand.
Scene parse_scene(const std::filesystem::path &path, std::string_view text);

// Multiplies the number of particles by about `factor`: lengths of the discretisation shrink by its cube root, and the substeps
// grow by the same, so that sound travels as many kernel radii a substep as before. The scene's size stays. Over 0.
void scale_particle_count(Scene &scene, double factor);

} // namespace runner
