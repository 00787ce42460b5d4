#include "scene/field.h"

#include "scene/checks.h"
#include "solver/fields.h"

namespace loam {

namespace {

void check_field(const loam_field_def &def, double r) {
  check_choice("kind", def.kind, LOAM_FIELD_BLAST);
  check_vector("position", def.position, 1e6 * r);
  check_vector("velocity", def.velocity, 1e6);
  if (def.kind == LOAM_FIELD_WIND) check_above("rate", static_cast<double>(def.rate), 0, 1e6);
  check_range("strength", static_cast<double>(def.strength), -1e12, 1e12);
  if (def.kind == LOAM_FIELD_ATTRACTOR) check_range("softening", static_cast<double>(def.softening), 0.01 * r, 1e6 * r);
  check_range("speed", static_cast<double>(def.speed), -1e6, 1e6);
  if (def.kind == LOAM_FIELD_BLAST)
    check_above("radius", static_cast<double>(def.radius), 0, 1e6 * r);
  else
    check_range("radius", static_cast<double>(def.radius), 0, 1e6 * r);
  check_range("time", static_cast<double>(def.time), 0, 1e6);
}

FieldScene::Changes begin(const loam_field_def &def) { return {{def.position[0], def.position[1], def.position[2]}, 0, 0}; }

FieldState state_of(const FieldScene::Field &field) {
  const loam_field_def &def = field.def;
  FieldState state = {};
  state.centre = field.changes.position;
  state.wait = -1;
  switch (def.kind) {
  case LOAM_FIELD_WIND:
    state.kind = FieldKind::wind;
    state.velocity = {def.velocity[0], def.velocity[1], def.velocity[2]};
    state.strength = static_cast<double>(def.rate);
    state.radius = def.radius;
    break;
  case LOAM_FIELD_ATTRACTOR:
    state.kind = FieldKind::attractor;
    state.strength = static_cast<double>(def.strength);
    state.softening = def.softening;
    break;
  default:
    state.kind = FieldKind::blast;
    state.strength = static_cast<double>(def.speed);
    state.radius = def.radius;
    if (field.changes.spent == 0) state.wait = std::max(0.0, static_cast<double>(def.time) - field.changes.clock);
    break;
  }
  return state;
}

} // namespace

loam_field_def default_field() {
  loam_field_def def = {};
  def.struct_size = sizeof def;
  def.rate = 1;
  return def;
}

loam_field_id FieldScene::create(const loam_field_def &def) {
  check_field(def, radius_);
  return table_.add({def, begin(def)});
}

void FieldScene::set(loam_field_id id, const loam_field_def &def) {
  Field &field = table_.at(id, "field");
  check_field(def, radius_);
  field = {def, begin(def)};
}

bool FieldScene::any() const {
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (const Field *field = table_.at_index(i); field != nullptr && field->changes.spent == 0) return true;
  return false;
}

void FieldScene::list(std::vector<FieldState> &states) const {
  states.clear();
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (const Field *field = table_.at_index(i); field != nullptr && field->changes.spent == 0)
      states.push_back(state_of(*field));
}

void FieldScene::advance(double seconds, std::uint32_t substeps, std::uint32_t substeps_done) {
  const double substep = seconds / substeps;
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (Field *field = table_.at_index(i); field != nullptr) {
      if (field->def.kind == LOAM_FIELD_BLAST && field->changes.spent == 0) {
        const int came = blast_substep(state_of(*field).wait, substep, substeps);
        if (came >= 0 && came < static_cast<int>(substeps_done)) field->changes.spent = 1;
      }
      field->changes.clock += substep * substeps_done;
    }
}

void FieldScene::shift_origin(const Vec3<float> &by) {
  for (std::size_t i = 0; i < table_.size(); ++i)
    if (Field *field = table_.at_index(i); field != nullptr) field->changes.position = field->changes.position - by;
}

void FieldScene::check(const Changes &changes) {
  const float position[3] = {changes.position.x, changes.position.y, changes.position.z};
  check_vector("position", position, 1e15);
  check_choice("spent", changes.spent, 1);
  check_range("clock of a field", changes.clock, 0, 1e12);
}

} // namespace loam
