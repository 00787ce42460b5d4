/* What every hard case must come through with: finite numbers, bounded speed and energy, all its particles, and the same bits when it is run again. */
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <gtest/gtest.h>
#include <vector>

#include "support/hooks.h"
#include "support/meshes.h"
#include "support/scenes.h"

namespace loam::test {

/* In the place of a solver: Gauss-Seidel with a warm start. */
constexpr std::uint32_t warm_gauss_seidel = 100;

/* A scene in several materials, and what is done to the world before each step. */
struct HardCase {
  std::vector<scenes::Scene> parts;
  loam_world_def def{};
  float step_seconds = 1.0f / 120;
  int steps = 60;
  double collider_speed = 0;                           // of the fastest point, m/s
  double greatest_gain = 1e30;                         // of kinetic and potential energy, over what there was at the start
  std::vector<loam_material_id> *materials = nullptr;  // receives those of the parts
  std::function<void(scenes::World &)> prepare;        // once, after the particles are in
  std::function<void(scenes::World &, int step)> each; // before every step

  explicit HardCase(std::uint32_t solver, std::vector<scenes::Scene> of = {}) : parts(std::move(of)) {
    scenes::require(loam_world_def_default(&def, sizeof def), "default");
    def.backend = LOAM_BACKEND_CPU;
    def.thread_count = 1;
    def.solver = solver == warm_gauss_seidel ? std::uint32_t(LOAM_SOLVER_GAUSS_SEIDEL) : solver;
    def.warm_start = solver == warm_gauss_seidel ? 1 : 0;
    def.substeps = 8;
    def.iterations = 4;
    def.particle_capacity = 20000;
  }
};

/* The defaults of the library, 60 frames a second, for ten seconds. */
inline HardCase ten_seconds(std::vector<scenes::Scene> parts) {
  HardCase hard(LOAM_SOLVER_GAUSS_SEIDEL, std::move(parts));
  loam_world_def defaults;
  scenes::require(loam_world_def_default(&defaults, sizeof defaults), "default");
  hard.def.substeps = defaults.substeps;
  hard.def.iterations = defaults.iterations;
  hard.step_seconds = 1.0f / 60;
  hard.steps = hooks::short_run() ? 30 : 600;
  return hard;
}

struct Outcome {
  scenes::Snapshot end;
  loam_statistics statistics{};           // of the last step
  double peak_speed = 0, peak_energy = 0; // kinetic, after any step
  double lowest = 0, start_energy = 0;    // of y; kinetic and potential above y = 0 at the start
  double peak_total = 0;                  // kinetic and potential, after any step
  double mean_height = 0;
  std::uint64_t speed_limited = 0, strain_limited = 0; // in all steps
  double stiffness_share = 1;                          // the least
};

/* Kinetic energy, and potential energy above y = 0. */
inline double energy_of(const scenes::Snapshot &now, double gravity) {
  double energy = 0;
  for (std::size_t i = 0; i < now.count(); ++i)
    if (now.inverse_masses[i] > 0) {
      const double mass = 1 / double(now.inverse_masses[i]);
      energy += mass * gravity * double(now.positions[3 * i + 1]);
      for (std::size_t k = 0; k < 3; ++k) energy += mass * std::pow(double(now.velocities[3 * i + k]), 2) / 2;
    }
  return energy;
}

/* Into the test's XML goes the worst of all the runs that it makes: scripts/stability.py puts it into docs/stability.md. */
inline void record(const Outcome &outcome, double seconds) {
  static const testing::TestInfo *of = nullptr;
  static Outcome worst;
  static double simulated, gain, lowest;
  const testing::TestInfo *now = testing::UnitTest::GetInstance()->current_test_info();
  if (now != of) {
    worst = {};
    simulated = gain = 0;
    lowest = 1e30;
    of = now;
  }
  worst.peak_speed = std::max(worst.peak_speed, outcome.peak_speed);
  if (outcome.start_energy > 0) gain = std::max(gain, outcome.peak_total / outcome.start_energy);
  lowest = std::min(lowest, outcome.lowest);
  worst.speed_limited += outcome.speed_limited;
  worst.strain_limited += outcome.strain_limited;
  worst.stiffness_share = std::min(worst.stiffness_share, outcome.stiffness_share);
  simulated += seconds;
  const auto property = [](const char *name, double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    testing::Test::RecordProperty(name, text);
  };
  property("peak_speed", worst.peak_speed);
  property("peak_energy", gain);
  property("lowest", lowest);
  property("simulated", simulated);
  property("speed_limited", double(worst.speed_limited));
  property("strain_limited", double(worst.strain_limited));
  property("stiffness_share", worst.stiffness_share);
}

/* What the table of docs/stability.md says about a test. */
inline void shows(const char *text) { testing::Test::RecordProperty("shows", text); }

/* The case's particles, and what else it prepares. */
inline void furnish(scenes::World &world, const HardCase &hard) {
  if (hard.materials != nullptr) hard.materials->clear();
  for (const scenes::Scene &part : hard.parts) {
    const loam_material_id material = world.add(part);
    if (hard.materials != nullptr) hard.materials->push_back(material);
  }
  if (hard.prepare) hard.prepare(world);
}

/* Steps after which a second run is compared: the violent part of a case comes first. */
inline int compared_steps(const HardCase &hard) { return std::max(1, hard.steps / 4); }

/* The hash is the state's after compared_steps(). */
inline Outcome run_once(const HardCase &hard, std::uint64_t &hash) {
  scenes::World world(hard.def);
  furnish(world, hard);
  const std::size_t count = world.snapshot().count();
  Outcome outcome;
  const double gravity = -double(hard.def.gravity[1]);
  outcome.peak_total = outcome.start_energy = energy_of(world.snapshot(), gravity);
  for (int step = 0; step < hard.steps; ++step) {
    if (hard.each) hard.each(world, step);
    world.step(hard.step_seconds);
    const loam_statistics now = world.statistics();
    EXPECT_EQ(now.non_finite, 0u) << "step " << step;
    outcome.peak_speed = std::max(outcome.peak_speed, now.max_speed);
    outcome.peak_energy = std::max(outcome.peak_energy, now.kinetic_energy);
    outcome.peak_total = std::max(outcome.peak_total, energy_of(world.snapshot(), gravity));
    outcome.speed_limited += now.speed_limited;
    outcome.strain_limited += now.strain_limited;
    outcome.stiffness_share = std::min(outcome.stiffness_share, now.stiffness_share);
    if (step + 1 == compared_steps(hard)) hash = world.state_hash();
    if (now.non_finite > 0) break;
  }
  outcome.end = world.snapshot();
  outcome.statistics = world.statistics();
  outcome.lowest = 1e30;
  for (std::size_t i = 1; i < outcome.end.positions.size(); i += 3) {
    outcome.lowest = std::min(outcome.lowest, double(outcome.end.positions[i]));
    outcome.mean_height += double(outcome.end.positions[i]) / double(count);
  }
  EXPECT_EQ(outcome.end.count(), count);
  for (const float x : outcome.end.positions) EXPECT_TRUE(std::isfinite(x));
  // Speed is bounded by r a substep. Contact acts once more after the limit and may hand back some of what it took.
  const double limit = double(hard.def.kernel_radius) / (double(hard.step_seconds) / hard.def.substeps);
  EXPECT_LE(outcome.peak_speed, 2 * limit + hard.collider_speed);
  EXPECT_LE(outcome.peak_total, hard.greatest_gain * outcome.start_energy);
  return outcome;
}

/* The same case up to compared_steps() once more, for the hash alone. */
inline std::uint64_t hash_of_a_second_run(const HardCase &hard) {
  scenes::World world(hard.def);
  furnish(world, hard);
  for (int step = 0; step < compared_steps(hard); ++step) {
    if (hard.each) hard.each(world, step);
    world.step(hard.step_seconds);
  }
  return world.state_hash();
}

/* Runs the case, and its beginning a second time, but not with a sanitizer. */
inline Outcome survive(const HardCase &hard) {
  std::uint64_t hash = 0;
  Outcome outcome = run_once(hard, hash);
  if (!hooks::short_run()) {
    EXPECT_EQ(hash_of_a_second_run(hard), hash);
  }
  record(outcome, double(hard.step_seconds) * hard.steps);
  return outcome;
}

inline loam_collider_id add_mesh(scenes::World &world, const meshes::Mesh &mesh, float friction = 0.6f, float x = 0,
                                 float y = 0, float z = 0) {
  loam_collider_def def;
  scenes::require(loam_collider_def_default(&def, sizeof def), "default");
  def.kind = LOAM_COLLIDER_MESH;
  def.mesh = mesh.view();
  def.friction = friction;
  def.position[0] = x;
  def.position[1] = y;
  def.position[2] = z;
  loam_collider_id id = 0;
  scenes::require(loam_collider_create(world.get(), &def, &id), "collider");
  return id;
}

/* A block of `edge` particles to a side whose lowest layer is `height` above the ground's, moved aside by x. */
inline scenes::Scene block(const loam_material_def &material, int edge, float height, float speed = 0, float x = 0,
                           float spacing = 0.01f) {
  scenes::Scene scene = scenes::drop_block(material, edge, height, speed, {.spacing = spacing});
  for (std::size_t i = 0; i < scene.positions.size(); i += 3) scene.positions[i] += x;
  return scene;
}
inline scenes::Scene without_planes(scenes::Scene scene) {
  scene.planes.clear();
  return scene;
}

/* How many particles are outside a closed mesh that stands at `at`. */
inline std::size_t outside(const std::vector<float> &positions, const meshes::Mesh &mesh, const float at[3]) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const double local[3] = {double(positions[i] - at[0]), double(positions[i + 1] - at[1]),
                             double(positions[i + 2] - at[2])};
    count += meshes::winding_number(mesh, local) < 0.5 ? 1 : 0;
  }
  return count;
}

/* A test of each solver: derive the suite from it and instantiate it with both_solvers() or every_solver() and solver_name. */
class OfASolver : public testing::TestWithParam<std::uint32_t> {};
inline auto both_solvers() { return testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI); }
inline auto every_solver() { return testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI, warm_gauss_seidel); }
inline std::string solver_name(const testing::TestParamInfo<std::uint32_t> &tested) {
  if (tested.param == warm_gauss_seidel) return "WarmStart";
  return tested.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel";
}

} // namespace loam::test
