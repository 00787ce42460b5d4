/* loam-benchmarks: how fast the library is, against a plain scalar code in the same run.
 *
 * Every option of Google Benchmark works; --benchmark_filter=gauss-seidel/auto for the headline alone. benchmarks/record.sh keeps a run. */
#include "case.h"
#include "ratio_table.h"

#include <cstring>
#include <thread>

namespace {

using namespace loam;
using namespace loam::benchmarks;

loam_material_def of_law(std::uint32_t law, const char *name) {
  loam_material_def def;
  scenes::require(loam_material_def_default(law, &def, sizeof def), "loam_material_def_default");
  std::memset(def.name, 0, sizeof def.name);
  std::strncpy(def.name, name, sizeof def.name - 1);
  def.youngs_modulus = 1e6f;
  return def;
}

/* One of each law, so weak that it yields everywhere; sand, which the others are held against, is the default. */
std::vector<loam_material_def> materials() {
  loam_material_def metal = of_law(LOAM_LAW_VON_MISES, "hardening metal"), clay = of_law(LOAM_LAW_NACC, "clay"),
                    mud = of_law(LOAM_LAW_HERSCHEL_BULKLEY, "mud"), foam = of_law(LOAM_LAW_HERSCHEL_BULKLEY, "foam"),
                    starch = of_law(LOAM_LAW_HERSCHEL_BULKLEY, "starch"), snow = of_law(LOAM_LAW_STOMAKHIN_SNOW, "snow");
  metal.yield_stress = 500;
  metal.hardening_modulus = 1e4f;
  clay.consolidation = -2e-4f;
  mud.shear_yield_stress = foam.shear_yield_stress = starch.shear_yield_stress = 100;
  mud.flow_exponent = 1;
  foam.flow_exponent = 0.3f;
  starch.flow_exponent = 3;
  snow.critical_compression = 2e-3f;
  snow.critical_stretch = 1e-3f;
  return {scenes::rubber(), scenes::plasticine(500), metal, clay, mud, foam, starch, snow};
}

void add(const std::string &prefix, const Case &measured, void (*run)(benchmark::State &, const Case &)) {
  const std::string name = prefix + "/" + measured.name + "/" + std::to_string(measured.particles);
  benchmark::RegisterBenchmark(name.c_str(), [measured, run](benchmark::State &state) { run(state, measured); })
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(measured_substeps(measured.particles));
}

void add_library(const Case &measured) {
  if (is_available(measured)) add("library", measured, run_library);
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

  for (const loam_material_def &material : materials()) {
    Case other;
    other.name = std::string(material.name) + "/gauss-seidel/auto/threads:1";
    other.material = material;
    add_library(other);
  }

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
