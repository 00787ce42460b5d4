/* A cube of sand that falls at 2 m/s onto a plane, or into a groove of triangles: how deep a grain gets into it at any time, over the grain's radius. */
#include "study.h"
#include "support/meshes.h"

#include <cmath>

namespace loam::accuracy {

namespace {

constexpr double frame = 0.004;

/* A surface of the ground, on whose one side the sand stays. */
struct Side {
  double normal[2]; // across it, in the plane of x and y; it goes through the origin
  double depth(const float *x, double radius) const {
    return radius - (normal[0] * double(x[0]) + normal[1] * double(x[1]));
  }
};

/* Two rectangles that meet in the z axis, each rising by 45 degrees. */
meshes::Mesh groove() {
  constexpr float size = 0.5f;
  meshes::Mesh mesh;
  for (const float x : {-size, 0.0f, size})
    for (const float z : {-size, size}) mesh.vertex(x, std::fabs(x), z);
  mesh.quad(0, 1, 3, 2);
  mesh.quad(2, 3, 5, 4);
  return mesh;
}

double deepest(bool into_groove, const Setting &setting, Meter &meter) {
  constexpr double seconds = 0.2, root = 0.70710678118654752;
  scenes::Scene scene = scenes::drop_block(scenes::sand(), 10, into_groove ? 0.06f : 0.01f, 2);
  if (into_groove) scene.planes.clear();
  test::Course course = meter.course();
  loam_world_def def = scenes::world_def(scene);
  course.change(def);
  def.substeps = std::uint32_t(std::lround(frame / setting.substep));
  scenes::World world(def, scene);
  std::vector<Side> sides = {{{0, 1}}};
  if (into_groove) {
    sides = {{{root, root}}, {{-root, root}}};
    const meshes::Mesh mesh = groove();
    loam_collider_def collider;
    scenes::require(loam_collider_def_default(&collider, sizeof collider), "loam_collider_def_default");
    collider.kind = LOAM_COLLIDER_MESH;
    collider.mesh = mesh.view();
    loam_collider_id id;
    scenes::require(loam_collider_create(world.get(), &collider, &id), "loam_collider_create");
  }
  const double radius = 0.5 * double(scene.spacing);
  double depth = 0;
  for (int k = 0; k < int(std::lround(seconds / frame)); ++k) {
    course.step(world, float(frame));
    const std::vector<float> now = world.snapshot().positions;
    for (std::size_t i = 0; i < now.size(); i += 3)
      for (const Side &side : sides) depth = std::max(depth, side.depth(&now[i], radius));
  }
  return depth / radius;
}

} // namespace

void penetration(Study &study) {
  const std::vector<double> substeps = study.quick() ? std::vector{1e-3, 4e-3} : std::vector{5e-4, 1e-3, 2e-3, 4e-3};
  const std::vector<std::uint32_t> iterations =
      study.quick() ? std::vector<std::uint32_t>{5} : std::vector<std::uint32_t>{1, 5, 10};
  std::vector<Setting> settings = combine({{}, {LOAM_SOLVER_JACOBI}}, substeps, iterations);
  if (!study.quick()) append(settings, presets(frame));
  for (const bool into_groove : {false, true})
    study.sweep("penetration", into_groove ? "into a groove" : "onto a plane", {"depth over the radius of a grain"},
                settings,
                [&](const Setting &setting, Meter &meter) { return std::vector{deepest(into_groove, setting, meter)}; });
}

} // namespace loam::accuracy
