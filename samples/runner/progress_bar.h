// A line on stderr that shows how far a run has come and how long it will still take.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace runner {

class ProgressBar {
public:
  // On a terminal the line is redrawn in place; elsewhere (a log file) a line is printed now and then.
  explicit ProgressBar(std::uint64_t total, const char *what = "frames");
  ~ProgressBar();
  ProgressBar(const ProgressBar &) = delete;
  ProgressBar &operator=(const ProgressBar &) = delete;

  void show(std::uint64_t done, const std::string &note);

private:
  using Clock = std::chrono::steady_clock;
  std::uint64_t total_;
  const char *what_;
  bool terminal_;
  bool line_open_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = {};
};

// "1:02:03", "4:05".
std::string format_duration(double seconds);

} // namespace runner
