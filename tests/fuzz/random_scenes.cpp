/* Random scenes for as long as asked: see session.h for what they do and what must hold. Every fourth is run a second time, with other threads, another
 * instruction set and without the calls that failed, and must end in the same state. The seed of a failure is printed; `--seed S --count 1
 * --verbose` shows its calls. */
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <string>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <loam/loam.h>

#include "random.h"
#include "session.h"

extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace loam::fuzz {
namespace {

volatile std::sig_atomic_t seed_parts[2]; // of the running scene, for handlers of signals

void say_seed() {
  char text[64];
  const unsigned long long seed = (unsigned long long)(unsigned)seed_parts[0] | (unsigned long long)(unsigned)seed_parts[1]
                                                                                    << 32;
  const int length = std::snprintf(text, sizeof text, "\nduring the scene with --seed %llu\n", seed);
  (void)!write(STDERR_FILENO, text, std::size_t(length));
}

void on_signal(int signal) {
  say_seed();
  std::signal(signal, SIG_DFL);
  (void)std::raise(signal);
}

bool report(std::uint64_t seed, const SessionReport &session, const char *of) {
  if (session.findings.empty()) return true;
  std::printf("seed %llu%s:\n", (unsigned long long)seed, of);
  for (const std::string &finding : session.findings) std::printf("  %s\n", finding.c_str());
  return false;
}

bool repeat(std::uint64_t seed, const SessionReport &first, bool verbose) {
  Random random(seed, ~std::uint64_t(0));
  constexpr std::uint32_t threads[] = {2, 3, 5};
  SessionOptions options{seed, random.pick(threads), LOAM_INSTRUCTION_SET_PORTABLE, &first.refused, verbose};
  const SessionReport second = run_session(options);
  if (!report(seed, second, ", run again without the calls that failed")) return false;
  for (std::size_t i = 0; i < first.hashes.size(); ++i)
    if (first.hashes[i] != second.hashes[i]) {
      std::printf("seed %llu: with %u threads, on portable code and without the calls that failed, the state is another "
                  "after call %zu\n",
                  (unsigned long long)seed, options.thread_count, i + 1);
      return false;
    }
  return true;
}

int run(std::uint64_t first_seed, std::uint64_t count, double seconds, bool verbose) {
  const auto begin = std::chrono::steady_clock::now();
  SessionReport sum;
  std::uint64_t scenes = 0, repeated = 0, failed = 0;
  for (std::uint64_t seed = first_seed; scenes < count && failed < 10; ++seed) {
    const double gone = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (seconds > 0 && gone >= seconds) break;
    seed_parts[0] = int(std::uint32_t(seed));
    seed_parts[1] = int(std::uint32_t(seed >> 32));
    if (verbose) std::printf("seed %llu\n", (unsigned long long)seed);
    SessionOptions options;
    options.seed = seed;
    options.verbose = verbose;
    const SessionReport session = run_session(options);
    bool good = report(seed, session, "");
    if (good && session.repeatable && seed % 4 == 0) {
      good = repeat(seed, session, verbose);
      ++repeated;
    }
    ++scenes;
    failed += good ? 0 : 1;
    sum.calls += session.calls;
    sum.failures += session.failures;
    sum.steps += session.steps;
    sum.particles += session.particles;
    std::fflush(stdout);
  }
  std::printf("%llu scenes (%llu of them twice), %llu calls, %llu of them refused, %llu steps of %.0f particles on average: "
              "%llu scenes failed\n",
              (unsigned long long)scenes, (unsigned long long)repeated, (unsigned long long)sum.calls,
              (unsigned long long)sum.failures, (unsigned long long)sum.steps,
              sum.steps > 0 ? double(sum.particles) / double(sum.steps) : 0.0, (unsigned long long)failed);
  return failed == 0 ? 0 : 1;
}

} // namespace
} // namespace loam::fuzz

int main(int argc, char **argv) {
  std::uint64_t seed = 1, count = 0;
  double seconds = 0;
  bool verbose = false;
  CLI::App app("Drives the library through random scenes and checks what must always hold.");
  app.add_option("--seed", seed, "of the first scene; the next ones follow");
  app.add_option("--count", count, "how many scenes");
  app.add_option("--seconds", seconds, "stop after so long");
  app.add_flag("--verbose", verbose, "print every call");
  CLI11_PARSE(app, argc, argv);
  if (count == 0) count = seconds > 0 ? ~std::uint64_t(0) : 100;
  for (const int signal : {SIGABRT, SIGTERM}) std::signal(signal, loam::fuzz::on_signal); // SIGTERM: from a time limit
  if (__sanitizer_set_death_callback != nullptr)
    __sanitizer_set_death_callback(loam::fuzz::say_seed);
  else
    for (const int signal : {SIGSEGV, SIGFPE, SIGILL}) std::signal(signal, loam::fuzz::on_signal);
  return loam::fuzz::run(seed, count, seconds, verbose);
}
