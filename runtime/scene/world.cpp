#include "scene/world.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "cpu/kernel_table.h"
#include "scene/checks.h"
#include "scene/collider_shape.h"
#include "scene/fingerprint.h"
#include "scene/material.h"
#include "scene/pose.h"
#include "scene/sampling.h"

namespace loam {

namespace {

// Tags the ids of a world, so that one world's id is recognised as foreign by another. Never 0.
std::uint16_t next_tag() {
  static std::atomic<std::uint32_t> counter{0};
  return static_cast<std::uint16_t>(1 + counter.fetch_add(1, std::memory_order_relaxed) % SlotTable<int>::greatest_tag);
}

void check_hooks(const loam_world_def &def) {
  if ((def.allocator.allocate == nullptr) != (def.allocator.release == nullptr))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "allocator has only one of allocate and release; give both or neither");
  if ((def.job_system.enqueue == nullptr) != (def.job_system.finish == nullptr))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "job_system has only one of enqueue and finish; give both or neither");
}

ContactLaw make_contact_law(float friction, float restitution, float stick) {
  check_range("friction", static_cast<double>(friction), 0, 100);
  check_range("restitution", static_cast<double>(restitution), 0, 1);
  check_range("stick", static_cast<double>(stick), 0, 1e9);
  return {friction, restitution, stick};
}

} // namespace

loam_world_def default_world() {
  loam_world_def def = {};
  def.struct_size = sizeof def;
  def.backend = LOAM_BACKEND_AUTO;
  def.gravity[1] = -9.81f;
  def.kernel_radius = 0.01f;
  def.substeps = 16;
  def.iterations = 5;
  def.solver = LOAM_SOLVER_GAUSS_SEIDEL;
  def.plasticity = LOAM_PLASTICITY_IMPLICIT;
  def.velocity_smoothing = 20;
  def.minimum_distance = 0.75f;
  def.gradient_cutoff = 0.2f;
  def.particle_capacity = 65536;
  def.multiplier = LOAM_MULTIPLIER_PROJECTED_TENSOR;
  def.zero_energy_stiffness = 10;
  def.sleep_delay = 0.5f;
  return def;
}

void check_world_def(const loam_world_def &def) {
  check_choice("backend", def.backend, LOAM_BACKEND_CUDA);
  check_vector("gravity", def.gravity, 1e6);
  check_range("kernel_radius", static_cast<double>(def.kernel_radius), static_cast<double>(1e-6f), 1e6);
  check_range("substeps", def.substeps, 1, 10000);
  check_range("iterations", def.iterations, 1, 1000);
  check_choice("solver", def.solver, LOAM_SOLVER_JACOBI);
  check_choice("plasticity", def.plasticity, LOAM_PLASTICITY_SEMI_IMPLICIT);
  check_range("velocity_smoothing", static_cast<double>(def.velocity_smoothing), 0, 1e4);
  check_range("minimum_distance", static_cast<double>(def.minimum_distance), 0, 1);
  check_range("gradient_cutoff", static_cast<double>(def.gradient_cutoff), static_cast<double>(0.01f), 1);
  check_range("thread_count", def.thread_count, 0, 256);
  check_choice("instruction_set", def.instruction_set, LOAM_INSTRUCTION_SET_AVX512);
  check_range("particle_capacity", static_cast<double>(def.particle_capacity), 1, 268435456);
  check_hooks(def);
  check_choice("multiplier", def.multiplier, LOAM_MULTIPLIER_SCALAR);
  check_range("zero_energy_stiffness", static_cast<double>(def.zero_energy_stiffness), 0, 100);
  check_range("sleep_speed", static_cast<double>(def.sleep_speed), 0, 1e3);
  check_range("sleep_delay", static_cast<double>(def.sleep_delay), static_cast<double>(0.01f), 1e3);
  check_choice("warm_start", def.warm_start, 1);
}

} // namespace loam

using namespace loam;

loam_world::loam_world(const loam_world_def &def)
    : def_(def), tag_(next_tag()), materials_(IdKind::material, "material", tag_, 4096),
      colliders_(IdKind::collider, "collider", tag_, 4096), cloths_(tag_, 0.5f * def.kernel_radius),
      emitters_(tag_, next_id_), fields_(tag_, def.kernel_radius), killers_(tag_) {
  execution_ = {def.allocator, def.job_system, def.thread_count, def.instruction_set};
  if (execution_.instruction_set == LOAM_INSTRUCTION_SET_AUTO) execution_.instruction_set = best_instruction_set();
  if (kernel_table(execution_.instruction_set) == nullptr)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("instruction_set is %s (%u), which this machine does not have",
                       instruction_set_name(execution_.instruction_set), execution_.instruction_set));
  SolverSettings settings = {def.kernel_radius,
                             def.gradient_cutoff,
                             def.minimum_distance,
                             def.velocity_smoothing,
                             def.solver == LOAM_SOLVER_JACOBI,
                             def.plasticity == LOAM_PLASTICITY_SEMI_IMPLICIT,
                             def.multiplier == LOAM_MULTIPLIER_PROJECTED_TENSOR,
                             def.zero_energy_stiffness,
                             def.particle_capacity,
                             def.pair_capacity};
  settings.sleep_speed = def.sleep_speed;
  settings.sleep_delay = def.sleep_delay;
  settings.warm_start = def.warm_start != 0;
  if (def.backend == LOAM_BACKEND_CUDA || (def.backend == LOAM_BACKEND_AUTO && cuda_available())) {
    backend_ = make_cuda_backend(settings, execution_);
    backend_kind_ = LOAM_BACKEND_CUDA;
  } else {
    backend_ = make_cpu_backend(settings, execution_);
  }
  accuracy_.substeps = def.substeps;
  accuracy_.iterations = def.iterations;
  input_.gravity = {def.gravity[0], def.gravity[1], def.gravity[2]};
}

void loam_world::log(std::int32_t level, const char *text) const {
  if (def_.log.message != nullptr) def_.log.message(def_.log.user, level, text);
}

void loam_world::check_unmapped() const {
  if (mapped_) throw Error(LOAM_ERROR_IN_USE, "the particle buffers are mapped; call loam_particles_unmap first");
}

// ------------------------------------------------------------------------------------------------------- the whole ---

void loam_world::shift_origin(const float offset[3]) {
  check_vector("offset", offset, 1e6 * static_cast<double>(def_.kernel_radius));
  check_unmapped();
  if (cloths_.any_mapped()) throw Error(LOAM_ERROR_IN_USE, "a cloth's buffers are mapped; call loam_cloth_unmap first");
  const Vec3<float> by = {offset[0], offset[1], offset[2]};
  backend_->shift_origin(by);
  cloths_.shift_origin(backend_->cloth(), by);
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (Collider *c = colliders_.at_index(i); c != nullptr) {
      c->pose.position = c->pose.position - by;
      c->target.position = c->target.position - by;
    }
  emitters_.for_each([&](Emitter &emitter) { emitter.shift_origin(by); });
  fields_.shift_origin(by);
  killers_.shift_origin(by);
}

void loam_world::set_gravity(const float gravity[3]) {
  check_vector("gravity", gravity, 1e6);
  input_.gravity = {gravity[0], gravity[1], gravity[2]};
  input_.wake = true;
}

// ----------------------------------------------------------------------------------------------------- materials ---

void loam_world::send_materials() {
  std::vector<SolverMaterial> list;
  std::size_t needed = 0; // behind the last one that exists, no room is asked for: removing a material must not need memory
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    const Material *m = materials_.at_index(i);
    if (m == nullptr) {
      list.push_back({Elastic{}, "", false});
    } else {
      list.push_back({make_law(m->def, static_cast<double>(m->stiffness_share)),
                      m->def.name,
                      m->particles > 0 || m->emitters > 0,
                      {},
                      m->def.density});
      needed = list.size();
    }
  }
  list.erase(list.begin() + static_cast<std::ptrdiff_t>(needed), list.end());
  for (const Contact &contact : contacts_)
    for (const auto &[own, other] : {std::pair(contact.a, contact.b), std::pair(contact.b, contact.a)}) {
      list[own].meetings.resize(list.size(), -1.0f);
      list[own].meetings[other] = contact.friction;
    }
  backend_->set_materials(list);
}

void loam_world::set_meeting(loam_material_id a, loam_material_id b, std::uint32_t meeting, float friction) {
  const std::size_t first = materials_.index_of(a, "a"), second = materials_.index_of(b, "b");
  if (first == second)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "a and b are the same material; it always shares with itself");
  check_choice("meeting", meeting, LOAM_MEETING_CONTACT);
  if (meeting == LOAM_MEETING_CONTACT) check_range("friction", static_cast<double>(friction), 0, 100);
  check_unmapped();
  const std::vector<Contact> before = contacts_;
  const auto [low, high] = std::minmax(first, second);
  std::erase_if(contacts_, [low = low, high = high](const Contact &c) { return c.a == low && c.b == high; });
  if (meeting == LOAM_MEETING_CONTACT) contacts_.push_back({low, high, friction});
  try {
    send_materials();
    input_.wake = true;
  } catch (...) {
    contacts_ = before;
    throw;
  }
}

loam_material_id loam_world::create_material(const loam_material_def &def) {
  check_material(def);
  check_unmapped();
  const loam_material_id id = materials_.add({def});
  try {
    send_materials();
  } catch (...) {
    materials_.remove(id, "material");
    throw;
  }
  return id;
}

void loam_world::set_material(loam_material_id id, const loam_material_def &def) {
  Material &m = materials_.at(id, "material");
  check_material(def);
  check_unmapped();
  if (m.emitters > 0 && (def.law != m.def.law || def.density != m.def.density))
    throw Error(LOAM_ERROR_IN_USE,
                format("law is %u and density is %g; material \"%s\" has %d emitters, so they must stay %u and %g", def.law,
                       static_cast<double>(def.density), m.def.name, m.emitters, m.def.law,
                       static_cast<double>(m.def.density)));
  const auto particles = static_cast<unsigned long long>(m.particles);
  if (particles > 0 && def.law != m.def.law)
    throw Error(LOAM_ERROR_IN_USE, format("law is %u; material \"%s\" has %llu particles of law %u, which must stay",
                                          def.law, m.def.name, particles, m.def.law));
  if (particles > 0 && def.density != m.def.density)
    throw Error(LOAM_ERROR_IN_USE,
                format("density is %g; material \"%s\" has %llu particles that were made with %g, which must stay",
                       static_cast<double>(def.density), m.def.name, particles, static_cast<double>(m.def.density)));
  const Material before = m;
  m.def = def;
  try {
    send_materials();
    input_.wake = true;
  } catch (...) {
    m = before;
    throw;
  }
}

void loam_world::destroy_material(loam_material_id id) {
  const Material &m = materials_.at(id, "material");
  if (m.emitters > 0) throw Error(LOAM_ERROR_IN_USE, format("material \"%s\" has %d emitters", m.def.name, m.emitters));
  if (m.particles > 0)
    throw Error(LOAM_ERROR_IN_USE,
                format("material \"%s\" has %llu particles", m.def.name, static_cast<unsigned long long>(m.particles)));
  const std::size_t slot = materials_.index_of(id, "material");
  if (killers_.any_of_material(static_cast<int>(slot)))
    throw Error(LOAM_ERROR_IN_USE, format("material \"%s\" has a killer of its own", m.def.name));
  std::erase_if(contacts_, [slot](const Contact &c) { return c.a == slot || c.b == slot; });
  for (std::size_t i = 0; i < colliders_.size(); ++i)
    if (Collider *c = colliders_.at_index(i); c != nullptr)
      std::erase_if(c->pairs, [slot](const PairLaw &pair) { return pair.material == slot; });
  materials_.remove(id, "material");
  send_materials();
}

const loam_material_def &loam_world::material(loam_material_id id) const { return materials_.at(id, "material").def; }

// ----------------------------------------------------------------------------------------------------- colliders ---

loam_collider_id loam_world::create_collider(const loam_collider_def &def) {
  check_reserved("reserved", def.reserved);
  check_choice("reaction", def.reaction, 1);
  check_choice("deforms", def.deforms, 1);
  check_reserved("reserved_2", def.reserved_2);
  if (def.deforms == 1 && def.kind != LOAM_COLLIDER_MESH)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("deforms is 1 and kind is %u; only a MESH (%u) deforms", def.kind,
                                                    static_cast<unsigned>(LOAM_COLLIDER_MESH)));
  Collider collider;
  collider.asks_reaction = def.reaction == 1;
  collider.law = make_contact_law(def.friction, def.restitution, def.stick);
  collider.pose = collider.target = make_pose(def.position, def.rotation);
  (void)colliders_.next_id(); // room for one more
  collider.shape = backend_->add_shape(make_collider_shape(def, collider.report));
  collider.report.struct_size = sizeof collider.report;
  input_.wake = true;
  collider.def = def;
  collider.def.mesh = {};
  collider.def.grid = {};
  // Once checked, they can be read.
  const bool has_mesh = def.kind == LOAM_COLLIDER_MESH || def.kind == LOAM_COLLIDER_HULL;
  collider.mesh = has_mesh ? mesh_fingerprint(def.mesh) : 0;
  collider.vertex_count = def.deforms == 1 ? def.mesh.vertex_count : 0;
  collider.grid = def.kind == LOAM_COLLIDER_GRID ? grid_fingerprint(def.grid) : 0;
  return colliders_.add(collider);
}

void loam_world::destroy_collider(loam_collider_id id) {
  cloths_.check_unattached(static_cast<int>(colliders_.index_of(id, "collider")));
  backend_->remove_shape(colliders_.at(id, "collider").shape);
  colliders_.remove(id, "collider");
  input_.wake = true;
}

void loam_world::pose_collider(loam_collider_id id, const float position[3], const float rotation[4], bool at_once) {
  Collider &collider = colliders_.at(id, "collider");
  collider.target = make_pose(position, rotation);
  if (!at_once) return;
  collider.pose = collider.target;
  input_.wake = true;
}

void loam_world::move_vertices(loam_collider_id id, const float *positions, std::uint32_t vertex_count, bool at_once) {
  const Collider &collider = colliders_.at(id, "collider");
  if (collider.def.deforms == 0)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "collider was made with deforms 0: its vertices stay");
  if (vertex_count != collider.vertex_count)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("vertex_count is %u; the collider's mesh has %u vertices", vertex_count, collider.vertex_count));
  check_vertices(positions, vertex_count, "positions");
  backend_->move_vertices(collider.shape, positions, at_once);
  if (at_once) input_.wake = true;
}

void loam_world::set_contact(loam_collider_id id, loam_material_id material, const loam_collider_contact *contact) {
  Collider &collider = colliders_.at(id, "collider");
  if (material == 0) {
    if (contact == nullptr)
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, "contact is null with material 0: a collider has a contact of its own");
    collider.law = make_contact_law(contact->friction, contact->restitution, contact->stick);
    return;
  }
  const auto slot = static_cast<std::uint32_t>(materials_.index_of(material, "material"));
  const auto of_it = [slot](const PairLaw &pair) { return pair.material == slot; };
  if (contact == nullptr) {
    std::erase_if(collider.pairs, of_it);
    return;
  }
  const ContactLaw law = make_contact_law(contact->friction, contact->restitution, contact->stick);
  const auto found = std::find_if(collider.pairs.begin(), collider.pairs.end(), of_it);
  if (found != collider.pairs.end())
    found->law = law;
  else
    collider.pairs.push_back({slot, law});
}

loam_collider_contact loam_world::contact(loam_collider_id id, loam_material_id material) const {
  const Collider &collider = colliders_.at(id, "collider");
  ContactLaw law = collider.law;
  if (material != 0) {
    const std::size_t slot = materials_.index_of(material, "material");
    for (const PairLaw &pair : collider.pairs)
      if (pair.material == slot) law = pair.law;
  }
  return {sizeof(loam_collider_contact), law.friction, law.restitution, law.stick};
}

loam_collider_reaction loam_world::collider_reaction(loam_collider_id id) const {
  const Collider &collider = colliders_.at(id, "collider");
  if (!collider.asks_reaction)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "collider was made with reaction 0: nothing is kept of what acts on it");
  const ColliderReaction &r = collider.reaction;
  return {sizeof(loam_collider_reaction),
          0,
          {r.impulse[0], r.impulse[1], r.impulse[2]},
          {r.torque[0], r.torque[1], r.torque[2]},
          r.contacts};
}

loam_collider_report loam_world::collider_report(loam_collider_id id) const { return colliders_.at(id, "collider").report; }

// --------------------------------------------------------------------------------------------------------- cloth ---

void loam_world::attach_cloth(loam_cloth_id id, const loam_cloth_attachment_def &def) {
  int slot = -1;
  Pose pose{};
  if (def.collider != 0) {
    slot = static_cast<int>(colliders_.index_of(def.collider, "collider"));
    pose = colliders_.at(def.collider, "collider").pose;
  }
  cloths_.attach(backend_->cloth(), id, def, slot, pose);
}

// ------------------------------------------------------------------------------------------------------ emitters ---

loam_emitter_id loam_world::create_emitter(const loam_emitter_def &def) {
  check_unmapped();
  Material &m = materials_.at(def.material, "material");
  const loam_emitter_id id = emitters_.add(Emitter(def, def_.kernel_radius, m.def.density, def_.particle_capacity));
  ++m.emitters;
  try {
    send_materials();
  } catch (...) {
    --m.emitters;
    emitters_.remove(id);
    throw;
  }
  return id;
}

void loam_world::destroy_emitter(loam_emitter_id id) {
  check_unmapped();
  struct Hand final : ParticleSink {
    explicit Hand(Backend &of) : backend(of) {}
    std::uint64_t room() const override { return 0; }
    void enter(const Layer &) override {}
    void release(const Release &release) override { backend.release_particles(release); }
    void drop(std::uint64_t) override {}
    Backend &backend;
  } hand(*backend_);
  Emitter &emitter = emitters_.at(id);
  emitter.let_go(hand);
  --materials_.at(emitter.material(), "material").emitters;
  emitters_.remove(id);
  send_materials();
}

// --------------------------------------------------------------------------------------------- fields and killers ---

loam_field_id loam_world::create_field(const loam_field_def &def) {
  const loam_field_id id = fields_.create(def);
  input_.wake = true;
  return id;
}

void loam_world::set_field(loam_field_id id, const loam_field_def &def) {
  fields_.set(id, def);
  input_.wake = true;
}

void loam_world::destroy_field(loam_field_id id) {
  fields_.destroy(id);
  input_.wake = true;
}

int loam_world::killer_material(const loam_killer_def &def) const {
  return def.material == 0 ? -1 : static_cast<int>(materials_.index_of(def.material, "material"));
}

loam_killer_id loam_world::create_killer(const loam_killer_def &def) {
  check_unmapped();
  KillerScene::check(def);
  const int material = killer_material(def);
  const loam_killer_id id = killers_.create(def, material);
  try {
    backend_->keep_ages(killers_.any_of_age());
  } catch (...) {
    killers_.destroy(id);
    throw;
  }
  return id;
}

void loam_world::set_killer(loam_killer_id id, const loam_killer_def &def) {
  check_unmapped();
  const KillerScene::Killer &killer = killers_.at(id);
  KillerScene::check(def);
  const int material = killer_material(def);
  backend_->keep_ages(def.kind == LOAM_KILLER_AGE || killers_.any_of_age(&killer));
  killers_.set(id, def, material);
}

void loam_world::destroy_killer(loam_killer_id id) {
  check_unmapped();
  killers_.destroy(id);
  backend_->keep_ages(killers_.any_of_age());
}

// ----------------------------------------------------------------------------------------------------- particles ---

void loam_world::check_room(std::uint64_t count) const {
  const std::uint64_t have = backend_->particle_count(), want = have + count;
  if (want > def_.particle_capacity || want < count) // the sum may wrap around
    throw Error(LOAM_ERROR_CAPACITY, format("%llu particles would be needed; particle_capacity is %llu",
                                            static_cast<unsigned long long>(want < count ? count : want),
                                            static_cast<unsigned long long>(def_.particle_capacity)));
  if (next_id_ + count > 0xffffffffu)
    throw Error(LOAM_ERROR_CAPACITY,
                format("%llu particles were made in this world; there are ids for 4294967295, and they do not come back",
                       static_cast<unsigned long long>(next_id_)));
}

void loam_world::add_particles(loam_material_id material, const char *argument, NewParticles particles, bool pinned) {
  Material &m = materials_.at(material, argument);
  check_room(particles.count);
  particles.material = static_cast<std::uint32_t>(material & 0xffffffffu);
  particles.first_id = static_cast<std::uint32_t>(next_id_);
  particles.inverse_mass = pinned ? 0.0f : 1.0f / (m.def.density * particles.volume);
  if (!pinned && !(particles.inverse_mass > 0.0f && particles.inverse_mass <= 1e30f))
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("a particle of %g m^3 and %g kg/m^3 has a mass that single precision cannot hold",
                       static_cast<double>(particles.volume), static_cast<double>(m.def.density)));
  if (particles.count == 0) return;
  const bool first = m.particles == 0;
  m.particles += particles.count;
  try {
    if (first) send_materials();
    backend_->add_particles(particles);
  } catch (...) {
    m.particles -= particles.count;
    if (first) send_materials(); // as they were: there is room
    throw;
  }
  next_id_ += particles.count;
}

std::uint64_t loam_world::fill(const loam_fill_def &def) {
  check_unmapped();
  (void)materials_.at(def.material, "material");
  const FillResult result = loam::fill(def, def_.kernel_radius, def_.particle_capacity - backend_->particle_count());
  NewParticles particles = {};
  particles.volume = static_cast<float>(result.volume_per_particle);
  particles.count = result.positions.size();
  particles.positions = particles.count > 0 ? &result.positions[0].x : nullptr;
  particles.velocity = {def.velocity[0], def.velocity[1], def.velocity[2]};
  if (particles.count > 0) add_particles(def.material, "material", particles, false);
  return particles.count;
}

void loam_world::check_motion(std::uint64_t count, const float *positions, const float *velocities) const {
  const double r = static_cast<double>(def_.kernel_radius);
  for (std::uint64_t i = 0; i < 3 * count; ++i) {
    const auto part = static_cast<unsigned long long>(i / 3);
    const char axis = "xyz"[i % 3];
    if (positions != nullptr && !(std::abs(static_cast<double>(positions[i])) <= 1e6 * r))
      throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                  format("positions[%llu].%c is %g; it must be finite and within 1e6 kernel radii (%g m) of the origin",
                         part, axis, static_cast<double>(positions[i]), 1e6 * r));
    if (velocities != nullptr && !(std::abs(static_cast<double>(velocities[i])) <= 1e9))
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("velocities[%llu].%c is %g; it must be finite and at most 1e9", part,
                                                      axis, static_cast<double>(velocities[i])));
  }
}

std::uint32_t loam_world::add(const loam_particles_def &def) {
  check_unmapped();
  (void)materials_.at(def.material, "material");
  check_reserved("reserved", def.reserved);
  check_choice("pinned", def.pinned, 1);
  check_room(def.count); // before the arrays are read
  const double r = static_cast<double>(def_.kernel_radius);
  if (def.count > 0) check_pointer(def.positions, "positions");
  if (def.volume != 0.0f) check_range("volume", static_cast<double>(def.volume), 1e-24, 1e18);
  check_motion(def.count, def.positions, def.velocities);
  NewParticles particles = {};
  particles.volume = def.volume != 0.0f ? def.volume : static_cast<float>(r * r * r);
  particles.count = def.count;
  particles.positions = def.positions;
  particles.velocities = def.velocities;
  const auto first = static_cast<std::uint32_t>(next_id_);
  add_particles(def.material, "material", particles, def.pinned == 1);
  return first;
}

void loam_world::remove_particles(const std::uint32_t *ids, std::uint64_t count) {
  check_unmapped();
  if (count > 0) check_pointer(ids, "ids");
  check_named(count);
  const std::vector<std::uint64_t> removed = backend_->remove_particles(ids, count);
  input_.wake = true; // who lay on them falls
  bool changed = false;
  for (std::size_t i = 0; i < removed.size(); ++i)
    if (Material *m = removed[i] > 0 ? materials_.at_index(i) : nullptr; m != nullptr) {
      m->particles -= removed[i];
      changed = changed || m->particles == 0;
    }
  if (changed) send_materials(); // fewer in use: needs no memory
}

void loam_world::move_particles(const std::uint32_t *ids, std::uint64_t count, const float *positions,
                                const float *velocities) {
  check_unmapped();
  if (count > 0) check_pointer(ids, "ids");
  if (count > 0 && positions == nullptr && velocities == nullptr)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "positions and velocities are null; give one of them or both");
  check_named(count);
  check_motion(count, positions, velocities);
  backend_->set_motion({ids, positions, velocities, count});
  input_.wake = true;
}

// Before the arrays are read: each particle may be named once.
void loam_world::check_named(std::uint64_t count) const {
  if (count > backend_->particle_count())
    throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                format("count is %llu; the world has %llu particles", static_cast<unsigned long long>(count),
                       static_cast<unsigned long long>(backend_->particle_count())));
}

void loam_world::map(loam_particle_view &view) {
  if (mapped_) throw Error(LOAM_ERROR_IN_USE, "the particle buffers are mapped already");
  backend_->map(view);
  mapped_ = true;
}

void loam_world::unmap() {
  if (!mapped_) throw Error(LOAM_ERROR_INVALID_ARGUMENT, "the particle buffers are not mapped");
  mapped_ = false;
}
