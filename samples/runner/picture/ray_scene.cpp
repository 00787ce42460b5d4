#include "picture/ray_scene.h"

#include <cmath>
#include <limits>

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include "error.h"
#include "picture/lathe.h"

namespace runner {
namespace {

constexpr std::uint32_t spheres_id = 0x00ffffffu; // far above the solids', which are their indices

// Triangles that meet at less than about 40 degrees are shown as one smooth surface.
constexpr float crease_cosine = 0.77f;

// For each corner of each triangle, the normal of the smooth surface around it.
std::vector<Vector3> corner_normals(const Mesh &mesh) {
  const std::size_t triangles = mesh.triangle_count();
  std::vector<Vector3> areas(triangles);
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1), around(mesh.indices.size());
  for (const std::uint32_t vertex : mesh.indices) ++first[vertex + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t t = 0; t < triangles; ++t) {
    const Vector3 a = mesh.vertices[mesh.indices[3 * t]], b = mesh.vertices[mesh.indices[3 * t + 1]],
                  c = mesh.vertices[mesh.indices[3 * t + 2]];
    areas[t] = cross(b - a, c - a);
    for (std::size_t corner = 0; corner < 3; ++corner)
      around[next[mesh.indices[3 * t + corner]]++] = static_cast<std::uint32_t>(t);
  }
  std::vector<Vector3> normals(mesh.indices.size());
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vector3 own = areas[i / 3];
    const std::uint32_t vertex = mesh.indices[i];
    for (std::uint32_t k = first[vertex]; k < first[vertex + 1]; ++k) {
      const Vector3 other = areas[around[k]];
      if (dot(own, other) >= crease_cosine * length(own) * length(other)) normals[i] += other;
    }
  }
  return normals;
}

RTCRay to_embree(const Ray &ray, float from, float to) {
  RTCRay result{};
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.tnear = from;
  result.tfar = to;
  result.mask = std::numeric_limits<unsigned>::max();
  return result;
}

// The normal of a triangle mesh between its vertices' normals; facing the ray's origin.
Vector3 smooth_normal(RTCScene scene, const RTCRayHit &found) {
  Vector3 normal;
  rtcInterpolate0(rtcGetGeometry(scene, found.hit.geomID), found.hit.primID, found.hit.u, found.hit.v,
                  RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, 0, &normal.x, 3);
  const Vector3 flat = {found.hit.Ng_x, found.hit.Ng_y, found.hit.Ng_z};
  if (!(dot(normal, normal) > 0)) normal = flat;
  normal = normalized(normal);
  const Vector3 direction = {found.ray.dir_x, found.ray.dir_y, found.ray.dir_z};
  return dot(flat, direction) * dot(flat, normal) > 0 ? -normal : normal;
}

// For meshes that stand for something round: a share of their edges' length.
float lift_off(const Mesh &mesh) {
  constexpr std::size_t fine = 500; // triangles; what has fewer is meant to have flat sides
  if (mesh.triangle_count() < fine) return 0;
  float sum = 0;
  for (std::size_t i = 0; i < mesh.indices.size(); ++i)
    sum += length(mesh.vertices[mesh.indices[i]] - mesh.vertices[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]]);
  return 0.15f * sum / static_cast<float>(mesh.indices.size());
}

} // namespace

RayScene::RayScene(const Scene &scene) {
  device_ = rtcNewDevice(nullptr);
  if (device_ == nullptr)
    throw Error(fmt::format("Embree cannot be started (error {})", static_cast<int>(rtcGetDeviceError(nullptr))));
  opaque_ = rtcNewScene(device_);
  glass_ = rtcNewScene(device_);
  sheets_ = rtcNewScene(device_);

  for (const SceneDecoration &decoration : scene.decorations) {
    if (decoration.appearance == Appearance::hidden) continue;
    const Mesh mesh = make_rounded_cylinder(decoration.radius, decoration.half_height, decoration.rounding);
    const bool glass = decoration.appearance == Appearance::glass;
    const std::uint32_t id = glass ? panes_++ : static_cast<std::uint32_t>(solids_.size());
    if (!glass) solids_.push_back({decoration.appearance, decoration.colour, decoration.center});
    add_mesh(glass ? glass_ : opaque_, id, mesh, {decoration.center, {0, 0, 0, 1}}, true);
  }
  for (const SceneCollider &collider : scene.colliders) {
    if (collider.appearance == Appearance::hidden) continue;
    if (collider.kind == LOAM_COLLIDER_PLANE) {
      // One plane is the ground; more would wall the camera in.
      if (!ground_)
        ground_ =
            Ground{collider.pose.position, rotate(collider.pose.rotation, {0, 1, 0}), collider.colour, collider.appearance};
      continue;
    }
    const Mesh &mesh = scene.meshes.at(collider.file);
    const bool glass = collider.appearance == Appearance::glass;
    const std::uint32_t id = glass ? panes_++ : static_cast<std::uint32_t>(solids_.size());
    if (!glass) solids_.push_back({collider.appearance, collider.colour, collider.pose.position, lift_off(mesh)});
    if (!glass && (collider.moves() || !collider.deformations.empty()))
      moving_.push_back({id, &collider, &mesh});
    else
      add_mesh(glass ? glass_ : opaque_, id, mesh, collider.pose, true);
  }
  has_glass_ = panes_ != 0;
  rtcCommitScene(glass_);
  rtcCommitScene(opaque_);
  if (!solids_.empty() || has_glass_) lift_ = 2e-5f * length(high_ - low_);
}

RayScene::~RayScene() {
  if (spheres_geometry_ != nullptr) rtcReleaseGeometry(spheres_geometry_);
  if (sheets_ != nullptr) rtcReleaseScene(sheets_);
  if (glass_ != nullptr) rtcReleaseScene(glass_);
  if (opaque_ != nullptr) rtcReleaseScene(opaque_);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

void RayScene::add_mesh(RTCSceneTy *to, std::uint32_t id, const Mesh &mesh, const Pose &pose, bool bounding) {
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  // Every triangle has corners of its own, so that edges can be sharp.
  const std::size_t count = mesh.indices.size();
  auto *vertices = static_cast<Vector3 *>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vector3), count));
  auto *indices = static_cast<std::uint32_t *>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                       3 * sizeof(std::uint32_t), mesh.triangle_count()));
  rtcSetGeometryVertexAttributeCount(geometry, 1);
  auto *normals = static_cast<Vector3 *>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, 0, RTC_FORMAT_FLOAT3, sizeof(Vector3), count));
  if (vertices == nullptr || indices == nullptr || normals == nullptr) throw Error("out of memory for the picture's meshes");
  const std::vector<Vector3> mesh_normals = corner_normals(mesh);
  for (std::size_t i = 0; i < count; ++i) {
    vertices[i] = rotate(pose.rotation, mesh.vertices[mesh.indices[i]]) + pose.position;
    normals[i] = rotate(pose.rotation, mesh_normals[i]);
    indices[i] = static_cast<std::uint32_t>(i);
    if (!bounding) continue;
    low_ = minimum(low_, vertices[i]);
    high_ = maximum(high_, vertices[i]);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(to, geometry, id);
  rtcReleaseGeometry(geometry);
}

void RayScene::replace_mesh(std::uint32_t id, const Mesh &mesh, const Pose &pose) {
  replaced_.resize(solids_.size());
  if (replaced_[id]) rtcDetachGeometry(opaque_, id);
  replaced_[id] = !mesh.indices.empty();
  if (replaced_[id]) add_mesh(opaque_, id, mesh, pose, !bounds_known_);
}

std::uint32_t RayScene::add_surface(Appearance appearance, Vector3 colour, float lift) {
  solids_.push_back({appearance, colour, {}, lift});
  return static_cast<std::uint32_t>(solids_.size() - 1);
}

void RayScene::set_surface(std::uint32_t solid, const Mesh &mesh) { replace_mesh(solid, mesh, {}); }

void RayScene::set_sheet(std::uint32_t solid, const Mesh &mesh) {
  const auto is_there = [&] { return solid < replaced_.size() && replaced_[solid]; };
  if (is_there()) rtcDetachGeometry(sheets_, solid);
  set_surface(solid, mesh);
  if (is_there()) rtcAttachGeometryByID(sheets_, rtcGetGeometry(opaque_, solid), solid);
  rtcCommitScene(sheets_);
}

float RayScene::sheet_ahead(Vector3 from, Vector3 direction, float limit) const {
  RTCRayHit found{};
  found.ray = to_embree({from, direction}, 0, limit);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(sheets_, &context, &found);
  return found.ray.tfar;
}

void RayScene::set_frame(std::vector<float> spheres, double time) {
  spheres_ = std::move(spheres);
  for (const Moving &each : moving_) {
    const Pose pose = pose_at(each.collider->pose, each.collider->motions, time);
    solids_[each.solid].origin = pose.position;
    const std::vector<Deformation> &deformations = each.collider->deformations;
    if (deformations.empty())
      replace_mesh(each.solid, *each.mesh, pose);
    else
      replace_mesh(each.solid, deformed(*each.mesh, deformations, time), pose);
  }
  if (!bounds_known_) { // once: the ground's light is laid out over these bounds, and must not wander from frame to frame
    for (std::size_t i = 0; i + 3 < spheres_.size(); i += 4) {
      const Vector3 center = {spheres_[i], spheres_[i + 1], spheres_[i + 2]};
      if (!std::isfinite(dot(center, center))) continue;
      low_ = minimum(low_, center);
      high_ = maximum(high_, center);
    }
    lift_ = 2e-5f * length(high_ - low_);
    bounds_known_ = true;
  }
  if (!spheres_.empty()) {
    if (spheres_geometry_ == nullptr) {
      spheres_geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
      rtcAttachGeometryByID(opaque_, spheres_geometry_, spheres_id);
    }
    rtcSetSharedGeometryBuffer(spheres_geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, spheres_.data(), 0,
                               4 * sizeof(float), spheres_.size() / 4);
    rtcCommitGeometry(spheres_geometry_);
  }
  rtcCommitScene(opaque_);
}

Hit RayScene::closest(const Ray &ray) const {
  Hit hit;
  if (ground_) {
    const float approach = dot(ray.direction, ground_->normal);
    const float distance = dot(ground_->point - ray.origin, ground_->normal) / approach;
    if (approach < 0 && distance > 0) hit = {Hit::ground, distance, ray.at(distance), ground_->normal, 0};
  }
  RTCRayHit found{};
  found.ray = to_embree(ray, 0, hit.distance);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(opaque_, &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.distance = found.ray.tfar;
  hit.position = ray.at(hit.distance);
  if (found.hit.geomID == spheres_id) {
    hit.kind = Hit::particle;
    hit.index = found.hit.primID;
    const float *sphere = &spheres_[4 * static_cast<std::size_t>(hit.index)];
    hit.normal = normalized(hit.position - Vector3{sphere[0], sphere[1], sphere[2]});
  } else {
    hit.kind = Hit::solid;
    hit.index = found.hit.geomID;
    hit.normal = smooth_normal(opaque_, found);
  }
  return hit;
}

bool RayScene::occluded(const Ray &ray) const {
  if (ground_ && dot(ray.direction, ground_->normal) < 0 && dot(ray.origin - ground_->point, ground_->normal) > 0)
    return true;
  RTCRay shadow = to_embree(ray, 0, 1e30f);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(opaque_, &context, &shadow);
  return shadow.tfar < 0;
}

std::optional<Hit> RayScene::glass(const Ray &ray, float from, float to) const {
  if (!has_glass_) return std::nullopt;
  RTCRayHit found{};
  found.ray = to_embree(ray, from, to);
  found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(glass_, &context, &found);
  if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{Hit::solid, found.ray.tfar, ray.at(found.ray.tfar), smooth_normal(glass_, found), found.hit.geomID};
}

} // namespace runner
