/* loam-effects: what each effect costs in a scene, as JSON on the standard output; scripts/effects.py makes the page of it.
 *
 * Times are of the fastest step: whatever else the machine does only ever adds time. The scene without an effect and the one with it are stepped in
 * turns, so that both see the same machine. */
#include "effects.h"

#include <algorithm>
#include <chrono>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

namespace {

using namespace loam;
using namespace loam::effects;
using nlohmann::ordered_json;

constexpr int warm_up_steps = 40; /* the sand comes to rest */

struct Options {
  std::size_t particles = 16384, pile = 65536;
  int steps = 12;
  std::uint32_t threads = 1;
  std::string only;
};

class Running {
public:
  explicit Running(const Setup &setup) : each_step_(setup.each_step), world_(setup.def) {
    const loam_material_id material = world_.add(setup.scene);
    for (const auto &addition : setup.additions) addition(world_.get(), material);
  }

  void step(bool measured) {
    const auto begin = std::chrono::steady_clock::now();
    world_.step(substeps * substep_seconds);
    if (each_step_) each_step_(world_.get());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!measured) return;
    seconds_ = std::min(seconds_, seconds);
    for (const loam_stage &stage : world_.stages()) {
      const auto [found, fresh] = stages_.try_emplace(stage.name, stage.seconds);
      if (fresh)
        order_.emplace_back(stage.name);
      else
        found->second = std::min(found->second, stage.seconds);
    }
  }

  ordered_json result() const {
    const loam_statistics statistics = world_.statistics();
    if (statistics.non_finite > 0) throw std::runtime_error("particles are not finite");
    ordered_json json;
    json["seconds"] = seconds_;
    json["max_speed"] = statistics.max_speed;
    json["particles"] = statistics.particles;
    for (const std::string &name : order_) json["stages"][name] = stages_.at(name);
    std::uint32_t count = 0;
    scenes::require(loam_world_get_memory(world_.get(), nullptr, 0, &count), "loam_world_get_memory");
    std::vector<loam_memory> rows(count);
    scenes::require(loam_world_get_memory(world_.get(), rows.data(), count, &count), "loam_world_get_memory");
    for (const loam_memory &row : rows) json["memory"][row.effect] = row.bytes;
    return json;
  }

  scenes::World &world() { return world_; }

private:
  std::function<void(loam_world *)> each_step_;
  scenes::World world_;
  double seconds_ = 1e9;
  std::map<std::string, double> stages_;
  std::vector<std::string> order_;
};

std::unique_ptr<Running> run(const Options &options, Change change) {
  Setup setup = sand_in_a_box(options.particles, options.threads);
  if (change != nullptr) change(setup);
  return std::make_unique<Running>(setup);
}

ordered_json measure(const Options &options, const Effect &effect) {
  const auto without = run(options, effect.without), with = run(options, effect.with);
  for (int step = 0; step < warm_up_steps + options.steps; ++step) {
    without->step(step >= warm_up_steps);
    with->step(step >= warm_up_steps);
  }
  return {{"group", effect.group},
          {"name", effect.name},
          {"scene", effect.scene},
          {"without", without->result()},
          {"with", with->result()}};
}

/* A pile that falls asleep: a step of it awake, the same asleep, and how many of its particles are awake after the step in which it is hit. */
ordered_json measure_sleep(const Options &options) {
  /* A cone of 20 degrees has pi/3 tan(20) radius^3 particles. */
  const int radius = int(std::cbrt(double(options.pile) / 0.381) + 0.5);
  Setup setup;
  setup.scene = scenes::resting_pile(scenes::sand(), radius, 20);
  setup.def = scenes::world_def(setup.scene);
  setup.def.particle_capacity += 8;
  setup.def.substeps = substeps;
  setup.def.thread_count = options.threads;
  Setup sleeping = setup;
  sleeping.def.sleep_speed = 0.2f * setup.def.kernel_radius;

  Running pile(sleeping);
  scenes::World &world = pile.world();
  int steps = 0;
  for (; world.statistics().sleeping < setup.scene.count() && steps < 4000; ++steps) {
    pile.step(false);
    if (steps % 20 == 0)
      std::fprintf(stderr, "\r  %5.2f s, %llu of %zu asleep ", steps * substeps * double(substep_seconds),
                   static_cast<unsigned long long>(world.statistics().sleeping), setup.scene.count());
  }
  std::fprintf(stderr, "\n");
  if (world.statistics().sleeping < setup.scene.count()) throw std::runtime_error("the pile does not fall asleep");
  for (int step = 0; step < 20; ++step) pile.step(true);
  const ordered_json asleep = pile.result();

  /* Awake: the same matter in a world without sleep, for as many steps as tell its time. */
  Running awake(setup);
  for (int step = 0; step < warm_up_steps + options.steps; ++step) awake.step(step >= warm_up_steps);

  /* A grain at 5 m/s, a kernel radius or so over the top. */
  const scenes::Snapshot before = world.snapshot();
  float top = 0;
  for (std::size_t i = 1; i < before.positions.size(); i += 3) top = std::max(top, before.positions[i]);
  const float position[3] = {0, top + 2.5f * setup.def.kernel_radius, 0}, velocity[3] = {0, -5, 0};
  loam_material_def def = setup.scene.material;
  loam_material_id material;
  scenes::require(loam_material_create(world.get(), &def, &material), "loam_material_create");
  loam_particles_def hit;
  scenes::require(loam_particles_def_default(&hit, sizeof hit), "loam_particles_def_default");
  hit.material = material;
  hit.count = 1;
  hit.positions = position;
  hit.velocities = velocity;
  scenes::require(loam_particles_add(world.get(), &hit, nullptr), "loam_particles_add");
  ordered_json after = ordered_json::array();
  for (int step = 0; step < 8; ++step) {
    pile.step(false);
    const scenes::Snapshot now = world.snapshot();
    double moved = 0;
    for (std::size_t i = 0; i < before.positions.size(); ++i)
      moved = std::max(moved, double(std::abs(now.positions[i] - before.positions[i])));
    const loam_statistics statistics = world.statistics();
    after.push_back({{"grain_height", now.positions[before.positions.size() + 1]},
                     {"awake", statistics.particles - statistics.sleeping},
                     {"pile_moved_by_at_most", moved},
                     {"seconds", statistics.step_seconds}});
  }
  return {{"particles", setup.scene.count()},
          {"seconds_until_asleep", steps * substeps * double(substep_seconds)},
          {"pile_top", top},
          {"awake", awake.result()},
          {"asleep", asleep},
          {"hit", after}};
}

} // namespace

int main(int argument_count, char **arguments) {
  Options options;
  CLI::App app("What each effect costs in a scene. Writes JSON to the standard output.");
  app.add_option("--particles", options.particles, "of the sand in a box")->check(CLI::Range(64, 4 << 20));
  app.add_option("--steps", options.steps, "measured steps of each scene")->check(CLI::Range(1, 10000));
  app.add_option("--threads", options.threads, "of the library")->check(CLI::Range(1, 256));
  app.add_option("--only", options.only, "effects whose name has this in it; 'sand' for the sand alone");
  app.add_option("--pile", options.pile, "particles of the pile that falls asleep; 0: no pile")
      ->check(CLI::Range(0, 4 << 20));
  CLI11_PARSE(app, argument_count, arguments);
  try {
    ordered_json json;
    json["options"] = {{"particles", options.particles},
                       {"threads", options.threads},
                       {"substeps", substeps},
                       {"substep_seconds", substep_seconds},
                       {"iterations", sand_in_a_box(8, 1).def.iterations}};
    const auto sand = run(options, nullptr);
    for (int step = 0; step < warm_up_steps + options.steps; ++step) sand->step(step >= warm_up_steps);
    json["sand"] = sand->result();
    const std::vector<Effect> effects = all();
    std::size_t done = 0;
    json["effects"] = ordered_json::array();
    for (const Effect &effect : effects) {
      ++done;
      if (effect.name.find(options.only) == std::string::npos) continue;
      std::fprintf(stderr, "%2zu/%zu  %s\n", done, effects.size(), effect.name.c_str());
      json["effects"].push_back(measure(options, effect));
    }
    if (options.pile > 0) {
      std::fprintf(stderr, "a pile that falls asleep\n");
      json["sleep"] = measure_sleep(options);
    }
    std::printf("%s\n", json.dump(1).c_str());
  } catch (const std::exception &error) {
    std::fprintf(stderr, "loam-effects: %s\n", error.what());
    return 1;
  }
  return 0;
}
