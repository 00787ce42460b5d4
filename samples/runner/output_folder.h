// The folder that a run writes into. Files appear in it whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace runner {

class OutputFolder {
public:
  // Makes the folder and its parents if need be, and proves that files can be written there. Throws Error naming path and reason.
  explicit OutputFolder(std::filesystem::path path);

  // Writes beside the file and renames, so that a reader never meets half a file, and a full disk leaves the old one. Any number of
  // threads may write files of different names. Throws Error naming path and reason.
  void write(const std::string &name, const void *bytes, std::size_t size) const;
  void write(const std::string &name, const std::string &text) const { write(name, text.data(), text.size()); }

  const std::filesystem::path &path() const { return path_; }

private:
  std::filesystem::path path_;
};

} // namespace runner
