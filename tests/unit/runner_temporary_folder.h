// A folder for one test's files, gone when the test ends.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

class TemporaryFolder {
public:
  TemporaryFolder() {
    const auto *test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / (std::string("loam-") + test->test_suite_name() + "-" + test->name() +
                                                      "-" + std::to_string(testing::UnitTest::GetInstance()->random_seed()));
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;

  std::filesystem::path write(const std::string &name, const std::string &text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  const std::filesystem::path &path() const { return path_; }

private:
  std::filesystem::path path_;
};

// The text of the error that `action` throws; empty if it throws none.
template <class Action> std::string error_text(const Action &action) {
  try {
    action();
  } catch (const std::exception &error) {
    return error.what();
  }
  return "";
}
