#include "schedule/schedule.h"

#include <algorithm>
#include <utility>

namespace loam {

int Schedule::add(std::string name) {
  stages_.push_back({std::move(name)});
  return static_cast<int>(stages_.size()) - 1;
}

void Schedule::compile(const SceneContents &contents) {
  *this = Schedule();

  sort = add("sort");
  search = add("neighbour search");
  order = add("visit order");
  gradients = add("gradients");
  forces = add("forces");
  if (contents.surroundings.fields) fields = add("fields");
  if (contents.surroundings.colliders) find_contacts = add("find contacts");
  if (contents.cloth && (contents.surroundings.colliders || contents.particles || contents.cloth_self_contact))
    find_cloth_contacts = add("find cloth contacts");
  if (contents.cloth) prepare_cloth = add("prepare cloth");
  const auto any_of_fluids = [&](bool SceneContents::Material::*what) {
    return std::any_of(contents.materials.begin(), contents.materials.end(),
                       [what](const SceneContents::Material &material) { return material.in_use && material.*what; });
  };
  const bool fluids = any_of_fluids(&SceneContents::Material::fluid);
  if (any_of_fluids(&SceneContents::Material::viscous)) viscosity = add("viscosity");
  if (fluids) prepare_fluids = add("prepare fluids");
  if (any_of_fluids(&SceneContents::Material::surface_tension)) surface_tension = add("surface tension");
  if (contents.warm_start) warm_start = add("warm start");
  for (const SceneContents::Material &material : contents.materials)
    solve.push_back(material.in_use ? add("solve " + material.name) : -1);
  if (contents.position_correction) position_correction = add("position correction");
  if (contents.cloth) solve_cloth = add("solve cloth");
  if (contents.cloth_self_contact) cloth_self_contact = add("cloth self contact");
  if (contents.cloth && contents.particles) cloth_particles = add("cloth and particles");
  if (contents.surroundings.colliders) contacts = add("contacts");
  if (contents.cloth && contents.surroundings.colliders) cloth_contacts = add("cloth contacts");
  if (contents.surroundings.tolerance) convergence = add("convergence");
  if (contents.velocity_smoothing) velocity_smoothing = add("velocity smoothing");
  if (any_of_fluids(&SceneContents::Material::vorticity_confinement)) vorticity_confinement = add("vorticity confinement");
  speed_limit = add("speed limit");
  if (contents.surroundings.colliders) final_contacts = add("final contacts");
  for (const SceneContents::Material &material : contents.materials)
    strain.push_back(material.in_use && !material.fluid ? add("strain " + material.name) : -1);
  if (fluids) displace_fluids = add("displace fluids");
  advance = add("advance");
  if (contents.cloth) finish_cloth = add("finish cloth");
  if (contents.sleep) sleep = add("sleep");
  if (contents.surroundings.emitters) emitters = add("emitters");
  if (contents.surroundings.killers) killers = add("killers");
  statistics = add("statistics");
}

void Schedule::begin_step() {
  for (Stage &stage : stages_) {
    stage.seconds = 0;
    stage.items = 0;
  }
}

} // namespace loam
