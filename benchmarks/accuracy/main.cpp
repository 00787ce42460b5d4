/* loam-accuracy: how far off the settings of a world leave each effect, and what they cost, as a table; scripts/accuracy.sh makes the page of it. */
#include "bands.h"

#include <CLI/CLI.hpp>
#include <cstdio>

namespace {

using namespace loam::accuracy;

constexpr Effect effects[] = {
    {"beam", beam},   {"one_step", one_step},       {"sand", sand},      {"snow", snow}, {"dam", dam},
    {"cloth", cloth}, {"penetration", penetration}, {"scaling", scaling}};

} // namespace

int main(int argument_count, char **arguments) {
  std::vector<std::string> names, chosen;
  for (const Effect &effect : effects) names.emplace_back(effect.name);
  std::string out = ".";
  bool quick = false, check = false;
  CLI::App app("How accurate settings are and what they cost, on one thread. Writes accuracy.csv.");
  app.add_option("--effect", chosen, "one to measure; may be given again; all of them unless given")
      ->check(CLI::IsMember(names));
  app.add_flag("--quick", quick, "few settings of the small experiments");
  app.add_flag("--check", check, "quick, and fails if an error or a ratio of times leaves its band");
  app.add_option("--out", out, "the folder of the table")->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, argument_count, arguments);
  try {
    Study study(quick || check);
    std::vector<Effect> todo;
    for (const Effect &effect : effects)
      if (chosen.empty() || std::find(chosen.begin(), chosen.end(), effect.name) != chosen.end()) todo.push_back(effect);
    for (std::size_t k = 0; k < todo.size(); ++k) {
      study.show(std::to_string(k + 1) + " of " + std::to_string(todo.size()) + ": " + todo[k].name);
      todo[k].run(study);
    }
    study.write(out + "/accuracy.csv");
    study.show("written to " + out + "/accuracy.csv");
    if (check && count_outside_bands(study) > 0) return 1;
  } catch (const std::exception &error) {
    std::fprintf(stderr, "loam-accuracy: %s\n", error.what());
    return 1;
  }
  return 0;
}
