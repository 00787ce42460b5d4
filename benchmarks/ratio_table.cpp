#include "ratio_table.h"

#include "case.h"

#include <cstdio>
#include <cstdlib>
#include <unistd.h>

namespace loam::benchmarks {

namespace {

double counter(const benchmark::UserCounters &counters, const char *name) {
  const auto found = counters.find(name);
  return found == counters.end() ? 0 : double(found->second);
}

/* The stages by name, since Google Benchmark keeps counters so, with their shares. */
std::string stages_of(const benchmark::UserCounters &counters) {
  const std::string prefix = stage_counter_prefix;
  std::string text;
  for (const auto &[name, value] : counters) {
    if (name.rfind(prefix, 0) != 0) continue;
    char number[32];
    std::snprintf(number, sizeof number, " %.0f", double(value));
    text += (text.empty() ? "" : ", ") + name.substr(prefix.size()) + number;
  }
  return text;
}

} // namespace

RatioTable::RatioTable() : ConsoleReporter(isatty(STDOUT_FILENO) ? OO_Color : OO_None) {}

void RatioTable::ReportRuns(const std::vector<Run> &runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run &run : runs) {
    if (run.error_occurred || run.run_type != Run::RT_Iteration) continue;
    if (counter(run.counters, step_rate_counter) == 0) continue; // a snapshot or a cloth: no pairs
    // configuration/particles
    const std::string &name = run.run_name.function_name;
    const std::size_t slash = name.rfind('/');
    rows_.push_back({name.substr(0, slash), std::strtol(name.c_str() + slash + 1, nullptr, 10),
                     counter(run.counters, solve_rate_counter), counter(run.counters, step_rate_counter),
                     counter(run.counters, "ns/particle/substep"), counter(run.counters, "bytes/particle"),
                     counter(run.counters, "neighbours"), stages_of(run.counters)});
  }
}

void RatioTable::print() const {
  print_ratios();
  print_stages();
  print_laws();
}

/* What one visit of a particle costs by its law: the same machine configuration, everything yields. */
void RatioTable::print_laws() const {
  const std::string configuration = "/gauss-seidel/auto/threads:1";
  constexpr long particles = 65536;
  std::vector<std::pair<std::string, double>> visits; // nanoseconds
  double elastic = 0, sand = 0;
  for (const Row &row : rows_) {
    const std::size_t at = row.configuration.find(configuration);
    if (row.particles != particles || at == std::string::npos || row.solve_rate <= 0) continue;
    const std::string material = row.configuration.substr(8, at - 8); // after "library/"
    const double nanoseconds = 1e9 * row.neighbours / row.solve_rate;
    visits.emplace_back(material, nanoseconds);
    if (material == "rubber") elastic = nanoseconds;
    if (material == "sand") sand = nanoseconds;
  }
  if (elastic <= 0 || sand <= 0) return;
  std::printf(
      "\nNanoseconds a particle and iteration by material, everything yielding but rubber; %ld particles, one thread.\n\n"
      "| material | ns | over rubber (elastic) | over sand (Drucker-Prager) |\n|---|--:|--:|--:|\n",
      particles);
  for (const auto &[material, nanoseconds] : visits)
    std::printf("| %s | %.1f | %.2f | %.2f |\n", material.c_str(), nanoseconds, nanoseconds / elastic, nanoseconds / sand);
}

void RatioTable::print_ratios() const {
  std::map<long, Row> references; // by particle count
  for (const Row &row : rows_)
    if (row.configuration.rfind("reference", 0) == 0) references[row.particles] = row;

  std::printf(
      "\nPair visits per second, fastest step; ratios to the scalar reference at the same particle count.\n\n"
      "| configuration | particles | solve, M/s | ratio | whole step, M/s | ratio | ns a particle and substep | bytes a "
      "particle |\n|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Row &row : rows_) {
    const auto found = references.find(row.particles);
    std::string solve_ratio = "-", step_ratio = "-";
    if (found != references.end()) {
      char text[32];
      std::snprintf(text, sizeof text, "%.1f", row.solve_rate / found->second.solve_rate);
      solve_ratio = text;
      std::snprintf(text, sizeof text, "%.1f", row.step_rate / found->second.step_rate);
      step_ratio = text;
    }
    std::printf("| %s | %ld | %.1f | %s | %.1f | %s | %.0f | %.0f |\n", row.configuration.c_str(), row.particles,
                row.solve_rate / 1e6, solve_ratio.c_str(), row.step_rate / 1e6, step_ratio.c_str(), row.nanoseconds,
                row.bytes);
  }
}

void RatioTable::print_stages() const {
  std::printf("\nNanoseconds a particle and substep by stage: the fastest step of each, for the reference the mean.\n\n"
              "| configuration | particles | stages |\n|---|--:|---|\n");
  for (const Row &row : rows_)
    if (!row.stages.empty())
      std::printf("| %s | %ld | %s |\n", row.configuration.c_str(), row.particles, row.stages.c_str());
}

} // namespace loam::benchmarks
