// The CUDA backend through the public interface. Each test has two answers: where there is no device, that this is said as documented and
// nothing else is harmed; where there is one, that it computes what the CPU does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "device_memory.h"
#include "scenes.h"

namespace loam {
namespace {

loam_world_def definition(const scenes::Scene &scene, std::uint32_t backend) {
  loam_world_def def = scenes::world_def(scene);
  def.backend = backend;
  return def;
}

// A world on CUDA, or none after a look at how it was refused.
std::optional<scenes::World> cuda_world(const loam_world_def &def, const scenes::Scene &scene) {
  loam_world *world = reinterpret_cast<loam_world *>(&world); // must become null
  const loam_status status = loam_world_create(&def, &world);
  if (status == LOAM_OK) {
    loam_world_destroy(world);
    return scenes::World(def, scene);
  }
  const std::string text = loam_last_error();
  EXPECT_EQ(status, LOAM_ERROR_BACKEND_UNAVAILABLE) << text;
  EXPECT_EQ(world, nullptr);
  EXPECT_TRUE(text.starts_with("no CUDA device: ") || text.find(" cannot be used: ") != std::string::npos ||
              text == "this build of the library has no CUDA backend")
      << text;
  return std::nullopt;
}
std::optional<scenes::World> cuda_world(const scenes::Scene &scene) {
  return cuda_world(definition(scene, LOAM_BACKEND_CUDA), scene);
}

// x, y, z in the order of the ids, from whichever memory.
std::vector<float> rows(const scenes::World &world, const float *loam_particle_view::*column) {
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  scenes::require(loam_particles_map(world.get(), &view), "loam_particles_map");
  const auto count = static_cast<std::size_t>(view.count);
  std::vector<std::uint32_t> ids(count);
  std::vector<float> values(4 * count), ordered(3 * count);
  test::read_mapped(view, ids.data(), view.ids, count * sizeof(std::uint32_t));
  test::read_mapped(view, values.data(), view.*column, 4 * count * sizeof(float));
  scenes::require(loam_particles_unmap(world.get()), "loam_particles_unmap");
  for (std::size_t i = 0; i < count; ++i) std::copy_n(&values[4 * i], 3, &ordered[3 * ids[i]]);
  return ordered;
}

float greatest(const std::vector<float> &values) {
  float most = 0;
  for (float value : values) most = std::max(most, std::abs(value));
  return most;
}
float greatest_difference(const std::vector<float> &a, const std::vector<float> &b) {
  EXPECT_EQ(a.size(), b.size());
  float most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

TEST(CudaBackend, AutomaticChoiceFallsBackToTheCpu) {
  const scenes::Scene scene = scenes::drop_block(scenes::sand(), 4, 0);
  const bool there = cuda_world(scene).has_value();
  const scenes::World world(definition(scene, LOAM_BACKEND_AUTO), scene);
  std::uint32_t backend = 0;
  ASSERT_EQ(scenes::outcome(loam_world_get_backend(world.get(), &backend, nullptr)), "LOAM_OK");
  EXPECT_EQ(backend, static_cast<std::uint32_t>(there ? LOAM_BACKEND_CUDA : LOAM_BACKEND_CPU));
}

TEST(CudaBackend, RefusalLeavesOtherWorldsAlone) {
  const scenes::Scene scene = scenes::drop_block(scenes::sand(), 6, 0);
  scenes::World disturbed(definition(scene, LOAM_BACKEND_CPU), scene), alone(definition(scene, LOAM_BACKEND_CPU), scene);
  alone.step(0.01f);
  cuda_world(scene);
  disturbed.step(0.01f);
  EXPECT_EQ(disturbed.state_hash(), alone.state_hash());
}

// Both solve the same sequence of constraints. What differs is how sums over neighbours are folded, and fused multiply-adds.
TEST(CudaBackend, FirstSubstepHasTheCpusVelocities) {
  for (const loam_material_def &material : scenes::each_law())
    for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
      const scenes::Scene scene = scenes::jittered_block(material, 5000, 5);
      loam_world_def def = definition(scene, LOAM_BACKEND_CUDA);
      def.solver = solver;
      def.substeps = 1;
      std::optional<scenes::World> cuda = cuda_world(def, scene);
      if (!cuda) continue;
      def.backend = LOAM_BACKEND_CPU;
      scenes::World cpu(def, scene);
      cuda->step(5e-4f);
      cpu.step(5e-4f);
      const std::vector<float> expected = rows(cpu, &loam_particle_view::velocities);
      EXPECT_LT(greatest_difference(expected, rows(*cuda, &loam_particle_view::velocities)), 1e-4f * greatest(expected))
          << material.name << ", solver " << solver;
    }
}

// Sort, prefix sums, search and reductions at the size of many thread groups: with one wrong place the pairs would not be the CPU's to the last.
TEST(CudaBackend, PairsAndSumsOfALargeSceneAreTheCpus) {
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 100000, 5);
  loam_world_def def = definition(scene, LOAM_BACKEND_CUDA);
  def.substeps = 1;
  def.iterations = 1;
  std::optional<scenes::World> cuda = cuda_world(def, scene);
  if (!cuda) return;
  def.backend = LOAM_BACKEND_CPU;
  scenes::World cpu(def, scene);
  cuda->step(5e-4f);
  cpu.step(5e-4f);
  const loam_statistics a = cpu.statistics(), b = cuda->statistics();
  EXPECT_EQ(a.particles, b.particles);
  EXPECT_EQ(a.pairs, b.pairs);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(b.non_finite, 0u);
  EXPECT_NEAR(a.kinetic_energy, b.kinetic_energy, 1e-5 * a.kinetic_energy);
  EXPECT_NEAR(a.mean_speed, b.mean_speed, 1e-5 * a.mean_speed);
  EXPECT_NEAR(a.max_speed, b.max_speed, 1e-4 * a.max_speed);
}

TEST(CudaBackend, ColumnCollapsesAsOnTheCpu) {
  const scenes::Scene scene = scenes::axisymmetric_column(scenes::sand(), 10, 1);
  std::optional<scenes::World> cuda = cuda_world(scene);
  if (!cuda) return;
  scenes::World cpu(definition(scene, LOAM_BACKEND_CPU), scene);
  for (int frame = 0; frame < 30; ++frame) {
    cuda->step(0.01f);
    cpu.step(0.01f);
  }
  const auto centre = [](const std::vector<float> &x) {
    double sum = 0;
    for (std::size_t i = 1; i < x.size(); i += 3) sum += static_cast<double>(x[i]);
    return 3 * sum / static_cast<double>(x.size());
  };
  const std::vector<float> expected = rows(cpu, &loam_particle_view::positions),
                           found = rows(*cuda, &loam_particle_view::positions);
  EXPECT_NEAR(scenes::run_out(found, scene), scenes::run_out(expected, scene), 0.03);
  EXPECT_NEAR(centre(found), centre(expected), 0.01 * centre(expected));
  EXPECT_EQ(cuda->statistics().non_finite, 0u);
}

TEST(CudaBackend, SameBitsTwice) {
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 20000, 5);
    loam_world_def def = definition(scene, LOAM_BACKEND_CUDA);
    def.solver = solver;
    std::uint64_t hashes[2] = {};
    for (std::uint64_t &hash : hashes) {
      std::optional<scenes::World> cuda = cuda_world(def, scene);
      if (!cuda) return;
      for (int frame = 0; frame < 3; ++frame) cuda->step(0.01f);
      hash = cuda->state_hash();
    }
    EXPECT_EQ(hashes[0], hashes[1]) << "solver " << solver;
  }
}

TEST(CudaBackend, MappedPointersAreDeviceMemory) {
  const scenes::Scene scene = scenes::drop_block(scenes::sand(), 8, 0);
  std::optional<scenes::World> cuda = cuda_world(scene);
  if (!cuda) return;
  cuda->step(0.01f);
  loam_particle_view view = {};
  view.struct_size = sizeof view;
  ASSERT_EQ(scenes::outcome(loam_particles_map(cuda->get(), &view)), "LOAM_OK");
  EXPECT_EQ(view.memory, static_cast<std::uint32_t>(LOAM_MEMORY_CUDA_DEVICE));
  const test::DeviceMemory memory;
  for (const void *pointer : std::initializer_list<const void *>{view.ids, view.positions, view.velocities, view.materials,
                                                                 view.strains, view.densities})
    EXPECT_TRUE(memory.owns(pointer)) << pointer;
  EXPECT_EQ(scenes::outcome(loam_particles_unmap(cuda->get())), "LOAM_OK");
}

// The device's times come from events; together they are no longer than the step.
TEST(CudaBackend, StageTimesAddUpToTheStep) {
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 20000, 5);
  std::optional<scenes::World> cuda = cuda_world(scene);
  if (!cuda) return;
  cuda->step(0.01f);
  cuda->step(0.01f);
  double sum = 0;
  for (const loam_stage &stage : cuda->stages()) {
    EXPECT_GE(stage.seconds, 0.0) << stage.name;
    sum += stage.seconds;
  }
  EXPECT_GT(sum, 0.0);
  EXPECT_LE(sum, 1.05 * cuda->statistics().step_seconds);
}

// More than the device has: refused with the size, and the device stays usable.
TEST(CudaBackend, OutOfDeviceMemoryIsAStatus) {
  const scenes::Scene scene = scenes::drop_block(scenes::sand(), 6, 0);
  std::optional<scenes::World> cuda = cuda_world(scene);
  if (!cuda) return;
  loam_world_def def = definition(scene, LOAM_BACKEND_CUDA);
  def.particle_capacity = 268435456;
  loam_world *world = nullptr;
  const loam_status status = loam_world_create(&def, &world);
  const std::string text = loam_last_error();
  if (status == LOAM_OK) { // a device with room for it
    loam_world_destroy(world);
  } else {
    EXPECT_EQ(status, LOAM_ERROR_OUT_OF_MEMORY) << text;
    EXPECT_NE(text.find("bytes"), std::string::npos) << text;
  }
  cuda->step(0.01f);
}

} // namespace
} // namespace loam
