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

std::string reason_of(int error_number) { return std::generic_category().message(error_number != 0 ? error_number : EIO); }

// Returns why it failed, or nothing.
std::string try_to_write(const std::filesystem::path &path, const void *bytes, std::size_t size) {
  std::filesystem::path partial = path;
  partial += ".partial";
  std::error_code problem;

  errno = 0;
  std::FILE *file = std::fopen(partial.string().c_str(), "wb");
  if (file == nullptr) return reason_of(errno);
  // A full disk shows in any of these three: data wait in buffers until they are flushed or the file is closed.
  std::string reason;
  if (std::fwrite(bytes, 1, size, file) != size || std::fflush(file) != 0) reason = reason_of(errno);
  if (std::fclose(file) != 0 && reason.empty()) reason = reason_of(errno);
  if (reason.empty()) {
    std::filesystem::rename(partial, path, problem);
    if (problem) reason = problem.message();
  }
  if (!reason.empty()) std::filesystem::remove(partial, problem);
  return reason;
}

} // namespace

OutputFolder::OutputFolder(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code problem;
  std::filesystem::create_directories(path_, problem);
  if (problem) fail(path_, "the output folder cannot be made", problem.message());
  if (!std::filesystem::is_directory(path_, problem)) fail(path_, "the output folder cannot be made", "it is a file");

  const std::filesystem::path probe = path_ / ".loam-run-probe";
  const std::string reason = try_to_write(probe, "?", 1);
  if (!reason.empty()) fail(path_, "the output folder cannot be written to", reason);
  std::filesystem::remove(probe, problem);
}

void OutputFolder::write(const std::string &name, const void *bytes, std::size_t size) const {
  const std::string reason = try_to_write(path_ / name, bytes, size);
  if (!reason.empty()) fail(path_ / name, "cannot be written", reason);
}

} // namespace runner
