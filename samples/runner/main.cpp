// loam-run: simulates a scene file and writes its frames, pictures and statistics.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "accuracy.h"
#include "options.h"
#include "run.h"
#include "tune.h"

int main(int argc, char **argv) {
  runner::Options options;
  CLI::App app(
      "Simulates a scene and writes, for each frame, the particles (PLY) and a picture (PNG); at the end stats.json and\n"
      "series.csv. Ctrl-C ends a run early: what was simulated so far is written, and the exit status is 130.");
  app.add_option("scene", options.scene, "Scene file (TOML)")->required();
  CLI::Option *output = app.add_option("--out", options.output, "Folder for the results; made if it does not exist");
  app.add_flag(
         "--tune", options.tune,
         "Run nothing: measure on this machine what settings of accuracy cost in the scene and how far they are from a\n"
         "reference, print the table and recommend one")
      ->excludes(output);
  std::string accuracy;
  app.add_option("--accuracy", accuracy,
                 "Instead of the scene's: fast, balanced, accurate or reference; tolerance=SHARE, the error of a substep's\n"
                 "solution; budget=MILLISECONDS of a frame; or SUBSTEPSxITERATIONS")
      ->type_name("SETTING");
  app.add_option("--frames", options.frames, "Frames to simulate, instead of the scene's")->check(CLI::Range(1, 1000000));
  app.add_option("--scale", options.scale, "Multiply the number of particles by about this, at the same size of the scene")
      ->check(CLI::Range(1e-3, 1e6));
  const std::map<std::string, std::uint32_t> backends = {
      {"auto", LOAM_BACKEND_AUTO}, {"cpu", LOAM_BACKEND_CPU}, {"cuda", LOAM_BACKEND_CUDA}};
  app.add_option("--backend", options.backend, "Which machine simulates: auto, cpu or cuda")
      ->transform(CLI::CheckedTransformer(backends).description(""))
      ->type_name("NAME");
  const std::map<std::string, std::uint32_t> instruction_sets = {{"auto", LOAM_INSTRUCTION_SET_AUTO},
                                                                 {"portable", LOAM_INSTRUCTION_SET_PORTABLE},
                                                                 {"sse4", LOAM_INSTRUCTION_SET_SSE4},
                                                                 {"avx2", LOAM_INSTRUCTION_SET_AVX2},
                                                                 {"avx512", LOAM_INSTRUCTION_SET_AVX512}};
  app.add_option("--instruction-set", options.instruction_set, "Of the CPU: auto, portable, sse4, avx2 or avx512")
      ->transform(CLI::CheckedTransformer(instruction_sets).description(""))
      ->type_name("NAME");
  const std::map<std::string, std::uint32_t> solvers = {{"gauss-seidel", LOAM_SOLVER_GAUSS_SEIDEL},
                                                        {"jacobi", LOAM_SOLVER_JACOBI}};
  app.add_option("--solver", options.solver, "Instead of the scene's: gauss-seidel or jacobi")
      ->transform(CLI::CheckedTransformer(solvers).description(""))
      ->type_name("NAME");
  app.add_option("--threads", options.threads,
                 "Threads, of the simulation and of the pictures; 0: as many as the machine has")
      ->check(CLI::Range(0, 256));
  app.add_flag("!--no-pictures", options.pictures, "Write no pictures");
  app.add_option("--picture-every", options.picture_every, "A picture for every so many frames")
      ->check(CLI::Range(1, 1000000));
  app.add_option("--ply-every", options.ply_every, "Particles for every so many frames; 0: none")
      ->check(CLI::Range(0, 1000000));
  app.add_option("--until-still", options.until_still,
                 "End so many simulated seconds after the scene's watched region has emptied; --frames becomes the limit")
      ->check(CLI::Range(0.0, 1e6));
  CLI11_PARSE(app, argc, argv);

  try {
    if (!accuracy.empty()) options.accuracy = runner::parse_accuracy(accuracy);
    if (options.tune) return runner::tune(options);
    if (options.output.empty()) return app.exit(CLI::RequiredError("--out or --tune"));
    return runner::run(options);
  } catch (const std::exception &error) {
    fmt::print(stderr, "loam-run: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
