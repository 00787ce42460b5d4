// The cloths of a solver, over any executor: their state, and their stages of a substep. A world without cloth has none of them.
//
// A substep of a cloth, beside that of the particles in substep.h:
//
//   find_contacts   planes that hold vertices back, before anything has changed: memory may be refused
//   prepare         forces; edges and offsets of all constraints; where attachments are going
//   iterate         hinges, membrane, threads, attachments; contacts
//   finish          the greatest speed, contacts once more and swept, the move
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "kernels/cloth/bending.h"
#include "kernels/cloth/membrane.h"
#include "kernels/cloth/threads.h"
#include "kernels/cloth/vertices.h"
#include "kernels/contact/find_contacts.h"
#include "kernels/contact/reaction.h"
#include "kernels/contact/solve_contacts.h"
#include "kernels/contact/sweep_contacts.h"
#include "kernels/integration/integrate.h"
#include "schedule/schedule.h"
#include "solver/cloth_backend.h"
#include "solver/cloth_particles.h"
#include "solver/cloth_self_contact.h"
#include "solver/cloth_topology.h"
#include "solver/collider_shapes.h"

namespace loam {

template <class Executor> class ClothSolver final : public ClothBackend {
public:
  // The executor's sort has room for the particles.
  ClothSolver(Executor &executor, std::size_t particle_capacity)
      : executor_(executor), particle_capacity_(particle_capacity) {}

  int add(const SolverCloth &description) override;
  void remove(int cloth) override;
  void set_attachments(int cloth, const std::vector<SolverAttachment> &attachments) override;
  void set_wind(int cloth, const ClothWind &wind) override { at(cloth).wind = wind; }
  std::uint32_t vertex_count(int cloth) const override {
    return static_cast<std::uint32_t>(cloths_[static_cast<std::size_t>(cloth)].vertex_count);
  }
  std::vector<Row> positions(int cloth) override;
  std::vector<TornCorner> torn_corners(int cloth) const override;
  bool could_be_torn(int cloth, const std::vector<TornCorner> &torn) const override;
  void set_torn_corners(int cloth, const std::vector<TornCorner> &torn) override;
  void list_state(int cloth, const std::vector<TornCorner> &torn, std::uint32_t object,
                  std::vector<StateSection> &list) override;
  void map(int cloth, loam_cloth_view &view) override;

  void shift_origin(const Vec3<float> &by) {
    for_each_cloth([&](Cloth &cloth) {
      executor_.for_each(cloth.vertex_count, ShiftPositions{cloth.positions.data(), by});
    });
  }

  bool empty() const { return in_use_ == 0; }
  // Is there cloth that collides with itself?
  bool any_self_contact() const { return self_contact_.any(); }
  std::uint64_t bytes() const;
  // `hash` with the cloths' state in it; as it is where there are none.
  std::uint64_t hash(std::uint64_t hash);
  float least_inverse_mass(); // of a vertex that can move; LeastInverseMass::identity() where none can

  // Calls f(vertex count, positions, velocities) for each cloth.
  template <class F> void for_each_sheet(F &&f) {
    for_each_cloth([&](Cloth &cloth) { f(cloth.vertex_count, cloth.positions.data(), cloth.velocities.data()); });
  }

  // What a substep needs to know.
  struct Substep {
    float seconds;
    Vec3<float> gravity;
    const ColliderView *colliders;
    int collider_count;
    float collider_motion; // the most that a point of any collider moves
    bool deforms;          // is there a collider whose vertices move?
    ClothParticles particles;
  };
  void find_contacts(const Substep &substep);
  void prepare(const Substep &substep, int *speed_limited);
  void solve(const Substep &substep);
  void solve_contacts(const Substep &substep);
  void solve_particle_contacts(const Substep &substep);
  void solve_self_contacts(const Substep &substep) { self_contact_.solve(executor_, substep.seconds); }
  // After it a cloth's velocities stay.
  void finish(const Substep &substep, int *speed_limited, Reactions reactions);
  // Ways that are not those of velocities push nothing back.
  void sweep_particles(const Substep &substep, bool pushes_back = true);
  void advance(const Substep &substep);
  // Splits vertices of what is strained too much. Between substeps; the last was so long.
  void tear(float seconds);
  // Vertices that were split, in the last step so far; a new step begins with 0.
  std::uint64_t tear_count() const { return tears_; }
  void begin_step() { tears_ = 0; }
  // Of triangles, at the start of the last substep.
  double greatest_stretch();
  // Vertices that there may be.
  std::size_t row_count() const;
  std::uint64_t constraint_count() const { return constraints_; }
  std::uint64_t vertex_count() const { return vertices_; }
  std::uint64_t contact_count() const;
  std::uint64_t particle_contact_count() const;
  std::uint64_t self_contact_count() const { return static_cast<std::uint64_t>(self_contact_.count()); }
  std::uint64_t self_contact_bytes() const { return self_contact_.bytes(); }

private:
  template <class T> using Array = typename Executor::template Array<T>;

  struct Constraints {
    Array<int> indices;
    Array<float> fields;
    std::vector<int> batches; // where each colour begins; one more entry than colours
    ClothConstraints view() { return {indices.data(), fields.data()}; }
    int batch_count() const { return batches.empty() ? 0 : batches.back(); }
  };
  struct Cloth {
    Array<Row> positions, velocities, normals;
    Array<Row> rest;                      // of cloth that collides with itself
    Array<int> triangles, starts, around; // for normals: the triangles around each vertex
    Constraints membrane, hinges;
    Constraints threads; // batches of threads
    Array<int> thread_starts;
    ClothThreads thread_view() { return {threads.view(), thread_starts.data()}; }
    Array<Attachment> attachments;
    Array<Contact> contacts;
    Array<int> contact_counter;
    ClothParticleContact<Executor> particle_contact;
    std::vector<float> inverse_masses;
    std::vector<SolverAttachment> attached;
    Array<Row> shapes; // of cloth that tears, as the next two
    Array<int> places;
    std::unique_ptr<ClothTopology> topology; // null: it does not
    ClothMaterial material{};
    ClothWind wind{};
    typename ClothParticleContact<Executor>::Sheet sheet() {
      return {positions.data(),
              velocities.data(),
              triangles.data(),
              vertex_count,
              triangle_count,
              material.friction,
              attachment_count + contact_count > 0};
    }
    int spare_vertex = 0; // the first of those that idle lanes work on, one a lane
    int vertex_count = 0, triangle_count = 0, attachment_count = 0, contact_count = 0;
    std::uint64_t constraint_count = 0; // three a triangle, one a hinge
    float reach = 0;                    // the most that a vertex moves in this substep
    bool in_use = false;
  };

  Cloth &at(int cloth) { return cloths_[static_cast<std::size_t>(cloth)]; }
  template <class F> void for_each_cloth(F &&f) {
    for (Cloth &cloth : cloths_)
      if (cloth.in_use) f(cloth);
  }
  template <class T> void copy_in(Array<T> &array, const std::vector<T> &values) {
    array.reserve(std::max<std::size_t>(values.size(), 1));
    executor_.upload(array.data(), values.data(), values.size());
  }
  template <class Field> void interleave(Constraints &result, const ClothConstraintList &list, int spare_vertex);
  void add_threads(Cloth &cloth, const ClothThreadList &list);
  void tear(Cloth &cloth, float seconds);
  // The machine's arrays as the topology says, but for positions and velocities.
  void apply_topology(Cloth &cloth);
  TriangleStrains strains(Cloth &cloth, const Row *positions, const int *triangles, const Row *shapes, const int *places,
                          const float *fields, float seconds) const {
    return {positions, triangles, shapes, places, fields, executor_.constraint_width(), cloth.material.damping / seconds};
  }
  template <class Stage> void for_each_colour(const Constraints &constraints, const Stage &stage) {
    for (std::size_t c = 0; c + 1 < constraints.batches.size(); ++c)
      executor_.for_each_constraint(constraints.batches[c], constraints.batches[c + 1], stage);
  }
  Cloth make_empty() {
    const auto constraints = [&] {
      return Constraints{executor_.template array<int>(), executor_.template array<float>(), {}};
    };
    return {executor_.template array<Row>(),
            executor_.template array<Row>(),
            executor_.template array<Row>(),
            executor_.template array<Row>(),
            executor_.template array<int>(),
            executor_.template array<int>(),
            executor_.template array<int>(),
            constraints(),
            constraints(),
            constraints(),
            executor_.template array<int>(),
            executor_.template array<Attachment>(),
            executor_.template array<Contact>(),
            executor_.template array<int>(),
            ClothParticleContact<Executor>(executor_),
            {},
            {},
            executor_.template array<Row>(),
            executor_.template array<int>(),
            nullptr};
  }

  // After cloth came or went.
  void renew_self_contact() {
    std::vector<typename ClothSelfContact<Executor>::Sheet> sheets;
    for_each_cloth([&](Cloth &c) {
      if (c.material.self_distance > 0.0f)
        sheets.push_back({c.positions.data(), c.velocities.data(), c.rest.data(), c.vertex_count,
                          c.topology != nullptr ? c.topology->most_vertices() : c.vertex_count, c.material.self_distance,
                          c.material.self_friction});
    });
    if (!sheets.empty() || self_contact_.any()) self_contact_.set_sheets(executor_, std::move(sheets), particle_capacity_);
  }

  Executor &executor_;
  std::size_t particle_capacity_;
  std::vector<Cloth> cloths_;
  ClothSelfContact<Executor> self_contact_{executor_};
  int in_use_ = 0;
  std::uint64_t constraints_ = 0, vertices_ = 0, tears_ = 0;
};

// ------------------------------------------------------------------------------------------------ what there is ---

template <class Executor>
template <class Field>
void ClothSolver<Executor>::interleave(Constraints &result, const ClothConstraintList &list, int spare_vertex) {
  const auto width = static_cast<std::size_t>(executor_.constraint_width());
  constexpr std::size_t vertices = Field::vertices, fields = Field::count;
  const std::size_t count = list.indices.size() / vertices, given = count > 0 ? list.fields.size() / count : 0;
  result.batches = {0};
  for (std::size_t c = 0; c + 1 < list.starts.size(); ++c) {
    const auto size = static_cast<std::size_t>(list.starts[c + 1] - list.starts[c]);
    result.batches.push_back(result.batches.back() + static_cast<int>((size + width - 1) / width));
  }
  const auto batches = static_cast<std::size_t>(result.batch_count());
  std::vector<int> indices(batches * vertices * width);
  std::vector<float> values(batches * fields * width);
  for (std::size_t c = 0; c + 1 < list.starts.size(); ++c) {
    const auto first = static_cast<std::size_t>(list.starts[c]), last = static_cast<std::size_t>(list.starts[c + 1]);
    const auto base = static_cast<std::size_t>(result.batches[c]) * width;
    const auto end = static_cast<std::size_t>(result.batches[c + 1]) * width;
    for (std::size_t place = base; place < end; ++place) {
      const std::size_t batch = place / width, lane = place % width, i = first + (place - base);
      for (std::size_t k = 0; k < vertices; ++k)
        indices[(batch * vertices + k) * width + lane] =
            i < last ? list.indices[i * vertices + k] : spare_vertex + static_cast<int>(lane);
      for (std::size_t f = 0; f < given; ++f)
        values[(batch * fields + f) * width + lane] = i < last ? list.fields[i * given + f] : 0.0f;
    }
  }
  copy_in(result.indices, indices);
  copy_in(result.fields, values);
}

template <class Executor> void ClothSolver<Executor>::add_threads(Cloth &cloth, const ClothThreadList &list) {
  const auto width = static_cast<std::size_t>(executor_.constraint_width());
  std::vector<int> starts = {0}, indices;
  std::vector<float> values;
  cloth.threads.batches = {0};
  for (std::size_t c = 0; c + 1 < list.colours.size(); ++c) {
    const auto end = static_cast<std::size_t>(list.colours[c + 1]);
    for (auto first = static_cast<std::size_t>(list.colours[c]); first < end; first += width) {
      // The first is the longest.
      const auto places = static_cast<std::size_t>(list.starts[first + 1] - list.starts[first]);
      const auto base = static_cast<std::size_t>(starts.back());
      starts.push_back(static_cast<int>(base + places));
      indices.resize((base + places) * width);
      values.resize((base + places) * width * LinkField::count);
      for (std::size_t j = 0; j < places; ++j)
        for (std::size_t lane = 0; lane < width; ++lane) {
          // Lanes stay at their last vertex when their thread has ended; those without a thread are at a spare vertex.
          int vertex = cloth.spare_vertex + static_cast<int>(lane);
          float longest = ClothThreadList::no_link, compliance = 1;
          if (const std::size_t thread = first + lane; thread < end) {
            const auto begin = static_cast<std::size_t>(list.starts[thread]),
                       last = static_cast<std::size_t>(list.starts[thread + 1]) - 1;
            const std::size_t at = std::min(begin + j, last);
            vertex = list.vertices[at];
            longest = list.greatest_lengths[at];
            compliance = list.compliances[at];
          }
          indices[(base + j) * width + lane] = vertex;
          values[((base + j) * LinkField::count + LinkField::greatest_length) * width + lane] = longest;
          values[((base + j) * LinkField::count + LinkField::compliance) * width + lane] = compliance;
        }
    }
    cloth.threads.batches.push_back(static_cast<int>(starts.size()) - 1);
  }
  copy_in(cloth.threads.indices, indices);
  copy_in(cloth.threads.fields, values);
  copy_in(cloth.thread_starts, starts);
}

template <class Executor> int ClothSolver<Executor>::add(const SolverCloth &description) {
  const std::size_t n = description.positions.size(), triangles = description.triangles.size() / 3;
  Cloth cloth = make_empty();
  cloth.vertex_count = static_cast<int>(n);
  cloth.triangle_count = static_cast<int>(triangles);
  cloth.material = description.material;
  if (cloth.material.tear_strain > 0.0f) cloth.topology = std::make_unique<ClothTopology>(description);
  const std::size_t most = cloth.topology != nullptr ? static_cast<std::size_t>(cloth.topology->most_vertices()) : n;
  // Spare vertices, one a lane, stay at the origin: their inverse mass is 0.
  cloth.spare_vertex = static_cast<int>(most);
  const std::size_t rows = most + static_cast<std::size_t>(executor_.constraint_width());
  cloth.positions.reserve(rows);
  cloth.velocities.reserve(rows);
  executor_.upload(cloth.positions.data(), description.positions.data(), n);
  executor_.upload(cloth.velocities.data(), description.velocities.data(), n);
  for (const Row &row : description.velocities) cloth.inverse_masses.push_back(row.w);
  copy_in(cloth.triangles, description.triangles);
  cloth.starts.reserve(most + 1);
  std::vector<int> starts(n + 1), around(3 * triangles);
  for (const int v : description.triangles) ++starts[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 0; i < n; ++i) starts[i + 1] += starts[i];
  std::vector<int> next = starts;
  for (std::size_t i = 0; i < 3 * triangles; ++i)
    around[static_cast<std::size_t>(next[static_cast<std::size_t>(description.triangles[i])]++)] = static_cast<int>(i / 3);
  copy_in(cloth.starts, starts);
  copy_in(cloth.around, around);
  interleave<MembraneField>(cloth.membrane, description.membrane, cloth.spare_vertex);
  if (cloth.topology != nullptr) {
    copy_in(cloth.shapes, description.parts.shapes);
    std::vector<int> places(triangles);
    const std::vector<int> &starts_of_colours = description.membrane.starts;
    for (std::size_t c = 0; c + 1 < starts_of_colours.size(); ++c)
      for (int i = starts_of_colours[c]; i < starts_of_colours[c + 1]; ++i)
        places[static_cast<std::size_t>(description.parts.membrane_triangles[static_cast<std::size_t>(i)])] =
            cloth.membrane.batches[c] * executor_.constraint_width() + (i - starts_of_colours[c]);
    copy_in(cloth.places, places);
  }
  if (cloth.material.self_distance > 0.0f) {
    cloth.rest.reserve(most);
    executor_.upload(cloth.rest.data(), description.rest.data(), n);
  }
  interleave<HingeField>(cloth.hinges, description.hinges, cloth.spare_vertex);
  add_threads(cloth, description.threads);
  cloth.contact_counter.reserve(1);
  const std::uint64_t constraint_count = 3 * triangles + description.hinges.indices.size() / 4;
  cloth.constraint_count = constraint_count;
  cloth.in_use = true;
  const auto free = std::find_if(cloths_.begin(), cloths_.end(), [](const Cloth &c) { return !c.in_use; });
  const int index = static_cast<int>(free - cloths_.begin());
  if (free == cloths_.end())
    cloths_.push_back(std::move(cloth));
  else
    *free = std::move(cloth);
  ++in_use_;
  vertices_ += n;
  constraints_ += constraint_count;
  try {
    renew_self_contact();
  } catch (...) {
    remove(index);
    throw;
  }
  return index;
}

template <class Executor> void ClothSolver<Executor>::remove(int index) {
  Cloth &cloth = at(index);
  vertices_ -= static_cast<std::uint64_t>(cloth.vertex_count);
  constraints_ -= cloth.constraint_count;
  cloth = make_empty();
  --in_use_;
  renew_self_contact();
}

template <class Executor>
void ClothSolver<Executor>::set_attachments(int index, const std::vector<SolverAttachment> &attachments) {
  Cloth &cloth = at(index);
  std::vector<Attachment> now;
  for (const SolverAttachment &a : attachments) now.push_back({a.vertex, a.collider, a.point, a.stiffness, {}, {}});
  copy_in(cloth.attachments, now); // may be refused; nothing has changed yet
  const auto set_inverse_mass = [&](int vertex, float inverse_mass) {
    Row *row = cloth.velocities.data() + vertex;
    Row value = executor_.read(row);
    value.w = inverse_mass;
    executor_.upload(row, &value, 1);
  };
  for (const SolverAttachment &a : cloth.attached)
    if (a.stiffness == 0.0f) set_inverse_mass(a.vertex, cloth.inverse_masses[static_cast<std::size_t>(a.vertex)]);
  for (const SolverAttachment &a : attachments)
    if (a.stiffness == 0.0f) set_inverse_mass(a.vertex, 0.0f);
  cloth.attached = attachments;
  cloth.attachment_count = static_cast<int>(attachments.size());
}

template <class Executor> std::vector<Row> ClothSolver<Executor>::positions(int index) {
  Cloth &cloth = at(index);
  std::vector<Row> rows(static_cast<std::size_t>(cloth.vertex_count));
  executor_.download(rows.data(), cloth.positions.data(), rows.size());
  return rows;
}

// --------------------------------------------------------------------------------------------------------- tearing ---

template <class Executor> void ClothSolver<Executor>::tear(float seconds) {
  for_each_cloth([&](Cloth &cloth) {
    if (cloth.topology != nullptr) tear(cloth, seconds);
  });
}

template <class Executor> void ClothSolver<Executor>::tear(Cloth &cloth, float seconds) {
  const float bound = cloth.material.tear_strain;
  const TriangleStrains there = strains(cloth, cloth.positions.data(), cloth.triangles.data(), cloth.shapes.data(),
                                        cloth.places.data(), cloth.membrane.fields.data(), seconds);
  if (!(executor_.reduce(cloth.triangle_count, GreatestStrain{there}) > bound)) return;
  std::vector<Row> now(static_cast<std::size_t>(cloth.vertex_count));
  executor_.download(now.data(), cloth.positions.data(), now.size());
  std::vector<int> places(static_cast<std::size_t>(cloth.triangle_count));
  executor_.download(places.data(), cloth.places.data(), places.size());
  std::vector<float> fields(static_cast<std::size_t>(cloth.membrane.batch_count()) * MembraneField::count *
                            static_cast<std::size_t>(executor_.constraint_width()));
  executor_.download(fields.data(), cloth.membrane.fields.data(), fields.size());
  const TriangleStrains here = strains(cloth, now.data(), cloth.topology->corners().data(), cloth.topology->shapes().data(),
                                       places.data(), fields.data(), seconds);
  std::vector<TriangleStrain> all;
  for (int t = 0; t < cloth.triangle_count; ++t) all.push_back(here.of(t));
  std::vector<int> from;
  if (cloth.topology->tear(now, all, bound, from) == 0) return;
  for (const int v : from) {
    const auto made = cloth.vertex_count++;
    executor_.copy(cloth.positions.data() + made, cloth.positions.data() + v, 1);
    executor_.copy(cloth.velocities.data() + made, cloth.velocities.data() + v, 1);
    if (cloth.rest.capacity() > 0)
      executor_.copy(cloth.rest.data() + made, cloth.rest.data() + cloth.topology->origin(v), 1);
  }
  vertices_ += from.size();
  tears_ += from.size();
  apply_topology(cloth);
}

template <class Executor> void ClothSolver<Executor>::apply_topology(Cloth &cloth) {
  const ClothTopology &topology = *cloth.topology;
  copy_in(cloth.triangles, topology.corners());
  std::vector<int> starts, around;
  topology.find_triangles_around(starts, around);
  copy_in(cloth.starts, starts);
  copy_in(cloth.around, around);
  interleave<MembraneField>(cloth.membrane, topology.membrane(), cloth.spare_vertex);
  interleave<HingeField>(cloth.hinges, topology.hinges(), cloth.spare_vertex);
  add_threads(cloth, topology.threads());
  cloth.inverse_masses = topology.inverse_masses();
  std::vector<Row> velocities(static_cast<std::size_t>(cloth.vertex_count));
  executor_.download(velocities.data(), cloth.velocities.data(), velocities.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i].w = cloth.inverse_masses[i];
  for (const SolverAttachment &a : cloth.attached)
    if (a.stiffness == 0.0f) velocities[static_cast<std::size_t>(a.vertex)].w = 0.0f;
  executor_.upload(cloth.velocities.data(), velocities.data(), velocities.size());
  if (cloth.material.self_distance > 0.0f) renew_self_contact();
}

template <class Executor> std::vector<TornCorner> ClothSolver<Executor>::torn_corners(int index) const {
  const Cloth &cloth = cloths_[static_cast<std::size_t>(index)];
  return cloth.topology != nullptr ? cloth.topology->torn_corners() : std::vector<TornCorner>();
}

template <class Executor> bool ClothSolver<Executor>::could_be_torn(int index, const std::vector<TornCorner> &torn) const {
  const Cloth &cloth = cloths_[static_cast<std::size_t>(index)];
  return cloth.topology != nullptr ? cloth.topology->accepts(torn) : torn.empty();
}

template <class Executor> void ClothSolver<Executor>::set_torn_corners(int index, const std::vector<TornCorner> &torn) {
  Cloth &cloth = at(index);
  if (cloth.topology == nullptr) return;
  ClothTopology &topology = *cloth.topology;
  topology.set_torn_corners(torn);
  vertices_ += static_cast<std::uint64_t>(topology.vertex_count());
  vertices_ -= static_cast<std::uint64_t>(cloth.vertex_count);
  cloth.vertex_count = topology.vertex_count();
  if (cloth.rest.capacity() > 0)
    for (int v = 0; v < cloth.vertex_count; ++v)
      if (topology.origin(v) != v) executor_.copy(cloth.rest.data() + v, cloth.rest.data() + topology.origin(v), 1);
  cloth.attached.clear(); // the caller tells which there are
  apply_topology(cloth);
}

template <class Executor>
void ClothSolver<Executor>::list_state(int index, const std::vector<TornCorner> &torn, std::uint32_t object,
                                       std::vector<StateSection> &list) {
  Cloth &cloth = at(index);
  const auto n =
      static_cast<std::uint64_t>(cloth.topology != nullptr ? cloth.topology->vertex_count(torn) : cloth.vertex_count);
  list.push_back({StateKind::cloth_positions, object, reinterpret_cast<std::byte *>(cloth.positions.data()), 4, 3, n});
  list.push_back({StateKind::cloth_velocities, object, reinterpret_cast<std::byte *>(cloth.velocities.data()), 4, 3, n});
}

template <class Executor> void ClothSolver<Executor>::map(int index, loam_cloth_view &view) {
  Cloth &cloth = at(index);
  cloth.normals.reserve(static_cast<std::size_t>(cloth.vertex_count));
  executor_.session([&] {
    executor_.for_each(cloth.vertex_count, ComputeNormals{cloth.positions.data(), cloth.triangles.data(),
                                                          cloth.starts.data(), cloth.around.data(), cloth.normals.data()});
  });
  view.memory = Executor::memory_kind;
  view.vertex_count = static_cast<std::uint32_t>(cloth.vertex_count);
  view.positions = &cloth.positions.data()->x;
  view.velocities = &cloth.velocities.data()->x;
  view.normals = &cloth.normals.data()->x;
  view.indices = reinterpret_cast<const std::uint32_t *>(cloth.triangles.data());
  view.triangle_count = static_cast<std::uint32_t>(cloth.triangle_count);
}

template <class Executor> std::uint64_t ClothSolver<Executor>::bytes() const {
  std::uint64_t sum = 0;
  for (const Cloth &c : cloths_)
    sum += c.positions.bytes() + c.velocities.bytes() + c.normals.bytes() + c.rest.bytes() + c.triangles.bytes() +
           c.starts.bytes() + c.around.bytes() + c.membrane.indices.bytes() + c.membrane.fields.bytes() +
           c.hinges.indices.bytes() + c.hinges.fields.bytes() + c.threads.indices.bytes() + c.threads.fields.bytes() +
           c.thread_starts.bytes() + c.attachments.bytes() + c.shapes.bytes() + c.places.bytes() + c.contacts.bytes() +
           c.contact_counter.bytes() + c.particle_contact.bytes();
  return sum;
}

template <class Executor> std::uint64_t ClothSolver<Executor>::hash(std::uint64_t hash) {
  executor_.session([&] {
    for_each_cloth([&](Cloth &cloth) {
      hash = StateHash::mix(hash, executor_.reduce(cloth.vertex_count, HashRows{cloth.positions.data()}));
      hash = StateHash::mix(hash, executor_.reduce(cloth.vertex_count, HashRows{cloth.velocities.data()}));
      if (cloth.topology != nullptr)
        for (const TornCorner &c : cloth.topology->torn_corners())
          hash = StateHash::mix(StateHash::mix(hash, static_cast<std::uint64_t>(c.corner)),
                                static_cast<std::uint64_t>(c.vertex));
    });
  });
  return hash;
}

template <class Executor> float ClothSolver<Executor>::least_inverse_mass() {
  float least = LeastInverseMass::identity();
  for_each_cloth([&](Cloth &cloth) {
    least = std::min(least, executor_.reduce(cloth.vertex_count, LeastInverseMass{cloth.velocities.data()}));
  });
  return least;
}

// --------------------------------------------------------------------------------------------------- a substep ---

template <class Executor> void ClothSolver<Executor>::find_contacts(const Substep &s) {
  if (self_contact_.any()) self_contact_.find(executor_, s.seconds);
  ClothParticles particles = s.particles;
  if (particles.count > 0) particles.speed = executor_.reduce(particles.count, GreatestSpeed{particles.velocities});
  for_each_cloth([&](Cloth &cloth) {
    const float greatest = executor_.reduce(cloth.vertex_count, GreatestSpeed{cloth.velocities.data()});
    // Twice as far as the fastest vertex goes, and as a fall from rest goes in a few substeps; nothing of the sort of a grid bounds it.
    cloth.reach = cloth.material.thickness + s.collider_motion +
                  s.seconds * (4.0f * greatest + 4.0f * s.seconds * length(s.gravity) + 2.0f * length(cloth.wind.velocity));
    if (s.particles.count > 0) cloth.reach += s.particles.radius; // what hits it may be that fast
    cloth.contact_count = 0;
    if (s.particles.count > 0)
      cloth.particle_contact.find(executor_, cloth.sheet(), particles, s.seconds);
    else
      cloth.particle_contact.forget(); // those who are gone push no more
    if (s.collider_count == 0) return;
    for (int attempt = 0; attempt < 2; ++attempt) {
      executor_.set(cloth.contact_counter.data(), 1, 0);
      with_deforming(s.deforms, [&](auto deforms) {
        executor_.for_each(cloth.vertex_count,
                           FindContactsOf<deforms.value>{cloth.positions.data(), cloth.velocities.data(), s.colliders,
                                                         s.collider_count, s.seconds, cloth.material.thickness, cloth.reach,
                                                         cloth.contacts.data(), static_cast<int>(cloth.contacts.capacity()),
                                                         cloth.contact_counter.data()});
      });
      cloth.contact_count = executor_.read(cloth.contact_counter.data());
      if (static_cast<std::size_t>(cloth.contact_count) <= cloth.contacts.capacity()) break;
      const auto found = static_cast<std::size_t>(cloth.contact_count);
      cloth.contacts.reserve(std::min(found + found / 4 + 256, static_cast<std::size_t>(cloth.vertex_count)));
    }
  });
}

template <class Executor> void ClothSolver<Executor>::prepare(const Substep &s, int *speed_limited) {
  for_each_cloth([&](Cloth &cloth) {
    Row *velocities = cloth.velocities.data();
    const float h = s.seconds;
    executor_.for_each(cloth.attachment_count,
                       PrepareAttachments{cloth.attachments.data(), s.colliders, cloth.positions.data(), velocities, h});
    constexpr float air_density = 1.2f;
    const float air = 0.5f * h * air_density / cloth.material.areal_density;
    const ClothWind &wind = cloth.wind;
    for_each_colour(cloth.membrane,
                    PrepareMembrane{cloth.membrane.view(),
                                    cloth.positions.data(),
                                    velocities,
                                    cloth.material.damping / h,
                                    {wind.velocity, air * wind.drag, air * wind.lift, cloth.material.areal_density}});
    executor_.for_each(cloth.vertex_count, ApplyForces{velocities, h * s.gravity, unlimited_speed, speed_limited});
    for_each_colour(cloth.hinges, PrepareHinges{cloth.hinges.view(), cloth.positions.data()});
    for_each_colour(cloth.threads, PrepareThreads{cloth.thread_view(), cloth.positions.data()});
  });
}

template <class Executor> void ClothSolver<Executor>::solve(const Substep &s) {
  for_each_cloth([&](Cloth &cloth) {
    Row *velocities = cloth.velocities.data();
    const ClothMaterial &m = cloth.material;
    const float h = s.seconds, tau = m.damping / h;
    for_each_colour(cloth.hinges, SolveHinges{cloth.hinges.view(), velocities, h, m.bending, tau});
    for_each_colour(cloth.membrane, SolveMembrane{cloth.membrane.view(), velocities, h, {m.stretch, m.shear, tau}});
    for_each_colour(cloth.threads, SolveThreads{cloth.thread_view(), velocities, h});
    executor_.for_each(cloth.attachment_count, SolveAttachments{cloth.attachments.data(), velocities, h});
  });
}

template <class Executor> void ClothSolver<Executor>::solve_contacts(const Substep &s) {
  for_each_cloth([&](Cloth &cloth) {
    executor_.for_each(cloth.contact_count, SolveContacts{cloth.contacts.data(), cloth.velocities.data(), s.seconds});
  });
}

template <class Executor> void ClothSolver<Executor>::solve_particle_contacts(const Substep &s) {
  for_each_cloth([&](Cloth &cloth) { cloth.particle_contact.solve(executor_, cloth.sheet(), s.particles, s.seconds); });
}

template <class Executor> void ClothSolver<Executor>::finish(const Substep &s, int *speed_limited, Reactions reactions) {
  if (self_contact_.any()) self_contact_.keep_apart(executor_, s.seconds);
  for_each_cloth([&](Cloth &cloth) {
    Row *velocities = cloth.velocities.data();
    const float fastest = cloth.reach / s.seconds;
    if (s.particles.count > 0) { // once more: smoothing and the speed limit have changed the particles
      executor_.for_each(cloth.vertex_count, LimitSpeed{velocities, fastest, speed_limited}); // none hits them faster
      for (int pass = 0; pass < 2; ++pass) cloth.particle_contact.solve(executor_, cloth.sheet(), s.particles, s.seconds);
    }
    executor_.for_each(cloth.vertex_count, LimitSpeed{velocities, fastest, speed_limited});
    if (s.particles.count > 0) cloth.particle_contact.keep_off(executor_, cloth.sheet(), s.particles, s.seconds);
    executor_.for_each(cloth.contact_count,
                       SolveContactsWithinLimit{{cloth.contacts.data(), velocities, s.seconds}, fastest, speed_limited});
    reactions.positions = cloth.positions.data();
    if (reactions.sums != nullptr)
      executor_.for_each(cloth.contact_count, AddReactions{cloth.contacts.data(), velocities, reactions});
    with_deforming(s.deforms, [&](auto deforms) {
      executor_.for_each(cloth.contact_count, SweepContactsOf<deforms.value>{
                                                  cloth.contacts.data(), cloth.positions.data(), velocities, s.colliders,
                                                  s.collider_count, s.seconds, 0.05f * cloth.material.thickness, reactions});
    });
  });
}

template <class Executor> void ClothSolver<Executor>::sweep_particles(const Substep &s, bool pushes_back) {
  // Off one cloth a particle may get to another.
  for (int round = 0; round < (in_use_ > 1 ? 2 : 1); ++round)
    for_each_cloth(
        [&](Cloth &cloth) { cloth.particle_contact.sweep(executor_, cloth.sheet(), s.particles, s.seconds, pushes_back); });
}

template <class Executor> void ClothSolver<Executor>::advance(const Substep &s) {
  for_each_cloth([&](Cloth &cloth) {
    executor_.for_each(cloth.vertex_count, AdvanceVertices{cloth.positions.data(), cloth.velocities.data(), s.seconds});
    if (s.particles.count > 0) cloth.particle_contact.apply(executor_, cloth.sheet(), s.particles, s.seconds);
  });
}

template <class Executor> double ClothSolver<Executor>::greatest_stretch() {
  float stretch = 0;
  const int width = executor_.constraint_width();
  for_each_cloth([&](Cloth &cloth) {
    stretch = std::max(stretch, executor_.reduce(cloth.membrane.batch_count() * width,
                                                 GreatestStretch{cloth.membrane.fields.data(), width}));
  });
  return static_cast<double>(stretch);
}

template <class Executor> std::size_t ClothSolver<Executor>::row_count() const {
  std::size_t sum = 0;
  for (const Cloth &cloth : cloths_)
    if (cloth.in_use) sum += static_cast<std::size_t>(cloth.spare_vertex);
  return sum;
}

template <class Executor> std::uint64_t ClothSolver<Executor>::particle_contact_count() const {
  std::uint64_t sum = 0;
  for (const Cloth &cloth : cloths_) sum += static_cast<std::uint64_t>(cloth.particle_contact.count());
  return sum;
}

template <class Executor> std::uint64_t ClothSolver<Executor>::contact_count() const {
  std::uint64_t sum = 0;
  for (const Cloth &cloth : cloths_) sum += static_cast<std::uint64_t>(cloth.contact_count);
  return sum;
}

} // namespace loam
