#include "progress_bar.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#if defined(_WIN32)
#include <io.h>
#define LOAM_RUN_IS_TERMINAL (_isatty(_fileno(stderr)) != 0)
#else
#include <unistd.h>
#define LOAM_RUN_IS_TERMINAL (isatty(fileno(stderr)) != 0)
#endif

namespace runner {

std::string format_duration(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::llround(std::fmax(seconds, 0.0)));
  const std::int64_t hours = whole / 3600, minutes = whole / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                   : fmt::format("{}:{:02}", minutes, whole % 60);
}

ProgressBar::ProgressBar(std::uint64_t total, const char *what)
    : total_(total), what_(what), terminal_(LOAM_RUN_IS_TERMINAL) {}

ProgressBar::~ProgressBar() {
  if (line_open_) std::fputc('\n', stderr);
}

void ProgressBar::show(std::uint64_t done, const std::string &note) {
  const Clock::time_point now = Clock::now();
  const bool final = done >= total_;
  if (!final && last_ != Clock::time_point{} && now - last_ < std::chrono::milliseconds(terminal_ ? 100 : 5000)) return;
  last_ = now;

  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double share = total_ > 0 ? static_cast<double>(done) / static_cast<double>(total_) : 1.0;
  const double left = done > 0 ? elapsed / share - elapsed : 0.0;
  constexpr int width = 30;
  const int filled = static_cast<int>(share * width);
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
  const std::string line = fmt::format("[{}] {}/{} {}, {} elapsed, {} left, {}", bar, done, total_, what_,
                                       format_duration(elapsed), done > 0 ? format_duration(left) : "?", note);
  if (terminal_) {
    fmt::print(stderr, "\r{}\x1b[K", line);
    line_open_ = true;
  } else {
    fmt::print(stderr, "{}\n", line);
  }
  std::fflush(stderr);
}

} // namespace runner
