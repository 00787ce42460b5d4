#include "output_folder.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include <fmt/format.h>

#include "error.h"

namespace runner {
namespace {

[[noreturn]] void fail(const std::filesystem::path &path, const char *what, const std::string &reason) {
  throw Error(fmt::format("{}: {}: {}", path.string(), what, reason));
}

std::string reason_of(int error_number) { return std::generic_category().message(error_number); }

} // namespace

OutputFolder::OutputFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code problem;
  std::filesystem::create_directories(path_, problem);
  if (problem) fail(path_, "the output folder cannot be made", problem.message());
  if (!std::filesystem::is_directory(path_, problem)) fail(path_, "the output folder cannot be made", "it is a file");

  const std::string probe = ".loam-run-probe";
  write(probe, "can this folder be written to?\n");
  std::filesystem::remove(path_ / probe, problem);
}

void OutputFolder::write(const std::string &name, const void *bytes, std::size_t size) const {
  const std::filesystem::path path = path_ / name;
  const std::filesystem::path partial = path_ / (name + ".partial");
  std::error_code problem;

  errno = 0;
  std::FILE *file = std::fopen(partial.string().c_str(), "wb");
  if (file == nullptr) fail(path, "cannot be written", reason_of(errno));
  // A full disk shows in any of these three: data wait in buffers until they are flushed or the file is closed.
  int error_number = 0;
  if (std::fwrite(bytes, 1, size, file) != size || std::fflush(file) != 0) error_number = errno != 0 ? errno : EIO;
  if (std::fclose(file) != 0 && error_number == 0) error_number = errno != 0 ? errno : EIO;
  if (error_number != 0) {
    std::filesystem::remove(partial, problem);
    fail(path, "cannot be written", reason_of(error_number));
  }
  std::filesystem::rename(partial, path, problem);
  if (problem) {
    const std::string reason = problem.message();
    std::filesystem::remove(partial, problem);
    fail(path, "cannot be written", reason);
  }
}

} // namespace runner
