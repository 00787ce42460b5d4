#include "ratio_table.h"

#include "case.h"

#include <cstdio>
#include <cstdlib>

namespace loam::benchmarks {

namespace {

double counter(const benchmark::UserCounters &counters, const char *name) {
  const auto found = counters.find(name);
  return found == counters.end() ? 0 : double(found->second);
}

} // namespace

void RatioTable::ReportRuns(const std::vector<Run> &runs) {
  ConsoleReporter::ReportRuns(runs);
  for (const Run &run : runs) {
    if (run.error_occurred || run.run_type != Run::RT_Iteration) continue;
    // configuration/particles
    const std::string &name = run.run_name.function_name;
    const std::size_t slash = name.rfind('/');
    rows_.push_back({name.substr(0, slash), std::strtol(name.c_str() + slash + 1, nullptr, 10),
                     counter(run.counters, solve_rate_counter), counter(run.counters, step_rate_counter),
                     counter(run.counters, "ns/particle/substep"), counter(run.counters, "bytes/particle")});
  }
}

void RatioTable::print() const {
  std::map<long, Row> references; // by particle count
  for (const Row &row : rows_)
    if (row.configuration.rfind("reference", 0) == 0) references[row.particles] = row;

  std::printf(
      "\nPair visits per second, fastest substep; ratios to the scalar reference at the same particle count.\n\n"
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

} // namespace loam::benchmarks
