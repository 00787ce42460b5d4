/* The scene reader takes any text: it gives a scene that can be scaled, all of it finite, or an Error that names the file. The meshes of corpus/obj can be
 * named by it. */
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "error.h"
#include "scene_reader.h"
#include "target.h"

namespace {

void check(double value) {
  if (!std::isfinite(value)) std::abort();
}
void check(const runner::Vector3 &v) {
  check(v.x);
  check(v.y);
  check(v.z);
}
void check(const std::array<float, 4> &rotation) {
  for (const float q : rotation) check(q);
}
void check(const runner::SceneRegion &region) {
  check(region.center);
  check(region.rotation);
  check(region.half_extents);
  check(region.radius);
  check(region.half_height);
}

void check(const runner::Scene &scene) {
  if (scene.materials.empty() || scene.emitters.empty() || scene.frames == 0) std::abort();
  check(scene.frame_rate);
  check(scene.world.kernel_radius);
  for (const float g : scene.world.gravity) check(g);
  for (const runner::SceneMaterial &material : scene.materials) {
    check(material.def.density);
    check(material.def.youngs_modulus);
    check(material.def.friction_angle);
    check(material.colour);
  }
  for (const runner::SceneEmitter &emitter : scene.emitters) {
    check(emitter.region);
    check(emitter.cut);
    check(emitter.def.spacing);
  }
  for (const runner::SceneCollider &collider : scene.colliders) {
    check(collider.pose.position);
    check(collider.pose.rotation);
    check(collider.friction);
  }
  if (scene.camera) check(scene.camera->eye);
  check(scene.light.direction);
}

} // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  static const std::filesystem::path path = LOAM_SOURCE_DIR "/tests/fuzz/corpus/scene/scene.toml";
  try {
    runner::Scene scene = runner::parse_scene(path, std::string_view(reinterpret_cast<const char *>(data), size));
    check(scene);
    runner::scale_particle_count(scene, size % 2 == 0 ? 0.01 : 100);
  } catch (const runner::Error &error) {
    if (std::string(error.what()).find("scene.toml") == std::string::npos) std::abort();
  }
  return 0;
}
