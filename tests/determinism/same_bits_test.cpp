/* The same inputs give the same bits, run after run, for any number of threads, any job system and any instruction set. */
#include "settling_scene.h"

namespace loam {
namespace {

using test::SettlingScene;

/* Whether the machine has it. */
bool has(std::uint32_t instruction_set) {
  loam_world_def def = SettlingScene().definition();
  def.instruction_set = instruction_set;
  loam_world *world = nullptr;
  const bool made = loam_world_create(&def, &world) == LOAM_OK;
  loam_world_destroy(world);
  return made;
}

class SameBits : public testing::TestWithParam<std::uint32_t> {
protected:
  static int frames() { return hooks::short_run() ? 5 : 100; }
  loam_world_def definition() const {
    loam_world_def def = scene_.definition();
    def.solver = GetParam();
    return def;
  }
  /* Of the plain run: one thread, the widest instruction set. */
  std::uint64_t expected() const {
    static std::uint64_t hashes[2] = {};
    std::uint64_t &hash = hashes[GetParam()];
    if (hash == 0) hash = scene_.hash_after(definition(), frames());
    return hash;
  }
  SettlingScene scene_;
};

TEST_P(SameBits, RunAfterRun) { EXPECT_EQ(scene_.hash_after(definition(), frames()), expected()); }

TEST_P(SameBits, ForAnyNumberOfThreads) {
  for (const std::uint32_t threads : {2u, 5u}) {
    loam_world_def def = definition();
    def.thread_count = threads;
    const std::uint64_t hash = scene_.hash_after(def, frames());
    if (!hooks::only_races) {
      EXPECT_EQ(hash, expected()) << threads;
    }
  }
}

/* How often it iterates, and into how many substeps it cuts a step, follows from sums over all particles. */
TEST_P(SameBits, ForAnyNumberOfThreadsAndInstructionSetWithATolerance) {
  loam_accuracy_def accuracy;
  ASSERT_EQ(loam_accuracy_def_default(&accuracy, sizeof accuracy), LOAM_OK);
  accuracy.mode = LOAM_ACCURACY_TOLERANCE;
  accuracy.tolerance = 0.05f;
  accuracy.substeps = 0;
  accuracy.iterations = 20;
  const int frames = std::min(this->frames(), 6);
  loam_world_def def = definition();
  const std::uint64_t alone = scene_.hash_after(def, frames, &accuracy);
  def.thread_count = 5;
  EXPECT_EQ(scene_.hash_after(def, frames, &accuracy), alone);
  if (hooks::short_run()) return;
  def.instruction_set = LOAM_INSTRUCTION_SET_PORTABLE;
  EXPECT_EQ(scene_.hash_after(def, frames, &accuracy), alone);
}

TEST_P(SameBits, OnSixteenThreadsOfTheHost) {
  // Far more threads than a small machine has processors: fewer frames, in every order that they preempt each other.
  hooks::ThreadJobs jobs;
  loam_world_def def = definition();
  const int frames = hooks::only_races ? 2 : 5;
  const std::uint64_t alone = scene_.hash_after(def, frames);
  def.thread_count = 16;
  def.job_system = jobs.hooks();
  for (int round = 0; round < 2; ++round) EXPECT_EQ(scene_.hash_after(def, frames), alone);
  EXPECT_GE(jobs.enqueued, std::uint64_t(30 * frames));
}

TEST_P(SameBits, ForEveryInstructionSetOfTheMachine) {
  int tried = 0;
  for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set) {
    loam_world_def def = definition();
    def.instruction_set = set;
    if (!has(set)) continue;
    ++tried;
    EXPECT_EQ(scene_.hash_after(def, frames()), expected()) << "instruction set " << set;
  }
  EXPECT_GE(tried, 1);
}

INSTANTIATE_TEST_SUITE_P(Solvers, SameBits, testing::Values(LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI),
                         [](const auto &tested) { return tested.param == LOAM_SOLVER_JACOBI ? "Jacobi" : "GaussSeidel"; });

/* Every law in one block, particles of all materials beside each other. */
TEST(SameBitsOfEveryLaw, ForAnyNumberOfThreadsAndInstructionSet) {
  const std::vector<loam_material_def> materials = scenes::each_law();
  const scenes::Scene block = scenes::jittered_block(materials[0], 100 * materials.size());
  const auto hash = [&](std::uint32_t solver, std::uint32_t threads, std::uint32_t set) {
    loam_world_def def = scenes::world_def(block);
    def.solver = solver;
    def.thread_count = threads;
    def.instruction_set = set;
    def.substeps = 4;
    def.warm_start = 1;
    scenes::World world(def);
    for (std::size_t m = 0; m < materials.size(); ++m) {
      scenes::Scene share = block;
      share.material = materials[m];
      share.positions.clear();
      share.velocities.clear();
      for (std::size_t i = m; i < block.count(); i += materials.size()) {
        share.positions.insert(share.positions.end(), &block.positions[3 * i], &block.positions[3 * i] + 3);
        share.velocities.insert(share.velocities.end(), &block.velocities[3 * i], &block.velocities[3 * i] + 3);
      }
      if (m > 0) share.planes.clear();
      world.add(share);
    }
    for (int frame = 0; frame < (hooks::only_races ? 1 : 10); ++frame) world.step(2e-3f);
    EXPECT_EQ(world.statistics().non_finite, 0u);
    return world.state_hash();
  };
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    const std::uint64_t expected = hash(solver, 3, LOAM_INSTRUCTION_SET_AUTO);
    if (hooks::only_races) continue;
    EXPECT_EQ(hash(solver, 1, LOAM_INSTRUCTION_SET_AUTO), expected);
    for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set)
      if (has(set)) {
        EXPECT_EQ(hash(solver, 1, set), expected) << set;
      }
  }
}

/* A block falls onto a layer that is falling asleep: particles sleep and wake. */
TEST(SameBitsOfSleep, ForAnyNumberOfThreadsAndInstructionSet) {
  const scenes::Scene layer = scenes::slab(scenes::sand(), 24, 0.2f, 5);
  scenes::Scene block = scenes::drop_block(scenes::sand(), 5, 0.15f);
  block.planes.clear();
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    if (solver == LOAM_SOLVER_JACOBI && hooks::short_run()) continue;
    std::uint64_t most = 0;
    const auto hash = [&](std::uint32_t threads, std::uint32_t set) {
      loam_world_def def = scenes::world_def(layer);
      def.particle_capacity += block.count();
      def.solver = solver;
      def.thread_count = threads;
      def.instruction_set = set;
      def.substeps = hooks::only_races ? 4 : 8;
      def.sleep_speed = 0.02f;
      def.sleep_delay = 0.05f;
      scenes::World world(def, layer);
      world.add(block);
      bool woken = false;
      for (int frame = 0; frame < 30; ++frame) {
        world.step(1.0f / 120);
        const std::uint64_t now = world.statistics().sleeping;
        woken = woken || now + 50 < most;
        most = std::max(most, now);
      }
      EXPECT_GT(most, 100u);
      EXPECT_TRUE(woken);
      return world.state_hash();
    };
    const std::uint64_t expected = hash(hooks::only_races ? 2 : 3, LOAM_INSTRUCTION_SET_AUTO);
    if (hooks::only_races) continue;
    EXPECT_EQ(hash(1, LOAM_INSTRUCTION_SET_AUTO), expected);
    for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set)
      if (has(set)) {
        EXPECT_EQ(hash(2, set), expected) << set;
      }
  }
}

/* Above 30000 particles cells are coloured in another way. */
TEST(SameBitsOfALargeScene, ForAnyNumberOfThreadsAndInstructionSet) {
  if (hooks::short_run()) GTEST_SKIP() << "too slow with a sanitizer";
  const scenes::Scene scene = scenes::jittered_block(scenes::sand(), 32000);
  for (const std::uint32_t solver : {LOAM_SOLVER_GAUSS_SEIDEL, LOAM_SOLVER_JACOBI}) {
    const auto hash = [&](std::uint32_t threads, std::uint32_t set) {
      loam_world_def def = scenes::world_def(scene);
      def.solver = solver;
      def.thread_count = threads;
      def.instruction_set = set;
      def.substeps = 2;
      def.iterations = 3;
      scenes::World world(def, scene);
      for (int frame = 0; frame < 3; ++frame) world.step(2e-3f);
      return world.state_hash();
    };
    const std::uint64_t expected = hash(1, LOAM_INSTRUCTION_SET_AUTO);
    EXPECT_EQ(hash(2, LOAM_INSTRUCTION_SET_AUTO), expected);
    EXPECT_EQ(hash(5, LOAM_INSTRUCTION_SET_PORTABLE), expected);
  }
}

} // namespace
} // namespace loam
