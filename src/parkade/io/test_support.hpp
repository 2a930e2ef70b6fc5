// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "parkade/core/log.hpp"

namespace parkade::test {

/// A folder of its own for a test case, removed with all that is in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    const std::string name = std::string("parkade_") + info->test_suite_name() + "_" + info->name();
    path_ = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] std::string path() const { return path_.string(); }
  [[nodiscard]] std::string path(const std::string& name) const { return (path_ / name).string(); }
  /// Writes a file below the folder, with the folders above it; returns its path.
  std::string write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << bytes;
    return file.string();
  }

 private:
  std::filesystem::path path_;
};

inline std::string bytesOf(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Collects the log while it lives.
class LogCapture {
 public:
  LogCapture() {
    setLogSink([this](LogLevel, std::string_view text) { lines.emplace_back(text); });
  }
  ~LogCapture() { setLogSink({}); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;
  std::vector<std::string> lines;
};

/// Folder of the recordings that tests may use, or empty where it is absent.
inline std::string dataFolder() {
  const char* set = std::getenv("PARKADE_TEST_DATA");
  const std::string folder =
      set != nullptr ? set : std::string(PARKADE_SOURCE_DIR) + "/../shared/data";
  return std::filesystem::is_directory(folder) ? folder : "";
}

}  // namespace parkade::test

/// Skips the test where the recordings are absent; otherwise defines `data` as their folder.
#define PARKADE_NEED_DATA(data)                           \
  const std::string data = ::parkade::test::dataFolder(); \
  if (data.empty()) GTEST_SKIP() << "no recordings: set PARKADE_TEST_DATA"
