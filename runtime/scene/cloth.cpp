#include "scene/cloth.h"

#include <algorithm>
#include <cmath>

#include "scene/checks.h"
#include "scene/cloth_threads.h"
#include "scene/fingerprint.h"
#include "scene/graph_colouring.h"
#include "scene/pose.h"

namespace loam {

loam_cloth_def default_cloth() {
  loam_cloth_def def = {};
  def.struct_size = sizeof def;
  def.rotation[3] = 1;
  def.areal_density = 0.15f;
  def.stretch_stiffness = 3000;
  def.shear_stiffness = 60;
  def.bending_stiffness = 1e-5f;
  def.damping = 1e-3f;
  def.warp[0] = 1;
  def.particle_friction = 0.5f;
  def.greatest_stretch = 0.005f;
  def.self_friction = 0.3f;
  return def;
}

loam_cloth_attachment_def default_attachment() {
  loam_cloth_attachment_def def = {};
  def.struct_size = sizeof def;
  return def;
}

namespace {

using Vector = Vec3<double>;

Vector in_double(const Vec3<float> &v) { return {double(v.x), double(v.y), double(v.z)}; }
Vector unit(const Vector &v) { return (1 / length(v)) * v; }

double cotangent(const Vector &a, const Vector &b) { return dot(a, b) / length(cross(a, b)); }

// Puts constraints in the order of their colours.
// `order` receives which is where.
ClothConstraintList sorted(const std::vector<int> &indices, const std::vector<float> &fields, int size, int vertex_count,
                           std::vector<int> &order) {
  const std::size_t vertices = static_cast<std::size_t>(size);
  const std::size_t count = indices.size() / vertices, width = count > 0 ? fields.size() / count : 0;
  std::vector<int> starts(count + 1);
  for (std::size_t i = 0; i <= count; ++i) starts[i] = static_cast<int>(i) * size;
  Colours colours = colour_constraints(indices, starts, vertex_count);
  ClothConstraintList list;
  list.starts = colours.starts;
  list.indices.reserve(indices.size());
  list.fields.reserve(fields.size());
  for (const int i : colours.order) {
    const auto constraint = static_cast<std::size_t>(i);
    list.indices.insert(list.indices.end(), indices.data() + constraint * vertices,
                        indices.data() + (constraint + 1) * vertices);
    list.fields.insert(list.fields.end(), fields.data() + constraint * width, fields.data() + (constraint + 1) * width);
  }
  order.swap(colours.order);
  return list;
}

ClothConstraintList make_membrane(const ClothMesh &mesh, const Vector &warp, std::vector<int> &order) {
  std::vector<float> fields;
  for (std::size_t t = 0; t < mesh.areas.size(); ++t) {
    const int *v = mesh.triangles.data() + 3 * t;
    const auto vertex = [&](int k) { return in_double(mesh.vertices[static_cast<std::size_t>(v[k])]); };
    const Vector e1 = vertex(1) - vertex(0), e2 = vertex(2) - vertex(0), normal = unit(cross(e1, e2));
    const Vector along = warp_in_plane(warp, normal), across = cross(normal, along);
    const double determinant = dot(e1, along) * dot(e2, across) - dot(e2, along) * dot(e1, across);
    // The inverse of the matrix with the edges, in the material's directions, as columns.
    fields.push_back(static_cast<float>(dot(e2, across) / determinant));
    fields.push_back(static_cast<float>(-dot(e1, across) / determinant));
    fields.push_back(static_cast<float>(-dot(e2, along) / determinant));
    fields.push_back(static_cast<float>(dot(e1, along) / determinant));
    fields.push_back(mesh.areas[t]);
  }
  return sorted(mesh.triangles, fields, 3, static_cast<int>(mesh.vertices.size()), order);
}

ClothConstraintList make_hinges(const ClothMesh &mesh, std::vector<int> &order) {
  std::vector<int> indices;
  std::vector<float> fields;
  for (const ClothHinge &hinge : mesh.hinges) {
    Vector x[4];
    for (int k = 0; k < 4; ++k) {
      indices.push_back(hinge.vertex[k]);
      x[k] = in_double(mesh.vertices[static_cast<std::size_t>(hinge.vertex[k])]);
    }
    const Vector edge = x[1] - x[0], first = cross(edge, x[2] - x[0]), second = cross(x[3] - x[0], edge);
    const double c01 = cotangent(edge, x[2] - x[0]), c02 = cotangent(edge, x[3] - x[0]);
    const double c03 = cotangent(x[0] - x[1], x[2] - x[1]), c04 = cotangent(x[0] - x[1], x[3] - x[1]);
    const double q1 = c01 + c02, q2 = -c01 - c03, q3 = -c02 - c04;
    const Vector sum = q1 * edge + q2 * (x[2] - x[0]) + q3 * (x[3] - x[0]), normal = first + second;
    const double size = length(normal), scale = length(first) + length(second);
    // Flat to rounding is flat.
    const double curved = size > 1e-6 * scale ? dot(sum, normal) / size : 0;
    const double rest = std::fabs(curved) > 1e-5 * length(edge) ? curved : 0, per_root_area = std::sqrt(2 / scale);
    for (const double field : {q1, q2, q3, rest}) fields.push_back(static_cast<float>(per_root_area * field));
  }
  return sorted(indices, fields, 4, static_cast<int>(mesh.vertices.size()), order);
}

void check_definition(const loam_cloth_def &def) {
  check_reserved("reserved", def.reserved);
  check_reserved("reserved_2", def.reserved_2);
  check_vector("velocity", def.velocity, 1e6);
  check_range("areal_density", double(def.areal_density), double(1e-4f), 1e4);
  check_above("stretch_stiffness", double(def.stretch_stiffness), 0, 1e9);
  check_range("shear_stiffness", double(def.shear_stiffness), 0, 1e9);
  check_range("bending_stiffness", double(def.bending_stiffness), 0, 1e6);
  check_range("damping", double(def.damping), 0, 10);
  check_vector("warp", def.warp, 1e6);
  if (def.warp[0] == 0 && def.warp[1] == 0 && def.warp[2] == 0)
    throw Error(LOAM_ERROR_INVALID_ARGUMENT, "warp is (0, 0, 0); it must have a direction");
  check_range("particle_friction", double(def.particle_friction), 0, 100);
  check_range("greatest_stretch", double(def.greatest_stretch), 0, 10);
  if (def.self_distance != 0.0f) check_range("self_distance", double(def.self_distance), double(1e-6f), 1e3);
  check_range("self_friction", double(def.self_friction), 0, 100);
  if (def.tear_strain != 0.0f) check_range("tear_strain", double(def.tear_strain), double(1e-4f), 100);
  if (def.thickness != 0.0f) check_range("thickness", double(def.thickness), double(1e-6f), 1e3);
}

} // namespace

SolverCloth make_cloth(const loam_cloth_def &def, const ClothMesh &mesh, float thickness) {
  check_definition(def);
  const Pose pose = make_pose(def.position, def.rotation);
  SolverCloth cloth;
  cloth.material = {def.stretch_stiffness, def.shear_stiffness, def.bending_stiffness,
                    def.damping,           def.areal_density,   def.thickness != 0.0f ? def.thickness : thickness,
                    def.particle_friction, def.self_distance,   def.self_friction,
                    def.tear_strain};
  std::vector<double> masses(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    masses[static_cast<std::size_t>(mesh.triangles[i])] += double(def.areal_density) * double(mesh.areas[i / 3]) / 3;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vec3<float> x = to_world(pose, mesh.vertices[i]), rest = mesh.vertices[i];
    cloth.rest.push_back({rest.x, rest.y, rest.z, 0.0f});
    cloth.positions.push_back({x.x, x.y, x.z, 0.0f});
    cloth.velocities.push_back({def.velocity[0], def.velocity[1], def.velocity[2], static_cast<float>(1 / masses[i])});
  }
  cloth.triangles = mesh.triangles;
  const Vector warp = {double(def.warp[0]), double(def.warp[1]), double(def.warp[2])};
  std::vector<int> membrane_order, hinge_order;
  cloth.membrane = make_membrane(mesh, warp, membrane_order);
  if (def.bending_stiffness > 0) cloth.hinges = make_hinges(mesh, hinge_order);
  if (def.greatest_stretch > 0)
    cloth.threads = make_threads(mesh, warp, double(def.greatest_stretch), double(def.stretch_stiffness));
  if (def.tear_strain > 0) {
    SolverCloth::Parts &parts = cloth.parts;
    parts.areas = mesh.areas;
    parts.link_triangles = cloth.threads.link_triangles;
    for (const int i : hinge_order) {
      const ClothHinge &hinge = mesh.hinges[static_cast<std::size_t>(i)];
      parts.hinge_triangles.insert(parts.hinge_triangles.end(), hinge.triangle, hinge.triangle + 2);
    }
    parts.shapes.resize(mesh.areas.size());
    for (std::size_t i = 0; i < membrane_order.size(); ++i) {
      const float *shape = cloth.membrane.fields.data() + 5 * i;
      parts.shapes[static_cast<std::size_t>(membrane_order[i])] = {shape[0], shape[1], shape[2], shape[3]};
    }
    parts.membrane_triangles.swap(membrane_order);
  }
  return cloth;
}

void check_wind(const ClothWind &wind) {
  const float velocity[3] = {wind.velocity.x, wind.velocity.y, wind.velocity.z};
  check_vector("velocity", velocity, 1e4);
  check_range("drag", double(wind.drag), 0, 100);
  check_range("lift", double(wind.lift), 0, 100);
}

// ------------------------------------------------------------------------------------------------- the world's cloths ---

ClothScene::Cloth &ClothScene::changeable(loam_cloth_id id) {
  Cloth &cloth = cloths_.at(id, "cloth");
  if (cloth.mapped) throw Error(LOAM_ERROR_IN_USE, "the cloth's buffers are mapped; call loam_cloth_unmap first");
  return cloth;
}

loam_cloth_id ClothScene::create(ClothBackend &backend, const loam_cloth_def &def) {
  (void)cloths_.next_id(); // room for one more
  Cloth cloth;
  cloth.mesh = std::make_shared<ClothMesh>(make_cloth_mesh(def.mesh));
  const SolverCloth made = make_cloth(def, *cloth.mesh, default_thickness_);
  cloth.description = {def, mesh_fingerprint(def.mesh), def.mesh.vertex_count, def.mesh.triangle_count};
  cloth.description.def.mesh = {};
  cloth.backend = backend.add(made);
  try {
    send(backend, cloth);
    const loam_cloth_id id = cloths_.add(cloth);
    ++count_;
    return id;
  } catch (...) {
    backend.remove(cloth.backend);
    throw;
  }
}

void ClothScene::destroy(ClothBackend &backend, loam_cloth_id id) {
  backend.remove(changeable(id).backend);
  cloths_.remove(id, "cloth");
  --count_;
}

void ClothScene::send(ClothBackend &backend, const Cloth &cloth) const {
  std::vector<SolverAttachment> attachments = cloth.changes.attachments;
  for (SolverAttachment &a : attachments) {
    if (a.collider < 0) continue;
    const auto slot = static_cast<std::size_t>(a.collider);
    a.collider = slot < index_of_slot_.size() ? index_of_slot_[slot] : 0; // set before the step
  }
  backend.set_attachments(cloth.backend, attachments);
}

void ClothScene::attach(ClothBackend &backend, loam_cloth_id id, const loam_cloth_attachment_def &def, int collider,
                        const Pose &pose) {
  Cloth &cloth = changeable(id);
  check_reserved("reserved", def.reserved);
  const std::uint32_t vertex_count = backend.vertex_count(cloth.backend);
  check_range("count", def.count, 1, vertex_count);
  check_pointer(def.vertices, "vertices");
  if (def.compliance != 0.0f) check_range("compliance", double(def.compliance), double(1e-9f), 1e9);
  std::vector<bool> held(vertex_count);
  for (const SolverAttachment &a : cloth.changes.attachments) held[static_cast<std::size_t>(a.vertex)] = true;
  std::vector<Row> now;
  if (def.points == nullptr) now = backend.positions(cloth.backend);
  std::vector<SolverAttachment> attachments = cloth.changes.attachments;
  for (std::uint32_t i = 0; i < def.count; ++i) {
    const std::uint32_t v = def.vertices[i];
    if (v >= vertex_count)
      throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                  format("vertices[%u] is %u; the cloth has %u vertices, from 0 on", i, v, vertex_count));
    if (held[v]) throw Error(LOAM_ERROR_IN_USE, format("vertices[%u], %u, is attached already; release it first", i, v));
    held[v] = true;
    Vec3<float> point;
    if (def.points != nullptr) {
      const float *p = def.points + 3 * std::size_t(i);
      for (int k = 0; k < 3; ++k)
        if (!(std::fabs(p[k]) <= 1e9f))
          throw Error(LOAM_ERROR_INVALID_ARGUMENT,
                      format("points[%u].%c is %g; it must be finite and at most 1e9 in size", i, "xyz"[k], double(p[k])));
      point = {p[0], p[1], p[2]};
    } else {
      point = collider < 0 ? xyz(now[v]) : to_local(pose, xyz(now[v]));
    }
    attachments.push_back({static_cast<int>(v), collider, point, def.compliance > 0.0f ? 1.0f / def.compliance : 0.0f});
  }
  cloth.changes.attachments.swap(attachments);
  try {
    send(backend, cloth);
  } catch (...) {
    cloth.changes.attachments.swap(attachments);
    throw;
  }
}

void ClothScene::release(ClothBackend &backend, loam_cloth_id id, const std::uint32_t *vertices, std::uint32_t count) {
  Cloth &cloth = changeable(id);
  check_range("count", count, 1, static_cast<double>(backend.vertex_count(cloth.backend)));
  check_pointer(vertices, "vertices");
  std::vector<SolverAttachment> attachments = cloth.changes.attachments;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto at = std::find_if(attachments.begin(), attachments.end(), [&](const SolverAttachment &a) {
      return static_cast<std::uint32_t>(a.vertex) == vertices[i];
    });
    if (at == attachments.end())
      throw Error(LOAM_ERROR_INVALID_ARGUMENT, format("vertices[%u], %u, is not attached", i, vertices[i]));
    attachments.erase(at);
  }
  cloth.changes.attachments.swap(attachments);
  send(backend, cloth);
}

void ClothScene::set_wind(ClothBackend &backend, loam_cloth_id id, const float velocity[3], float drag, float lift) {
  Cloth &cloth = cloths_.at(id, "cloth");
  const ClothWind wind = {{velocity[0], velocity[1], velocity[2]}, drag, lift};
  check_wind(wind);
  cloth.changes.wind = wind;
  backend.set_wind(cloth.backend, wind);
}

void ClothScene::map(ClothBackend &backend, loam_cloth_id id, loam_cloth_view &view) {
  Cloth &cloth = cloths_.at(id, "cloth");
  if (cloth.mapped) throw Error(LOAM_ERROR_IN_USE, "the cloth's buffers are mapped already");
  backend.map(cloth.backend, view);
  cloth.mapped = true;
  ++mapped_;
}

void ClothScene::unmap(loam_cloth_id id) {
  Cloth &cloth = cloths_.at(id, "cloth");
  if (!cloth.mapped) throw Error(LOAM_ERROR_INVALID_ARGUMENT, "the cloth's buffers are not mapped");
  cloth.mapped = false;
  --mapped_;
}

void ClothScene::check_unattached(int collider_slot) const {
  for (std::size_t i = 0; i < cloths_.size(); ++i)
    if (const Cloth *cloth = cloths_.at_index(i); cloth != nullptr)
      for (const SolverAttachment &a : cloth->changes.attachments)
        if (a.collider == collider_slot)
          throw Error(
              LOAM_ERROR_IN_USE,
              format("vertex %d of a cloth is attached to the collider; release it or destroy the cloth first", a.vertex));
}

void ClothScene::use_colliders(ClothBackend &backend, const std::vector<int> &index_of_slot) {
  if (index_of_slot == index_of_slot_) return;
  index_of_slot_ = index_of_slot;
  for (std::size_t i = 0; i < cloths_.size(); ++i)
    if (const Cloth *cloth = cloths_.at_index(i); cloth != nullptr && !cloth->changes.attachments.empty())
      send(backend, *cloth);
}

void ClothScene::shift_origin(ClothBackend &backend, const Vec3<float> &by) {
  for (std::size_t slot = 0; slot < cloths_.size(); ++slot)
    if (Cloth *cloth = cloths_.at_index(slot); cloth != nullptr && !cloth->changes.attachments.empty()) {
      for (SolverAttachment &a : cloth->changes.attachments)
        if (a.collider < 0) a.point = a.point - by;
      send(backend, *cloth); // as many as before: needs no memory on the machine
    }
}

// ------------------------------------------------------------------------------------------------------ snapshots ---

std::uint64_t ClothScene::vertex_count() const {
  std::uint64_t count = 0;
  for (std::size_t slot = 0; slot < cloths_.size(); ++slot)
    if (const Description *cloth = description(slot); cloth != nullptr) count += cloth->vertex_count;
  return count;
}

const ClothScene::Description *ClothScene::description(std::size_t slot) const {
  const Cloth *cloth = slot < cloths_.size() ? cloths_.at_index(slot) : nullptr;
  return cloth != nullptr ? &cloth->description : nullptr;
}

ClothScene::Changes ClothScene::changes(const ClothBackend &backend, std::size_t slot) const {
  const Cloth &cloth = *cloths_.at_index(slot);
  Changes changes = cloth.changes;
  changes.torn = backend.torn_corners(cloth.backend);
  return changes;
}

bool ClothScene::could_be_torn(const ClothBackend &backend, std::size_t slot, const std::vector<TornCorner> &torn) const {
  return backend.could_be_torn(cloths_.at_index(slot)->backend, torn);
}

void ClothScene::set_changes(ClothBackend &backend, const std::vector<Changes> &changes) {
  std::vector<Changes> before(cloths_.size());
  std::size_t sent = 0;
  const auto set = [&](std::size_t slot, const Changes &now) {
    Cloth *cloth = cloths_.at_index(slot);
    if (cloth == nullptr) return;
    before[slot] = this->changes(backend, slot);
    cloth->changes = now;
    cloth->changes.torn.clear(); // the backend has them
    backend.set_torn_corners(cloth->backend, now.torn);
    send(backend, *cloth);
    backend.set_wind(cloth->backend, now.wind);
  };
  try {
    for (; sent < changes.size(); ++sent) set(sent, changes[sent]);
  } catch (...) {
    // As they were: there is room for that.
    for (std::size_t slot = 0; slot <= sent; ++slot) set(slot, Changes(before[slot]));
    throw;
  }
}

void ClothScene::list_state(ClothBackend &backend, const std::vector<Changes> &changes,
                            std::vector<StateSection> &list) const {
  for (std::size_t slot = 0; slot < cloths_.size(); ++slot)
    if (const Cloth *cloth = cloths_.at_index(slot); cloth != nullptr)
      backend.list_state(cloth->backend, changes[slot].torn, static_cast<std::uint32_t>(slot), list);
}

} // namespace loam
