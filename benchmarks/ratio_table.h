/* Keeps what was measured and prints, at the end, the library beside the scalar reference. */
#pragma once

#include <benchmark/benchmark.h>
#include <map>
#include <string>
#include <vector>

namespace loam::benchmarks {

class RatioTable : public benchmark::ConsoleReporter {
public:
  RatioTable(); // colours only where the output is a terminal
  void ReportRuns(const std::vector<Run> &runs) override;

  /* As Markdown, to standard output. */
  void print() const;

private:
  struct Row {
    std::string configuration;
    long particles;
    double solve_rate, step_rate, nanoseconds, bytes, neighbours;
    std::string stages; // "sort 28, ..." in nanoseconds a particle and substep
  };
  void print_ratios() const;
  void print_stages() const;
  void print_laws() const;
  std::vector<Row> rows_;
};

} // namespace loam::benchmarks
