/* What an effect costs: a scene measured without it and with it, in turns, in one process. */
#pragma once

#include "support/scenes.h"

#include <functional>
#include <string>
#include <vector>

namespace loam::effects {

/* A scene and how its world is made: what an effect changes. */
struct Setup {
  scenes::Scene scene;
  loam_world_def def;
  std::vector<std::function<void(loam_world *, loam_material_id)>> additions; /* after the scene is in the world */
  std::function<void(loam_world *)> each_step;                                /* before every step; its time counts */
};

using Change = void (*)(Setup &);

struct Effect {
  std::string group; /* what kind it is of */
  std::string name;
  std::string scene; /* what the measured scene has more than the sand */
  Change without;    /* what the scene without the effect has more than the sand; null: nothing */
  Change with;       /* the same with it; null: nothing */
};

/* All that is measured, in the order of the page. */
std::vector<Effect> all();

/* Sand at rest between four walls, as many particles, with the library's defaults but for the number of substeps. */
Setup sand_in_a_box(std::size_t particles, std::uint32_t threads);

inline constexpr float substep_seconds = 5e-4f;
inline constexpr std::uint32_t substeps = 4;

} // namespace loam::effects
