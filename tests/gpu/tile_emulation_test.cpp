// The CUDA executor's text, on the CPU: visit order, layout of the lists, teams and folded sums over emulated tiles, against the CPU executor. What is
// left for a machine with a GPU to prove are the launches, CUB and the ordering of a tile's threads.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <vector>

#include "cpu/kernel_table.h"
#include "emulated_machine.h"
#include "scene/material.h"
#include "scenes.h"
#include "solver/solver.h"

namespace loam {
namespace {

using EmulatedSolver = Solver<TileExecutor<emulation::Machine>>;

enum class Runs { cpu, emulated, emulated_backwards };

struct Settings {
  bool jacobi = false;
  std::uint32_t substeps = 8, iterations = 3;
  Vec3<float> gravity{0, -9.81f, 0};
};

// One solver with a scene in it. With two materials, particles take them by turns.
class Rig {
public:
  Rig(Runs runs, const scenes::Scene &scene, const Settings &settings, const std::vector<loam_material_def> &materials)
      : count_(scene.count()) {
    const SolverSettings solver = {scene.spacing, 0.2f, 0.75f, 20.0f, settings.jacobi, false, count_, 0};
    ExecutionSettings execution = {};
    execution.thread_count = runs == Runs::emulated_backwards ? 2 : 1;
    execution.instruction_set = best_instruction_set();
    if (runs == Runs::cpu)
      backend_ = make_cpu_backend(solver, execution);
    else
      backend_ = std::make_unique<EmulatedSolver>(solver, execution);

    std::vector<SolverMaterial> list;
    for (const loam_material_def &def : materials) list.push_back({make_law(def), def.name, true});
    backend_->set_materials(list);
    for (std::size_t i = 0; i < count_; ++i) {
      const std::size_t material = i % materials.size();
      NewParticles particles = {};
      particles.material = static_cast<std::uint32_t>(material);
      particles.first_id = static_cast<std::uint32_t>(i);
      particles.volume = scene.volume();
      particles.inverse_mass = 1.0f / (materials[material].density * scene.volume());
      particles.positions = &scene.positions[3 * i];
      particles.velocities = scene.velocities.empty() ? nullptr : &scene.velocities[3 * i];
      particles.count = 1;
      backend_->add_particles(particles);
    }
    input_.substeps = settings.substeps;
    input_.iterations = settings.iterations;
    input_.gravity = settings.gravity;
    for (const scenes::Plane &plane : scene.planes) { // the ground: planes of these scenes face up
      const Pose pose = {{plane.point[0], plane.point[1], plane.point[2]}, {0, 0, 0, 1}};
      input_.colliders.push_back({LOAM_COLLIDER_PLANE, plane.friction, pose, pose, -1});
    }
  }
  void step(float seconds) {
    input_.seconds = seconds;
    backend_->step(input_);
  }
  Backend &backend() { return *backend_; }

  // In the order of the ids.
  std::vector<Vec3<float>> positions() { return rows(&loam_particle_view::positions); }
  std::vector<Vec3<float>> velocities() { return rows(&loam_particle_view::velocities); }

private:
  std::vector<Vec3<float>> rows(const float *loam_particle_view::*column) {
    loam_particle_view view = {};
    backend_->map(view);
    std::vector<Vec3<float>> rows(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      const float *row = view.*column + 4 * i;
      rows[view.ids[i]] = {row[0], row[1], row[2]};
    }
    return rows;
  }
  std::size_t count_;
  std::unique_ptr<Backend> backend_;
  StepInput input_{};
};

float greatest_difference(const std::vector<Vec3<float>> &a, const std::vector<Vec3<float>> &b) {
  float most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, length(a[i] - b[i]));
  return most;
}
float root_mean_square(const std::vector<Vec3<float>> &a) {
  double sum = 0;
  for (const Vec3<float> &v : a) sum += static_cast<double>(dot(v, v));
  return static_cast<float>(std::sqrt(sum / static_cast<double>(a.size())));
}

struct Law {
  loam_material_def material;
  friend void PrintTo(const Law &law, std::ostream *out) { *out << law.material.name; }
};
class EachLaw : public testing::TestWithParam<Law> {};

// Both take the particles in the same order, so only the rounding of differently folded sums is left.
TEST_P(EachLaw, AgreesWithTheCpuToRounding) {
  const scenes::Scene scene = scenes::jittered_block(GetParam().material, 700, 5);
  for (const bool jacobi : {false, true}) {
    Settings settings;
    settings.jacobi = jacobi;
    Rig cpu(Runs::cpu, scene, settings, {scene.material}), emulated(Runs::emulated, scene, settings, {scene.material});
    cpu.step(0.004f);
    emulated.step(0.004f);
    const auto expected = cpu.velocities();
    EXPECT_LT(greatest_difference(expected, emulated.velocities()), 2e-5f * root_mean_square(expected)) << jacobi;
    const loam_statistics a = cpu.backend().statistics(), b = emulated.backend().statistics();
    EXPECT_EQ(a.pairs, b.pairs);
    EXPECT_EQ(a.contacts, b.contacts);
    EXPECT_NEAR(a.residual, b.residual, 1e-4);
    EXPECT_NEAR(a.kinetic_energy, b.kinetic_energy, 1e-5 * a.kinetic_energy);
  }
}

INSTANTIATE_TEST_SUITE_P(TileEmulation, EachLaw,
                         testing::Values(Law{scenes::sand()}, Law{scenes::plasticine()}, Law{scenes::rubber()}),
                         [](const auto &info) { return std::string(info.param.material.name); });

// Impulses between free particles cancel: a lost or doubled write to a neighbour would show.
TEST(TileEmulation, GaussSeidelKeepsMomentum) {
  scenes::Scene scene = scenes::jittered_block(scenes::rubber(1e6f), 700, 20);
  scene.planes.clear();
  Settings settings;
  settings.gravity = {0, 0, 0};
  Rig emulated(Runs::emulated, scene, settings, {scene.material});
  emulated.step(1e-6f);
  const loam_statistics before = emulated.backend().statistics();
  emulated.step(0.01f);
  const loam_statistics after = emulated.backend().statistics();
  const double scale = before.mean_speed * static_cast<double>(scene.material.density * scene.volume()) * 700;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(before.momentum[k], after.momentum[k], 1e-5 * scale);
}

struct Case {
  const char *name;
  std::size_t particles;
  int materials;
  float second_block; // spacings away; 0: there is none
  friend void PrintTo(const Case &c, std::ostream *out) { *out << c.name; }
};
class EachOrder : public testing::TestWithParam<Case> {};

// Blocks of a pass touch no common particle, every particle has its turns, and what a GPU does at once may happen in any order. The cases: the two
// colourings, passes of two materials, and matter so far apart that cells are wrapped around.
TEST_P(EachOrder, IsTheCpusAndFreeOfConflicts) {
  const Case &c = GetParam();
  scenes::Scene scene = scenes::jittered_block(scenes::sand(), c.particles, 5);
  if (c.second_block > 0) {
    const std::size_t first = scene.positions.size();
    for (std::size_t i = 0; i < first; ++i) {
      scene.positions.push_back(scene.positions[i] + (i % 3 == 1 ? 0 : c.second_block * scene.spacing));
      scene.velocities.push_back(scene.velocities[i]);
    }
  }
  std::vector<loam_material_def> materials = {scenes::sand()};
  if (c.materials > 1) materials.push_back(scenes::plasticine());
  Settings settings;
  settings.substeps = 2;
  settings.iterations = 2;
  emulation::report = {};
  Rig cpu(Runs::cpu, scene, settings, materials), forwards(Runs::emulated, scene, settings, materials),
      backwards(Runs::emulated_backwards, scene, settings, materials);
  cpu.step(0.002f);
  forwards.step(0.002f);
  EXPECT_EQ(emulation::report.conflicts, 0);
  // Every particle once for its constraint and once for its distances, in each iteration.
  EXPECT_EQ(emulation::report.ordered_visits, static_cast<long>(scene.count()) * 2 * 2 * 2);
  const auto expected = cpu.velocities();
  EXPECT_LT(greatest_difference(expected, forwards.velocities()), 2e-5f * root_mean_square(expected));
  EXPECT_EQ(cpu.backend().statistics().pairs, forwards.backend().statistics().pairs);

  backwards.step(0.002f);
  EXPECT_EQ(forwards.backend().state_hash(), backwards.backend().state_hash());
}

INSTANTIATE_TEST_SUITE_P(TileEmulation, EachOrder,
                         testing::Values(Case{"small_blocks", 1500, 1, 0}, Case{"large_blocks", 30000, 1, 0},
                                         Case{"two_materials", 1500, 2, 0}, Case{"scattered", 500, 1, 707}),
                         [](const auto &info) { return std::string(info.param.name); });

// The whole scene: a column of sand that collapses.
TEST(TileEmulation, ColumnCollapseAgreesWithTheCpu) {
  const scenes::Scene scene = scenes::axisymmetric_column(scenes::sand(), 6, 1);
  Settings settings;
  settings.substeps = 16;
  Rig cpu(Runs::cpu, scene, settings, {scene.material}), emulated(Runs::emulated, scene, settings, {scene.material});
  for (int frame = 0; frame < 12; ++frame) {
    cpu.step(1.0f / 40);
    emulated.step(1.0f / 40);
  }
  const auto flat = [](const std::vector<Vec3<float>> &rows) {
    std::vector<float> values;
    for (const Vec3<float> &row : rows) values.insert(values.end(), {row.x, row.y, row.z});
    return values;
  };
  const auto height = [](const std::vector<Vec3<float>> &rows) {
    double sum = 0;
    for (const Vec3<float> &row : rows) sum += static_cast<double>(row.y);
    return sum / static_cast<double>(rows.size());
  };
  const auto expected = cpu.positions(), found = emulated.positions();
  const double run_out = scenes::run_out(flat(expected), scene, 0.95);
  EXPECT_GT(run_out, 0.1); // it did collapse
  EXPECT_NEAR(run_out, scenes::run_out(flat(found), scene, 0.95), 0.04);
  EXPECT_NEAR(height(expected), height(found), 0.02 * height(expected));
  EXPECT_EQ(emulated.backend().statistics().non_finite, 0u);
}

} // namespace
} // namespace loam
