/* A bag of cloth full of sand falls on the ground from a metre, and lies there: how many grains get out in ten seconds of steps at the default accuracy.
 *
 * Prints a line for each second. The exit status is 0 if no grain was outside at the end of any frame. */
#include <cstdio>
#include <exception>
#include <stdexcept>

#include <CLI/CLI.hpp>

#include "support/cloths.h"
#include "support/meshes.h"

namespace loam {
namespace {

struct Options {
  double seconds = 10;
  float radius = 0.2f, kernel_radius = 0.022f, height = 1;
  std::uint32_t threads = 1;
};

loam_world_def definition(const Options &options) {
  loam_world_def def;
  scenes::require(loam_world_def_default(&def, sizeof def), "loam_world_def_default");
  def.backend = LOAM_BACKEND_CPU;
  def.thread_count = options.threads;
  def.kernel_radius = options.kernel_radius;
  def.particle_capacity = 100000;
  return def;
}

class Bag {
public:
  explicit Bag(const Options &options)
      : options_(options), world_(definition(options)), mesh_(meshes::icosphere(options.radius, 4)),
        cloth_(world_.get(), cloth_definition(options, mesh_)) {
    loam_collider_def ground;
    scenes::require(loam_collider_def_default(&ground, sizeof ground), "loam_collider_def_default");
    loam_collider_id collider;
    scenes::require(loam_collider_create(world_.get(), &ground, &collider), "loam_collider_create");
    loam_material_def sand;
    loam_material_id material;
    scenes::require(loam_material_def_default(LOAM_LAW_DRUCKER_PRAGER, &sand, sizeof sand), "loam_material_def_default");
    scenes::require(loam_material_create(world_.get(), &sand, &material), "loam_material_create");
    loam_fill_def fill;
    scenes::require(loam_fill_def_default(&fill, sizeof fill), "loam_fill_def_default");
    fill.material = material;
    fill.region.kind = LOAM_REGION_SPHERE;
    fill.region.radius = options.radius - options.kernel_radius;
    fill.region.center[1] = options.radius + options.height;
    scenes::require(loam_particles_fill(world_.get(), &fill, &count_), "loam_particles_fill");
  }

  bool run() {
    std::printf("%llu grains, %zu vertices\nseconds, grains outside, the most so far, greatest speed in m/s\n",
                static_cast<unsigned long long>(count_), mesh_.positions.size() / 3);
    int most = 0;
    const int frames = static_cast<int>(60 * options_.seconds);
    for (int frame = 1; frame <= frames; ++frame) {
      world_.step(1.0f / 60);
      const int now = outside();
      most = std::max(most, now);
      if (frame % 60 != 0 && frame != frames) continue;
      std::printf("%g, %d, %d, %.3g\n", frame / 60.0, now, most, world_.statistics().max_speed);
      std::fflush(stdout);
    }
    std::printf("%d grains outside at most: %s\n", most, most == 0 ? "good" : "IT LEAKS");
    return most == 0;
  }

private:
  static loam_cloth_def cloth_definition(const Options &options, const meshes::Mesh &mesh) {
    loam_cloth_def def;
    scenes::require(loam_cloth_def_default(&def, sizeof def), "loam_cloth_def_default");
    def.mesh = mesh.view();
    def.position[1] = options.radius + options.height;
    return def;
  }

  int outside() const {
    const cloths::Cloth::Vertices now = cloth_.vertices();
    if (!now.finite()) throw std::runtime_error("the cloth is not finite");
    meshes::Mesh mesh = mesh_;
    mesh.positions.assign(now.positions.begin(), now.positions.end());
    const scenes::Snapshot sand = world_.snapshot();
    int result = 0;
    for (std::size_t i = 0; i < sand.count(); ++i) {
      const double point[3] = {double(sand.positions[3 * i]), double(sand.positions[3 * i + 1]),
                               double(sand.positions[3 * i + 2])};
      result += meshes::winding_number(mesh, point) < 0.5 ? 1 : 0;
    }
    return result;
  }

  Options options_;
  scenes::World world_;
  meshes::Mesh mesh_;
  cloths::Cloth cloth_;
  std::uint64_t count_ = 0;
};

} // namespace
} // namespace loam

int main(int argc, char **argv) {
  loam::Options options;
  CLI::App app("Drops a bag of cloth full of sand: does it leak?");
  app.add_option("--seconds", options.seconds, "10 unless said otherwise")->check(CLI::Range(0.1, 1e5));
  app.add_option("--height", options.height, "of the fall, metres; 1 unless said otherwise")->check(CLI::Range(0.0, 100.0));
  app.add_option("--kernel-radius", options.kernel_radius, "metres, 0.022 unless said otherwise")
      ->check(CLI::Range(0.01, 0.1));
  app.add_option("--threads", options.threads, "1 unless said otherwise")->check(CLI::Range(1u, 256u));
  CLI11_PARSE(app, argc, argv);
  try {
    return loam::Bag(options).run() ? 0 : 1;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
