/* Sheets of cloth: made, attached, blown at, let go of. */
#include "session_actions.h"
#include "support/cloths.h"

namespace loam::fuzz {
namespace {

loam_cloth_def random_cloth(Random &random, float r, cloths::Grid &grid) {
  const float spacing = r * random.log_between(0.2, 2);
  grid = cloths::Grid(random.from(1, 8), random.from(1, 8), spacing, random.chance(0.5), random.chance(0.5));
  const double disorder = random.chance(0.5) ? 0 : 0.25;
  for (float &x : grid.positions) x += spacing * random.between(-disorder, disorder);
  loam_cloth_def def = cloths::definition(grid);
  random_place(random, r, def.position, def.rotation);
  if (random.chance(0.3))
    for (float &v : def.velocity) v = random.between(-1, 1) * random.log_between(0.01, 100);
  if (random.chance(0.5)) def.areal_density = random.log_between(1e-3, 100);
  if (random.chance(0.5)) def.stretch_stiffness = random.log_between(1, 1e7);
  if (random.chance(0.5)) def.shear_stiffness = random.chance(0.2) ? 0 : random.log_between(1, 1e7);
  if (random.chance(0.5)) def.bending_stiffness = random.chance(0.2) ? 0 : random.log_between(1e-7, 10);
  if (random.chance(0.3)) def.damping = random.chance(0.3) ? 0 : random.log_between(1e-5, 1);
  if (random.chance(0.5)) def.greatest_stretch = random.chance(0.5) ? 0 : random.log_between(1e-4, 1);
  if (random.chance(0.5)) def.thickness = std::clamp(r * random.log_between(0.1, 1), 1e-6f, 1e3f);
  if (random.chance(0.5)) def.particle_friction = random.log_between(0.01, 100);
  if (random.chance(0.4)) def.self_distance = std::clamp(spacing * random.log_between(0.1, 3), 1e-6f, 1e3f);
  if (random.chance(0.3)) def.tear_strain = random.log_between(1e-4, 10);
  if (random.chance(0.3)) def.self_friction = random.chance(0.3) ? 0 : random.log_between(0.01, 100);
  return def;
}

} // namespace

void Session::create_cloth(Random &random) {
  if (now_.cloths.size() >= 3) return;
  cloths::Grid grid(1, 1, 1);
  const loam_cloth_def def = random_cloth(random, def_.kernel_radius, grid);
  const bool usual = def_.kernel_radius >= 1e-3f && def_.kernel_radius <= 1; // others may leave what a cloth allows
  const Expect expect = usual ? Expect::success : Expect::anything;
  loam_cloth_id id = 0;
  if (!call("create cloth", expect, [&] { return loam_cloth_create(world_, &def, &id); })) return;
  now_.cloths.push_back({id, std::vector<loam_collider_id>(grid.positions.size() / 3, 0)});
  ++description_;
  look_at_cloth(now_.cloths.back());
}

void Session::destroy_cloth(Random &random) {
  if (now_.cloths.empty()) return;
  const std::size_t which = random.below(now_.cloths.size());
  const loam_cloth_id id = now_.cloths[which].id;
  if (!call("destroy cloth", Expect::success, [&] { return loam_cloth_destroy(world_, id); })) return;
  stale_.push_back(id);
  now_.cloths.erase(now_.cloths.begin() + std::ptrdiff_t(which));
  ++description_;
}

void Session::attach(Random &random) {
  if (now_.cloths.empty()) return;
  Cloth &cloth = any(now_.cloths, random);
  std::vector<std::uint32_t> vertices;
  const double share = random.log_between(0.02, 1);
  bool held = false;
  for (std::size_t v = 0; v < cloth.held.size(); ++v)
    if (random.chance(share) && (cloth.held[v] == 0 || random.chance(0.05))) {
      held = held || cloth.held[v] != 0;
      vertices.push_back(std::uint32_t(v));
    }
  if (vertices.empty()) return;
  loam_cloth_attachment_def def;
  scenes::require(loam_cloth_attachment_def_default(&def, sizeof def), "default");
  def.count = std::uint32_t(vertices.size());
  def.vertices = vertices.data();
  std::vector<float> points;
  for (std::size_t i = 0; i < 3 * vertices.size(); ++i) points.push_back(def_.kernel_radius * random.between(-4, 4));
  if (random.chance(0.3)) def.points = points.data();
  if (random.chance(0.3)) def.compliance = random.log_between(1e-9, 1e3);
  if (!now_.colliders.empty() && random.chance(0.5)) def.collider = any(now_.colliders, random).id;
  const Expect expect = held ? Expect::in_use : Expect::success;
  if (!call("attach", expect, [&] { return loam_cloth_attach(world_, cloth.id, &def); })) return;
  for (const std::uint32_t v : vertices) cloth.held[v] = def.collider != 0 ? def.collider : Cloth::by_space;
}

void Session::release(Random &random) {
  if (now_.cloths.empty()) return;
  Cloth &cloth = any(now_.cloths, random);
  std::vector<std::uint32_t> vertices;
  const double share = random.chance(0.3) ? 1 : random.uniform();
  bool free = false;
  for (std::size_t v = 0; v < cloth.held.size(); ++v)
    if (random.chance(share) && (cloth.held[v] != 0 || random.chance(0.01))) {
      free = free || cloth.held[v] == 0;
      vertices.push_back(std::uint32_t(v));
    }
  if (vertices.empty()) return;
  const Expect expect = free ? Expect::invalid : Expect::success;
  if (!call("release", expect,
            [&] { return loam_cloth_release(world_, cloth.id, vertices.data(), std::uint32_t(vertices.size())); }))
    return;
  for (const std::uint32_t v : vertices) cloth.held[v] = 0;
}

void Session::blow(Random &random) {
  if (now_.cloths.empty()) return;
  const loam_cloth_id cloth = any(now_.cloths, random).id;
  float wind[3];
  for (float &w : wind) w = random.between(-1, 1) * random.log_between(0.1, 100);
  const float drag = random.chance(0.2) ? 0 : random.log_between(0.01, 100),
              lift = random.chance(0.5) ? 0 : random.log_between(0.01, 100);
  call("blow", Expect::success, [&] { return loam_cloth_set_wind(world_, cloth, wind, drag, lift); });
}

double Session::look_at_cloth(const Cloth &cloth) {
  loam_cloth_view view = {};
  view.struct_size = sizeof view;
  const loam_status status = loam_cloth_map(world_, cloth.id, &view);
  judge("map cloth", Expect::success, status);
  if (status != LOAM_OK) return 0;
  double fastest = 0;
  bool finite = view.vertex_count >= cloth.held.size(); // more where it has torn
  for (std::size_t i = 0; i < 4 * std::size_t(view.vertex_count); ++i)
    finite =
        finite && std::isfinite(view.positions[i]) && std::isfinite(view.velocities[i]) && std::isfinite(view.normals[i]);
  for (std::size_t i = 0; i < 4 * std::size_t(view.vertex_count); i += 4)
    fastest = std::max(
        fastest, std::hypot(double(view.velocities[i]), double(view.velocities[i + 1]), double(view.velocities[i + 2])));
  if (!finite) find("a cloth is not finite, or has lost vertices");
  judge("unmap cloth", Expect::success, loam_cloth_unmap(world_, cloth.id));
  return fastest;
}

void Session::bad_cloth(Random &random) {
  const float bad = bad_number(random);
  const std::uint32_t what = random.below(5);
  if (what == 0) {
    cloths::Grid grid(1, 1, 1);
    loam_cloth_def def = random_cloth(random, def_.kernel_radius, grid);
    float *const numbers[] = {def.position,           &def.areal_density,
                              &def.stretch_stiffness, &def.shear_stiffness,
                              &def.thickness,         &def.bending_stiffness,
                              &def.damping,           &def.greatest_stretch,
                              def.rotation,           def.warp,
                              def.velocity,           &def.particle_friction,
                              &def.self_distance,     &def.self_friction,
                              &def.tear_strain,       &grid.positions[random.below(grid.positions.size())]};
    const std::uint32_t which = random.below(std::size(numbers) + 3);
    if (which < std::size(numbers)) *numbers[which] = bad;
    if (which == std::size(numbers)) grid.indices[random.below(grid.indices.size())] = ~0u - random.below(9);
    if (which == std::size(numbers) + 1) def.mesh.positions = nullptr;
    if (which == std::size(numbers) + 2) std::fill(grid.positions.begin(), grid.positions.end(), 1.0f);
    loam_cloth_id id = 0;
    call("create a bad cloth", Expect::failure, [&] { return loam_cloth_create(world_, &def, &id); });
    return;
  }
  const loam_cloth_id none = !stale_.empty() && random.chance(0.7) ? stale_[random.below(stale_.size())] : random.next();
  const float wind[3] = {0, what == 1 ? bad : 0, 0};
  if (what == 1 && !now_.cloths.empty()) {
    call("blow badly", Expect::failure,
         [&] { return loam_cloth_set_wind(world_, any(now_.cloths, random).id, wind, 1, 1); });
    return;
  }
  const std::uint32_t vertex = 1000000;
  loam_cloth_attachment_def def;
  scenes::require(loam_cloth_attachment_def_default(&def, sizeof def), "default");
  def.count = 1;
  def.vertices = &vertex;
  const bool there = !now_.cloths.empty() && random.chance(0.5); // the cloth; the vertex is not
  const loam_cloth_id cloth = there ? any(now_.cloths, random).id : none;
  switch (what) {
  case 2:
    call("destroy no cloth", Expect::failure, [&] { return loam_cloth_destroy(world_, none); });
    break;
  case 3:
    call("attach nothing", Expect::failure, [&] { return loam_cloth_attach(world_, cloth, &def); });
    break;
  default:
    call("release nothing", Expect::failure, [&] { return loam_cloth_release(world_, cloth, &vertex, 1); });
    break;
  }
}

} // namespace loam::fuzz
