/* Keeps what was measured and prints, at the end, the library beside the scalar reference. */
#pragma once

#include <benchmark/benchmark.h>
#include <map>
#include <string>
#include <vector>

namespace loam::benchmarks {

class RatioTable : public benchmark::ConsoleReporter {
public:
  using ConsoleReporter::ConsoleReporter;
  void ReportRuns(const std::vector<Run> &runs) override;

  /* As Markdown, to standard output. */
  void print() const;

private:
  struct Row {
    std::string configuration;
    long particles;
    double solve_rate, step_rate, nanoseconds, bytes;
  };
  std::vector<Row> rows_;
};

} // namespace loam::benchmarks
