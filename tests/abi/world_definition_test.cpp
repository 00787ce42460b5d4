/* loam_world_create: every field of the definition, wrong in every way; and at the ends of its range. */

#include "small_world.h"
#include "support/hooks.h"

namespace loam {
namespace {

using test::infinity;
using test::nan;

loam_world_def good() {
  loam_world_def def;
  EXPECT_EQ(loam_world_def_default(&def, sizeof def), LOAM_OK);
  def.backend = LOAM_BACKEND_CPU;
  def.thread_count = 1;
  def.particle_capacity = 10;
  return def;
}

std::string created(const loam_world_def &def) {
  loam_world *world = nullptr;
  const std::string outcome = scenes::outcome(loam_world_create(&def, &world));
  EXPECT_EQ(world != nullptr, outcome == "LOAM_OK");
  loam_world_destroy(world);
  return outcome;
}

void refused(const loam_world_def &def, const std::vector<std::string> &parts) {
  auto *world = reinterpret_cast<loam_world *>(std::uintptr_t(8));
  EXPECT_STREQ(loam_status_name(loam_world_create(&def, &world)), "LOAM_ERROR_INVALID_ARGUMENT");
  EXPECT_EQ(world, nullptr); // on failure it is null
  test::expect_error_names(parts);
}

TEST(WorldDefinition, RefusesNullArguments) {
  loam_world_def def = good();
  loam_world *world = nullptr;
  EXPECT_EQ(loam_world_create(&def, nullptr), LOAM_ERROR_INVALID_ARGUMENT);
  test::expect_error_names({"world"});
  EXPECT_EQ(loam_world_create(nullptr, &world), LOAM_ERROR_INVALID_ARGUMENT);
  test::expect_error_names({"def"});
  EXPECT_EQ(loam_world_destroy(nullptr), LOAM_OK);
}

TEST(WorldDefinition, RefusesUnknownSizes) {
  for (const std::uint32_t size :
       {0u, 1u, 4u, unsigned(sizeof(loam_world_def) - 1), unsigned(sizeof(loam_world_def) + 1), ~0u}) {
    loam_world_def def = good();
    def.struct_size = size;
    refused(def, {"struct_size", std::to_string(size)});
  }
}

/* What follows in the host's memory is not read. */
TEST(WorldDefinition, TakesThatOfAnOlderHost) {
  loam_world_def def = good();
  def.struct_size = offsetof(loam_world_def, warm_start);
  def.warm_start = ~0u;
  EXPECT_EQ(created(def), "LOAM_OK");
}

TEST(WorldDefinition, RefusesEveryFloatOutOfItsRange) {
  struct Field {
    const char *name;
    float loam_world_def::*member;
    std::vector<float> bad, good;
  };
  const Field fields[] = {
      {"kernel_radius", &loam_world_def::kernel_radius, {0, -0.01f, 0.9e-6f, 1.1e6f}, {1e-6f, 1e6f}},
      {"velocity_smoothing", &loam_world_def::velocity_smoothing, {-1e-6f, 1.01e4f, 1e30f}, {0, 1e4f}},
      {"minimum_distance", &loam_world_def::minimum_distance, {-0.01f, 1.01f}, {0, 1}},
      {"gradient_cutoff", &loam_world_def::gradient_cutoff, {0, -1, 0.009f, 1.01f}, {0.01f, 1}},
  };
  for (const Field &field : fields) {
    std::vector<float> bad = field.bad;
    bad.insert(bad.end(), {nan, infinity, -infinity});
    for (const float value : bad) {
      loam_world_def def = good();
      def.*field.member = value;
      refused(def, {field.name, "must be"});
    }
    for (const float value : field.good) {
      loam_world_def def = good();
      def.*field.member = value;
      EXPECT_EQ(created(def), "LOAM_OK") << field.name << " " << value;
    }
  }
  for (int k = 0; k < 3; ++k)
    for (const float value : {nan, infinity, -infinity, 1.1e6f, -1.1e6f}) {
      loam_world_def def = good();
      def.gravity[k] = value;
      refused(def, {"gravity[" + std::to_string(k) + "]"});
    }
}

TEST(WorldDefinition, RefusesEveryIntegerOutOfItsRange) {
  struct Field {
    const char *name;
    std::uint32_t loam_world_def::*member;
    std::vector<std::uint32_t> bad, good;
  };
  const Field fields[] = {
      {"backend", &loam_world_def::backend, {3, ~0u}, {LOAM_BACKEND_CPU}},
      {"substeps", &loam_world_def::substeps, {0, 10001, ~0u}, {1, 10000}},
      {"iterations", &loam_world_def::iterations, {0, 1001, ~0u}, {1, 1000}},
      {"solver", &loam_world_def::solver, {2, ~0u}, {0, 1}},
      {"plasticity", &loam_world_def::plasticity, {2, ~0u}, {0, 1}},
      {"multiplier", &loam_world_def::multiplier, {2, ~0u}, {0, 1}},
      {"warm_start", &loam_world_def::warm_start, {2, ~0u}, {0, 1}},
      {"thread_count", &loam_world_def::thread_count, {257, ~0u}, {0, 256}},
      {"instruction_set", &loam_world_def::instruction_set, {5, ~0u}, {LOAM_INSTRUCTION_SET_PORTABLE}},
  };
  for (const Field &field : fields) {
    for (const std::uint32_t value : field.bad) {
      loam_world_def def = good();
      def.*field.member = value;
      refused(def, {field.name});
    }
    for (const std::uint32_t value : field.good) {
      loam_world_def def = good();
      def.*field.member = value;
      EXPECT_EQ(created(def), "LOAM_OK") << field.name << " " << value;
    }
  }
  for (const std::uint64_t capacity : {std::uint64_t(0), (std::uint64_t(1) << 28) + 1, ~std::uint64_t(0)}) {
    loam_world_def def = good();
    def.particle_capacity = capacity;
    refused(def, {"particle_capacity"});
  }
  loam_world_def def = good();
  def.pair_capacity = ~std::uint64_t(0);
  EXPECT_EQ(created(def), "LOAM_OK");
}

TEST(WorldDefinition, HooksComeInPairs) {
  hooks::Allocator allocator;
  hooks::LateJobs jobs;
  loam_world_def def = good();
  def.allocator.allocate = allocator.hooks().allocate;
  refused(def, {"allocator"});
  def = good();
  def.allocator.release = allocator.hooks().release;
  refused(def, {"allocator"});
  def = good();
  def.job_system.enqueue = jobs.hooks().enqueue;
  refused(def, {"job_system"});
  def = good();
  def.job_system.finish = jobs.hooks().finish;
  refused(def, {"job_system"});
}

TEST(WorldDefinition, TheDefinitionIsCopied) {
  loam_world_def def = good();
  def.substeps = 3;
  loam_world *world = nullptr;
  ASSERT_EQ(loam_world_create(&def, &world), LOAM_OK);
  std::memset(static_cast<void *>(&def), 0x5A, sizeof def);
  EXPECT_EQ(loam_world_step(world, 0.01f), LOAM_OK);
  EXPECT_EQ(loam_world_destroy(world), LOAM_OK);
}

TEST(WorldDefinition, BackendsThatAreNotThereAreUnavailable) {
  loam_world_def def = good();
  def.backend = LOAM_BACKEND_CUDA;
  loam_world *world = nullptr;
  const loam_status status = loam_world_create(&def, &world);
  if (status == LOAM_OK) { // a machine with a device
    std::uint32_t backend = 0;
    EXPECT_EQ(loam_world_get_backend(world, &backend, nullptr), LOAM_OK);
    EXPECT_EQ(backend, unsigned(LOAM_BACKEND_CUDA));
  } else {
    EXPECT_EQ(status, LOAM_ERROR_BACKEND_UNAVAILABLE);
    EXPECT_STRNE(loam_last_error(), "");
    EXPECT_EQ(world, nullptr);
    def.backend = LOAM_BACKEND_AUTO; // falls back
    EXPECT_EQ(created(def), "LOAM_OK");
  }
  loam_world_destroy(world);
}

TEST(WorldDefinition, InstructionSetsOfTheMachineRunAndOthersAreRefused) {
  for (std::uint32_t set = LOAM_INSTRUCTION_SET_PORTABLE; set <= LOAM_INSTRUCTION_SET_AVX512; ++set) {
    loam_world_def def = good();
    def.instruction_set = set;
    loam_world *world = nullptr;
    if (loam_world_create(&def, &world) != LOAM_OK) {
      test::expect_error_names({"instruction_set", std::to_string(set)});
      continue;
    }
    std::uint32_t found = 0, backend = 0;
    EXPECT_EQ(loam_world_get_backend(world, &backend, &found), LOAM_OK);
    EXPECT_EQ(found, set);
    EXPECT_EQ(backend, unsigned(LOAM_BACKEND_CPU));
    loam_world_destroy(world);
  }
}

} // namespace
} // namespace loam
