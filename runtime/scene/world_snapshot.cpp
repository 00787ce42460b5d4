// What a world puts into snapshots, and what it takes from them.
//
// A restore first reads and checks everything, then asks for what memory may be needed, and only then changes the world.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "scene/checks.h"
#include "scene/snapshot_format.h"
#include "scene/world.h"

using namespace loam;

// Of what the scene holds, all that changes without being described anew.
struct loam_world::Moving {
  loam_accuracy_def accuracy;
  Vec3<float> gravity;
  std::uint64_t next_id; // of particles
  std::uint32_t wake;    // all that sleeps, with the next step
  struct Poses {
    Pose pose, target;
  };
  std::vector<Poses> colliders; // by slot
  std::vector<ClothScene::Changes> cloths;
  std::uint64_t dropped; // of all streams so far
  std::vector<EmitterState> emitters;
  std::vector<FieldScene::Changes> fields;
  struct KillerChanges {
    Pose pose;
    std::uint32_t reserved; // 0
    std::uint64_t total;
  };
  std::vector<KillerChanges> killers;
};

namespace {

class FieldWriter {
public:
  explicit FieldWriter(SnapshotWriter &writer) : writer_(writer) {}
  // What follows belongs to the `index`-th of its kind.
  void at(const char *, std::size_t) {}
  // A part of the description.
  template <class T> void same(const char *, const T &value) { writer_.put(value); }
  template <class T> void value(T &value) { writer_.put(value); }
  template <class T> void list(std::vector<T> &values, std::size_t) {
    writer_.put(static_cast<std::uint32_t>(values.size()));
    for (const T &value : values) writer_.put(value);
  }

private:
  SnapshotWriter &writer_;
};

class FieldReader {
public:
  explicit FieldReader(SnapshotReader &reader) : reader_(reader) {}
  void at(const char *kind, std::size_t index) {
    kind_ = kind;
    index_ = index;
  }
  template <class T> void same(const char *name, const T &value) {
    const T saved = reader_.take<T>();
    using Bytes = std::array<unsigned char, sizeof(T)>;
    if (std::bit_cast<Bytes>(saved) == std::bit_cast<Bytes>(value)) return;
    const std::string whose = kind_ != nullptr ? format("%s %zu: ", kind_, index_) : std::string();
    if constexpr (std::is_floating_point_v<T>)
      throw Error(LOAM_ERROR_SNAPSHOT_MISMATCH, format("%s%s is %g in the world and %g in the snapshot", whose.c_str(), name,
                                                       static_cast<double>(value), static_cast<double>(saved)));
    else
      throw Error(LOAM_ERROR_SNAPSHOT_MISMATCH,
                  format("%s%s is %llu in the world and %llu in the snapshot", whose.c_str(), name,
                         static_cast<unsigned long long>(value), static_cast<unsigned long long>(saved)));
  }
  template <class T> void value(T &value) { value = reader_.take<T>(); }
  template <class T> void list(std::vector<T> &values, std::size_t most) {
    const auto count = reader_.take<std::uint32_t>();
    if (count > most) throw Error(LOAM_ERROR_INVALID_SNAPSHOT, "the snapshot has a list longer than it can be");
    values.resize(count);
    for (T &value : values) value = reader_.take<T>();
  }

private:
  SnapshotReader &reader_;
  const char *kind_ = nullptr;
  std::size_t index_ = 0;
};

struct MaterialField {
  const char *name;
  float loam_material_def::*value;
};
constexpr MaterialField material_fields[] = {{"density", &loam_material_def::density},
                                             {"youngs_modulus", &loam_material_def::youngs_modulus},
                                             {"poissons_ratio", &loam_material_def::poissons_ratio},
                                             {"yield_stress", &loam_material_def::yield_stress},
                                             {"friction_angle", &loam_material_def::friction_angle},
                                             {"cohesion", &loam_material_def::cohesion},
                                             {"hardening_modulus", &loam_material_def::hardening_modulus},
                                             {"consolidation", &loam_material_def::consolidation},
                                             {"cohesion_ratio", &loam_material_def::cohesion_ratio},
                                             {"hardening_factor", &loam_material_def::hardening_factor},
                                             {"critical_state_slope", &loam_material_def::critical_state_slope},
                                             {"shear_yield_stress", &loam_material_def::shear_yield_stress},
                                             {"consistency", &loam_material_def::consistency},
                                             {"flow_exponent", &loam_material_def::flow_exponent},
                                             {"critical_compression", &loam_material_def::critical_compression},
                                             {"critical_stretch", &loam_material_def::critical_stretch},
                                             {"viscosity", &loam_material_def::viscosity},
                                             {"surface_tension", &loam_material_def::surface_tension},
                                             {"adhesion", &loam_material_def::adhesion},
                                             {"vorticity_confinement", &loam_material_def::vorticity_confinement}};

// Slots up to the last that is in use; `at(slot)` is null where there is nothing.
template <class At> std::uint32_t used_slots(std::size_t count, At &&at) {
  while (count > 0 && at(count - 1) == nullptr) --count;
  return static_cast<std::uint32_t>(count);
}

void check_pose(const Pose &pose) {
  const float values[7] = {pose.position.x, pose.position.y, pose.position.z, pose.rotation.x,
                           pose.rotation.y, pose.rotation.z, pose.rotation.w};
  check_vector("position", values, 1e9);
  float squared = 0;
  for (int k = 3; k < 7; ++k) squared += values[k] * values[k];
  check_range("length of a rotation", static_cast<double>(squared), 0.99, 1.01);
}

void check_attachments(const std::vector<SolverAttachment> &attachments, std::uint32_t vertices) {
  std::vector<bool> held(vertices);
  for (const SolverAttachment &a : attachments) {
    if (a.vertex < 0 || static_cast<std::uint32_t>(a.vertex) >= vertices || held[static_cast<std::size_t>(a.vertex)])
      invalid_snapshot("attaches a vertex that is not there, or twice");
    held[static_cast<std::size_t>(a.vertex)] = true;
    const float point[3] = {a.point.x, a.point.y, a.point.z};
    check_vector("point", point, 1e9);
    check_range("stiffness", static_cast<double>(a.stiffness), 0, 1.01e9);
  }
}

float float_of(std::uint32_t word) {
  float value;
  std::memcpy(&value, &word, sizeof value);
  return value;
}

} // namespace

loam_world::Moving loam_world::moving() const {
  Moving moving = {};
  moving.accuracy = accuracy_;
  moving.gravity = input_.gravity;
  moving.next_id = next_id_;
  moving.wake = input_.wake ? 1 : 0;
  moving.dropped = dropped_;
  for (std::size_t i = 0; i < colliders_.size(); ++i) {
    const Collider *c = colliders_.at_index(i);
    moving.colliders.push_back(c != nullptr ? Moving::Poses{c->pose, c->target} : Moving::Poses{});
  }
  for (std::size_t i = 0; i < cloths_.slot_count(); ++i)
    moving.cloths.push_back(cloths_.description(i) != nullptr ? cloths_.changes(backend_->cloth(), i)
                                                              : ClothScene::Changes());
  for (std::size_t i = 0; i < emitters_.slot_count(); ++i)
    moving.emitters.push_back(emitters_.at_slot(i) != nullptr ? emitters_.at_slot(i)->state() : EmitterState());
  for (std::size_t i = 0; i < fields_.slot_count(); ++i)
    moving.fields.push_back(fields_.at_slot(i) != nullptr ? fields_.at_slot(i)->changes : FieldScene::Changes());
  for (std::size_t i = 0; i < killers_.slot_count(); ++i)
    moving.killers.push_back(killers_.at_slot(i) != nullptr
                                 ? Moving::KillerChanges{killers_.at_slot(i)->view.pose, 0, killers_.at_slot(i)->total}
                                 : Moving::KillerChanges());
  return moving;
}

// The fields of a snapshot, one after the other: those that must be the same, and those that move.
template <class Fields> void loam_world::exchange(Fields &fields, Moving &moving) const {
  fields.same("kernel_radius", def_.kernel_radius);
  fields.same("solver", def_.solver);
  fields.same("plasticity", def_.plasticity);
  fields.same("velocity_smoothing", def_.velocity_smoothing);
  fields.same("minimum_distance", def_.minimum_distance);
  fields.same("gradient_cutoff", def_.gradient_cutoff);
  fields.same("particle_capacity", def_.particle_capacity);
  fields.same("multiplier", def_.multiplier);
  fields.same("zero_energy_stiffness", def_.zero_energy_stiffness);
  fields.same("warm_start", def_.warm_start);
  fields.same("sleep_speed", def_.sleep_speed);
  fields.same("sleep_delay", def_.sleep_delay);

  const auto material_at = [&](std::size_t i) { return materials_.at_index(i); };
  const std::uint32_t materials = used_slots(materials_.size(), material_at);
  fields.same("number of materials", materials);
  for (std::size_t i = 0; i < materials; ++i) {
    fields.at("material", i);
    const Material *m = material_at(i);
    fields.same("presence", static_cast<std::uint32_t>(m != nullptr));
    if (m == nullptr) continue;
    fields.same("law", m->def.law);
    for (const MaterialField &field : material_fields) fields.same(field.name, m->def.*field.value);
    fields.same("constant_hardness", m->def.constant_hardness);
  }
  std::vector<Contact> contacts = contacts_;
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact &x, const Contact &y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  fields.at("meetings by contact", 0);
  fields.same("their number", static_cast<std::uint32_t>(contacts.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    fields.at("meeting by contact", i);
    fields.same("one material", static_cast<std::uint32_t>(contacts[i].a));
    fields.same("the other material", static_cast<std::uint32_t>(contacts[i].b));
    fields.same("friction", contacts[i].friction);
  }

  const auto collider_at = [&](std::size_t i) { return colliders_.at_index(i); };
  const std::uint32_t colliders = used_slots(colliders_.size(), collider_at);
  fields.at("colliders", 0);
  fields.same("number of colliders", colliders);
  for (std::size_t i = 0; i < colliders; ++i) {
    fields.at("collider", i);
    const Collider *c = collider_at(i);
    fields.same("presence", static_cast<std::uint32_t>(c != nullptr));
    if (c == nullptr) continue;
    fields.same("kind", c->def.kind);
    fields.same("friction", c->law.friction);
    fields.same("restitution", c->law.restitution);
    fields.same("stick", c->law.stick);
    std::vector<PairLaw> pairs = c->pairs;
    std::sort(pairs.begin(), pairs.end(), [](const PairLaw &x, const PairLaw &y) { return x.material < y.material; });
    fields.same("number of contacts with a material of their own", static_cast<std::uint32_t>(pairs.size()));
    for (const PairLaw &pair : pairs) {
      fields.same("material of a contact", pair.material);
      fields.same("friction with a material", pair.law.friction);
      fields.same("restitution with a material", pair.law.restitution);
      fields.same("stick with a material", pair.law.stick);
    }
    fields.same("radius", c->def.radius);
    fields.same("half_height", c->def.half_height);
    for (const float half_extent : c->def.half_extents) fields.same("half_extents", half_extent);
    fields.same("fingerprint of the mesh", c->mesh);
    fields.same("fingerprint of the grid", c->grid);
    fields.same("deforms", c->def.deforms);
    fields.value(moving.colliders[i].pose);
    fields.value(moving.colliders[i].target);
  }

  const auto cloth_at = [&](std::size_t i) { return cloths_.description(i); };
  const std::uint32_t cloths = used_slots(cloths_.slot_count(), cloth_at);
  fields.at("cloths", 0);
  fields.same("number of cloths", cloths);
  for (std::size_t i = 0; i < cloths; ++i) {
    fields.at("cloth", i);
    const ClothScene::Description *c = cloth_at(i);
    fields.same("presence", static_cast<std::uint32_t>(c != nullptr));
    if (c == nullptr) continue;
    fields.same("vertex_count", c->vertex_count);
    fields.same("fingerprint of the mesh", c->mesh);
    fields.same("areal_density", c->def.areal_density);
    fields.same("stretch_stiffness", c->def.stretch_stiffness);
    fields.same("shear_stiffness", c->def.shear_stiffness);
    fields.same("bending_stiffness", c->def.bending_stiffness);
    fields.same("damping", c->def.damping);
    for (const float component : c->def.warp) fields.same("warp", component);
    fields.same("greatest_stretch", c->def.greatest_stretch);
    fields.same("thickness", c->def.thickness);
    fields.same("particle_friction", c->def.particle_friction);
    fields.same("self_distance", c->def.self_distance);
    fields.same("self_friction", c->def.self_friction);
    fields.same("tear_strain", c->def.tear_strain);
    fields.list(moving.cloths[i].torn, 3 * std::size_t(c->triangle_count));
    fields.list(moving.cloths[i].attachments, 3 * std::size_t(c->triangle_count));
    fields.value(moving.cloths[i].wind);
  }

  const auto emitter_at = [&](std::size_t i) { return emitters_.at_slot(i); };
  const std::uint32_t emitters = used_slots(emitters_.slot_count(), emitter_at);
  fields.at("emitters", 0);
  fields.same("number of emitters", emitters);
  for (std::size_t i = 0; i < emitters; ++i) {
    fields.at("emitter", i);
    const Emitter *e = emitter_at(i);
    fields.same("presence", static_cast<std::uint32_t>(e != nullptr));
    if (e == nullptr) continue;
    const loam_emitter_def &def = e->def();
    fields.same("nozzle", def.nozzle);
    fields.same("material", static_cast<std::uint32_t>(materials_.index_of(def.material, "material")));
    for (const float component : def.rotation) fields.same("rotation", component);
    for (const float component : def.direction) fields.same("direction", component);
    fields.same("radius", def.radius);
    fields.same("speed", def.speed);
    fields.same("fingerprint of the mesh", e->mesh());
    fields.same("flow", def.flow);
    fields.same("mass_flow", def.mass_flow);
    fields.same("spacing", def.spacing);
    fields.same("jitter", def.jitter);
    fields.same("velocity_jitter", def.velocity_jitter);
    fields.same("start", def.start);
    fields.same("stop", def.stop);
    fields.same("seed", def.seed);
    fields.value(moving.emitters[i]);
  }
  fields.value(moving.dropped);

  const auto field_at = [&](std::size_t i) { return fields_.at_slot(i); };
  const std::uint32_t forces = used_slots(fields_.slot_count(), field_at);
  fields.at("fields", 0);
  fields.same("number of fields", forces);
  for (std::size_t i = 0; i < forces; ++i) {
    fields.at("field", i);
    const FieldScene::Field *f = field_at(i);
    fields.same("presence", static_cast<std::uint32_t>(f != nullptr));
    if (f == nullptr) continue;
    fields.same("kind", f->def.kind);
    for (const float component : f->def.velocity) fields.same("velocity", component);
    fields.same("rate", f->def.rate);
    fields.same("strength", f->def.strength);
    fields.same("softening", f->def.softening);
    fields.same("speed", f->def.speed);
    fields.same("radius", f->def.radius);
    fields.same("time", f->def.time);
    fields.value(moving.fields[i]);
  }

  const auto killer_at = [&](std::size_t i) { return killers_.at_slot(i); };
  const std::uint32_t killers = used_slots(killers_.slot_count(), killer_at);
  fields.at("killers", 0);
  fields.same("number of killers", killers);
  for (std::size_t i = 0; i < killers; ++i) {
    fields.at("killer", i);
    const KillerScene::Killer *k = killer_at(i);
    fields.same("presence", static_cast<std::uint32_t>(k != nullptr));
    if (k == nullptr) continue;
    fields.same("kind", k->def.kind);
    fields.same("material", static_cast<std::uint32_t>(k->view.material + 1));
    for (const float half_extent : k->def.half_extents) fields.same("half_extents", half_extent);
    fields.same("radius", k->def.radius);
    fields.same("age", k->def.age);
    fields.same("outside", k->def.outside);
    fields.value(moving.killers[i]);
  }

  fields.value(moving.accuracy.mode);
  fields.value(moving.accuracy.substeps);
  fields.value(moving.accuracy.iterations);
  fields.value(moving.accuracy.most_substeps);
  fields.value(moving.accuracy.courant);
  fields.value(moving.accuracy.tolerance);
  fields.value(moving.accuracy.budget);
  fields.value(moving.gravity);
  fields.value(moving.next_id);
  fields.value(moving.wake);
}

// Throws Error where a value could not have come from the calls that set it.
void loam_world::check(const Moving &moving) const {
  check_accuracy(moving.accuracy);
  const float gravity[3] = {moving.gravity.x, moving.gravity.y, moving.gravity.z};
  check_vector("gravity", gravity, 1e6);
  if (moving.next_id > 0xffffffffu) invalid_snapshot("has given out more ids than there are");
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (colliders_.at_index(i) != nullptr) {
      check_pose(moving.colliders[i].pose);
      check_pose(moving.colliders[i].target);
    }
  for (std::size_t i = 0; i < cloths_.slot_count(); ++i)
    if (const ClothScene::Description *c = cloths_.description(i); c != nullptr) {
      if (!cloths_.could_be_torn(backend_->cloth(), i, moving.cloths[i].torn))
        invalid_snapshot("tears a cloth as it cannot be torn");
      std::uint32_t vertices = c->vertex_count;
      for (const TornCorner &torn : moving.cloths[i].torn)
        vertices = std::max(vertices, static_cast<std::uint32_t>(torn.vertex) + 1);
      check_attachments(moving.cloths[i].attachments, vertices);
      check_wind(moving.cloths[i].wind);
      for (const SolverAttachment &a : moving.cloths[i].attachments)
        if (a.collider != -1 && (a.collider < 0 || static_cast<std::size_t>(a.collider) >= colliders_.size() ||
                                 colliders_.at_index(static_cast<std::size_t>(a.collider)) == nullptr))
          invalid_snapshot("attaches a vertex to a collider that is not there");
    }
  for (std::size_t i = 0; i < emitters_.slot_count(); ++i)
    if (const Emitter *e = emitters_.at_slot(i); e != nullptr) e->check_state(moving.emitters[i], moving.next_id);
  for (std::size_t i = 0; i < fields_.slot_count(); ++i)
    if (fields_.at_slot(i) != nullptr) FieldScene::check(moving.fields[i]);
  for (std::size_t i = 0; i < killers_.slot_count(); ++i)
    if (killers_.at_slot(i) != nullptr) check_pose(moving.killers[i].pose);
}

// Those of meshes that deform are named by the colliders' slots.
void loam_world::list_vertices(std::vector<StateSection> &state) {
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (const Collider *c = colliders_.at_index(i); c != nullptr && c->def.deforms == 1)
      backend_->list_vertices(c->shape, static_cast<std::uint32_t>(i), state);
}

// ------------------------------------------------------------------------------------------------------- saving ---

void loam_world::write(SnapshotWriter &writer) {
  const ReadSection read = [this](const StateSection &section, std::uint64_t first, std::size_t count,
                                  std::uint32_t *words) { backend_->read_state(section, first, count, words); };
  SnapshotHeader header = {};
  writer.put(header); // for now
  Moving moving = this->moving();
  FieldWriter fields(writer);
  exchange(fields, moving);
  header.field_bytes = writer.bytes() - sizeof header;
  std::vector<StateSection> state = backend_->state(backend_->particle_count());
  cloths_.list_state(backend_->cloth(), moving.cloths, state);
  list_vertices(state);
  for (const StateSection &section : state) writer.section(section, read);
  std::memcpy(header.magic, "LOAMSNAP", 8);
  header.version = LOAM_SNAPSHOT_VERSION;
  header.byte_order = 0x01020304u;
  header.particles = backend_->particle_count();
  header.sections = static_cast<std::uint32_t>(state.size());
  writer.finish(header);
}

std::uint64_t loam_world::snapshot_size() {
  SnapshotWriter counter(SnapshotWriter::Mode::count);
  write(counter);
  return counter.bytes();
}

std::uint64_t loam_world::save(std::byte *memory, std::uint64_t capacity) {
  SnapshotWriter bound(SnapshotWriter::Mode::bound);
  write(bound);
  if (capacity < bound.bytes()) {
    const std::uint64_t needed = snapshot_size();
    if (capacity < needed)
      throw Error(LOAM_ERROR_CAPACITY,
                  format("capacity is %llu bytes; the snapshot takes %llu", static_cast<unsigned long long>(capacity),
                         static_cast<unsigned long long>(needed)));
  }
  SnapshotWriter writer(SnapshotWriter::Mode::write, memory);
  write(writer);
  return writer.bytes();
}

// ---------------------------------------------------------------------------------------------------- restoring ---

void loam_world::check_state(const SnapshotReader &snapshot, const std::vector<StateSection> &state,
                             std::uint64_t next_id) const {
  if (snapshot.particles() > def_.particle_capacity) invalid_snapshot("has more particles than its capacity");
  const auto own = [&](const SnapshotReader::Section &section) {
    return std::find_if(state.begin(), state.end(),
                        [&](const StateSection &s) { return s.kind == section.kind && s.object == section.object; });
  };
  for (const SnapshotReader::Section &section : snapshot.sections()) {
    const auto mine = own(section);
    if (mine == state.end()) {
      if (!section.is_zero())
        invalid_snapshot(format("has state of kind %u that the world does not hold", unsigned(section.kind)));
    } else if (section.count != mine->count || section.columns.size() != mine->saved) {
      invalid_snapshot(format("has state of kind %u of another size than the world's", unsigned(section.kind)));
    }
  }
  // What the world holds beyond that may be what no material asks for; otherwise it must be there.
  for (const StateKind kind : {StateKind::positions, StateKind::log_volumes, StateKind::rest_volumes, StateKind::velocities,
                               StateKind::strains, StateKind::ids, StateKind::materials})
    if (snapshot.find(kind, 0) == nullptr) invalid_snapshot(format("lacks state of kind %u", unsigned(kind)));
  for (const StateSection &section : state)
    if (section.object > 0 || section.kind >= StateKind::cloth_positions)
      if (snapshot.find(section.kind, section.object) == nullptr)
        invalid_snapshot(format("lacks state of kind %u", unsigned(section.kind)));

  for (const StateKind kind : {StateKind::collider_vertices, StateKind::collider_targets})
    for (const StateSection &section : state)
      if (section.kind == kind)
        for (const SnapshotReader::Column &axis : snapshot.find(kind, section.object)->columns)
          for (std::uint64_t i = 0; i < section.count; ++i)
            if (!(std::abs(float_of(axis.at(i))) <= 1e8f)) invalid_snapshot("has a collider with a vertex that is nowhere");

  const auto column = [&](StateKind kind, std::size_t c) { return snapshot.find(kind, 0)->columns[c]; };
  const SnapshotReader::Column materials = column(StateKind::materials, 0), ids = column(StateKind::ids, 0),
                               volumes = column(StateKind::rest_volumes, 0), masses = column(StateKind::velocities, 3);
  for (std::uint64_t i = 0; i < snapshot.particles(); ++i) {
    const std::uint32_t material = materials.at(i);
    if (material >= materials_.size() || materials_.at_index(material) == nullptr)
      invalid_snapshot("has a particle of a material that is not there");
    if (ids.at(i) >= next_id) invalid_snapshot("has a particle with an id that was never given out");
    const float volume = float_of(volumes.at(i)), inverse_mass = float_of(masses.at(i));
    if (!(volume > 0.0f && std::isfinite(volume))) invalid_snapshot("has a particle without a volume");
    if (!(inverse_mass >= 0.0f && std::isfinite(inverse_mass))) invalid_snapshot("has a particle without a mass");
  }
}

void loam_world::restore(const std::byte *memory, std::uint64_t bytes) {
  check_unmapped();
  if (cloths_.any_mapped()) throw Error(LOAM_ERROR_IN_USE, "a cloth's buffers are mapped; call loam_cloth_unmap first");
  SnapshotReader snapshot(memory, bytes);
  Moving moving = this->moving();
  FieldReader fields(snapshot);
  exchange(fields, moving);
  snapshot.end_fields();
  try {
    check(moving);
  } catch (const Error &error) {
    if (error.status() != LOAM_ERROR_INVALID_ARGUMENT) throw;
    invalid_snapshot(std::string("is damaged: ") + error.what());
  }
  const std::uint64_t particles = snapshot.particles();
  std::vector<StateSection> state = backend_->state(std::min<std::uint64_t>(particles, def_.particle_capacity));
  cloths_.list_state(backend_->cloth(), moving.cloths, state);
  list_vertices(state);
  check_state(snapshot, state, moving.next_id);

  // Memory may be refused up to here and in these.
  std::vector<std::uint64_t> counts(materials_.size()), before(materials_.size());
  const SnapshotReader::Column &materials = snapshot.find(StateKind::materials, 0)->columns[0];
  for (std::uint64_t i = 0; i < particles; ++i) ++counts[materials.at(i)];
  const auto set_counts = [&](const std::vector<std::uint64_t> &now) {
    for (std::size_t i = 0; i < materials_.size(); ++i)
      if (Material *m = materials_.at_index(i); m != nullptr) m->particles = now[i];
  };
  for (std::size_t i = 0; i < materials_.size(); ++i)
    if (const Material *m = materials_.at_index(i); m != nullptr) before[i] = m->particles;
  const std::vector<ClothScene::Changes> cloths_before = this->moving().cloths;
  cloths_.set_changes(backend_->cloth(), moving.cloths);
  try {
    set_counts(counts);
    if (counts != before) send_materials();
  } catch (...) {
    set_counts(before);
    send_materials();
    cloths_.set_changes(backend_->cloth(), cloths_before);
    throw;
  }

  set_accuracy(moving.accuracy);
  input_.gravity = moving.gravity;
  next_id_ = moving.next_id;
  input_.wake = moving.wake != 0;
  dropped_ = moving.dropped;
  for (std::size_t i = 0; i < emitters_.slot_count(); ++i)
    if (Emitter *e = emitters_.at_slot(i); e != nullptr) e->set_state(moving.emitters[i]);
  for (std::size_t i = 0; i < fields_.slot_count(); ++i)
    if (FieldScene::Field *f = fields_.at_slot(i); f != nullptr) f->changes = moving.fields[i];
  for (std::size_t i = 0; i < killers_.slot_count(); ++i)
    if (KillerScene::Killer *k = killers_.at_slot(i); k != nullptr) {
      k->view.pose = moving.killers[i].pose;
      k->total = moving.killers[i].total;
      k->killed.clear();
    }
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (Collider *c = colliders_.at_index(i); c != nullptr) {
      c->pose = moving.colliders[i].pose;
      c->target = moving.colliders[i].target;
    }
  constexpr std::size_t chunk_words = 8192;
  std::uint32_t words[chunk_words] = {};
  for (const StateSection &section : state) {
    const SnapshotReader::Section *saved = snapshot.find(section.kind, section.object);
    const std::size_t chunk = chunk_words / section.stride;
    for (std::uint64_t first = 0; first < section.count; first += chunk) {
      const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(chunk, section.count - first));
      if (section.saved < section.stride) backend_->read_state(section, first, count, words);
      for (std::size_t c = 0; c < section.saved; ++c)
        for (std::size_t i = 0; i < count; ++i)
          words[i * section.stride + c] = saved != nullptr ? saved->columns[c].at(first + i) : 0;
      backend_->write_state(section, first, count, words);
    }
  }
  backend_->adopt_state(particles);
}
