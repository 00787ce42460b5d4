/* loam-benchmarks: how fast the library is, against a plain scalar code in the same run.
 *
 * Every option of Google Benchmark works; --benchmark_filter=gauss-seidel/auto for the headline alone. benchmarks/record.sh keeps a run. */
#include "case.h"
#include "ratio_table.h"

#include <thread>

namespace {

using namespace loam;
using namespace loam::benchmarks;

void add(const std::string &prefix, const Case &measured, void (*run)(benchmark::State &, const Case &)) {
  const std::string name = prefix + "/" + measured.name + "/" + std::to_string(measured.particles);
  benchmark::RegisterBenchmark(name.c_str(), [measured, run](benchmark::State &state) { run(state, measured); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(measured_steps(measured.particles));
}

void add_library(const Case &measured) {
  if (is_available(measured)) add("library", measured, run_library);
}

/* In both forms: rubber's drifts are part of the state in that of the tensor. */
void add_snapshots(const std::string &name, const loam_material_def &material) {
  const std::pair<const char *, std::uint32_t> multipliers[] = {{"scalar", LOAM_MULTIPLIER_SCALAR},
                                                                {"tensor", LOAM_MULTIPLIER_PROJECTED_TENSOR}};
  for (const auto &[form, multiplier] : multipliers)
    for (const bool restoring : {false, true}) {
      Case measured;
      measured.material = material;
      benchmark::RegisterBenchmark(
          ("snapshot/" + name + "/" + form + (restoring ? "/restore/" : "/save/") + std::to_string(measured.particles))
              .c_str(),
          [measured, multiplier = multiplier, restoring](benchmark::State &state) {
            run_snapshot(state, measured, multiplier, restoring);
          })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond)
          ->Iterations(20);
    }
}

void add_cloth(std::uint32_t vertices_a_side, std::uint32_t threads) {
  const std::string size = std::to_string(vertices_a_side) + "x" + std::to_string(vertices_a_side);
  benchmark::RegisterBenchmark(("cloth/" + size + "/threads:" + std::to_string(threads)).c_str(),
                               [=](benchmark::State &state) { run_cloth(state, vertices_a_side, threads); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(60);
}

void add_cases() {
  constexpr std::size_t small = 8192, medium = 65536, large = 262144;

  for (const std::size_t particles : {small, medium}) {
    Case scalar;
    scalar.name = "sand/scalar";
    scalar.particles = particles;
    add("reference", scalar, run_reference);
  }

  const std::uint32_t most_threads = std::thread::hardware_concurrency() > 1 ? 2 : 1;
  for (const std::size_t particles : {small, medium, large})
    for (std::uint32_t threads = 1; threads <= most_threads; ++threads) {
      Case headline;
      headline.name = "sand/gauss-seidel/auto/threads:" + std::to_string(threads);
      headline.particles = particles;
      headline.threads = threads;
      add_library(headline);
    }

  for (const std::size_t particles : {small, medium}) {
    Case jacobi;
    jacobi.name = "sand/jacobi/auto/threads:1";
    jacobi.particles = particles;
    jacobi.solver = LOAM_SOLVER_JACOBI;
    add_library(jacobi);
  }

  const std::pair<const char *, std::uint32_t> instruction_sets[] = {{"portable", LOAM_INSTRUCTION_SET_PORTABLE},
                                                                     {"sse4", LOAM_INSTRUCTION_SET_SSE4},
                                                                     {"avx2", LOAM_INSTRUCTION_SET_AVX2},
                                                                     {"avx512", LOAM_INSTRUCTION_SET_AVX512}};
  for (const auto &[set_name, set] : instruction_sets) {
    Case narrow;
    narrow.name = std::string("sand/gauss-seidel/") + set_name + "/threads:1";
    narrow.instruction_set = set;
    add_library(narrow);
  }

  for (const loam_material_def &material : scenes::each_law()) {
    if (material.law == LOAM_LAW_DRUCKER_PRAGER) continue; // the headline
    for (std::uint32_t threads = 1; threads <= (material.law == LOAM_LAW_FLUID ? most_threads : 1); ++threads) {
      Case other;
      other.name = std::string(material.name) + "/gauss-seidel/auto/threads:" + std::to_string(threads);
      other.material = material;
      other.threads = threads;
      add_library(other);
    }
  }

  for (std::uint32_t threads = 1; threads <= most_threads; ++threads) add_cloth(200, threads);

  add_snapshots("sand", scenes::sand());
  add_snapshots("rubber", scenes::rubber());

  const std::pair<const char *, std::uint32_t> solvers[] = {{"gauss-seidel", LOAM_SOLVER_GAUSS_SEIDEL},
                                                            {"jacobi", LOAM_SOLVER_JACOBI}};
  for (const auto &[solver_name, solver] : solvers)
    for (const std::size_t particles : {small, medium, large, 4 * large}) {
      Case device;
      device.name = std::string("sand/") + solver_name + "/cuda";
      device.particles = particles;
      device.backend = LOAM_BACKEND_CUDA;
      device.solver = solver;
      add_library(device);
    }
}

} // namespace

int main(int argument_count, char **arguments) {
  benchmark::Initialize(&argument_count, arguments);
  if (benchmark::ReportUnrecognizedArguments(argument_count, arguments)) return 1;
  add_cases();
  RatioTable table;
  benchmark::RunSpecifiedBenchmarks(&table);
  table.print();
  benchmark::Shutdown();
  return 0;
}
