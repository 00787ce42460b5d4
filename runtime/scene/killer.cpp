#include "scene/killer.h"

#include "scene/checks.h"
#include "scene/pose.h"

namespace loam {

namespace {

KillerView view_of(const loam_killer_def &def, int material) {
  KillerView view = {};
  view.kind = def.kind == LOAM_KILLER_BOX      ? KillerKind::box
              : def.kind == LOAM_KILLER_SPHERE ? KillerKind::sphere
                                               : KillerKind::age;
  view.material = material;
  view.pose = make_pose(def.position, def.rotation);
  view.half_extents = {def.half_extents[0], def.half_extents[1], def.half_extents[2]};
  view.radius = def.radius;
  view.age = def.age;
  view.outside = def.outside == 1;
  return view;
}

} // namespace

loam_killer_def default_killer() {
  loam_killer_def def = {};
  def.struct_size = sizeof def;
  def.rotation[3] = 1;
  return def;
}

void KillerScene::check(const loam_killer_def &def) {
  check_choice("kind", def.kind, LOAM_KILLER_AGE);
  (void)make_pose(def.position, def.rotation);
  if (def.kind == LOAM_KILLER_BOX) {
    constexpr const char *names[3] = {"half_extents[0]", "half_extents[1]", "half_extents[2]"};
    for (int k = 0; k < 3; ++k) check_above(names[k], static_cast<double>(def.half_extents[k]), 0, 1e8);
  }
  if (def.kind == LOAM_KILLER_SPHERE) check_above("radius", static_cast<double>(def.radius), 0, 1e8);
  if (def.kind == LOAM_KILLER_AGE) check_above("age", static_cast<double>(def.age), 0, 1e6);
  check_choice("outside", def.outside, 1);
  check_reserved("reserved", def.reserved);
}

loam_killer_id KillerScene::create(const loam_killer_def &def, int material) {
  Killer killer;
  killer.def = def;
  killer.view = view_of(def, material);
  return table_.add(std::move(killer));
}

void KillerScene::set(loam_killer_id id, const loam_killer_def &def, int material) {
  Killer &killer = table_.at(id, "killer");
  killer.view = view_of(def, material);
  killer.def = def;
}

bool KillerScene::any() const {
  return any_that([](const Killer &) { return true; });
}
bool KillerScene::any_of_age(const Killer *but) const {
  return any_that([but](const Killer &killer) { return &killer != but && killer.def.kind == LOAM_KILLER_AGE; });
}
bool KillerScene::any_of_material(int material) const {
  return any_that([material](const Killer &killer) { return killer.view.material == material; });
}

void KillerScene::begin_step(std::vector<KillerState> &states) {
  states.clear();
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (Killer *killer = table_.at_index(i); killer != nullptr) {
      killer->killed.clear();
      states.push_back({killer->view, &killer->killed});
    }
}

void KillerScene::end_step() {
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (Killer *killer = table_.at_index(i); killer != nullptr) killer->total += killer->killed.size();
}

void KillerScene::shift_origin(const Vec3<float> &by) {
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (Killer *killer = table_.at_index(i); killer != nullptr) killer->view.pose.position = killer->view.pose.position - by;
}

} // namespace loam
