// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <thread>

#include "parkade/io/test_support.hpp"

namespace parkade::test {
namespace {

namespace fs = std::filesystem;

TEST(File, WritesWholeAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.txt");
  ASSERT_TRUE(writeFileAtomic(path, "first, longer"));
  ASSERT_TRUE(writeFileAtomic(path, "second"));
  EXPECT_EQ(bytesOf(path), "second");
  EXPECT_FALSE(fs::exists(path + ".tmp"));
}

TEST(File, LinksStayAndWhatTheyPointToIsWritten) {
  const TemporaryFolder folder;
  const std::string target = folder.write("elsewhere/real.txt", "before");
  const std::string link = folder.path("link.txt");
  fs::create_symlink(target, link);
  ASSERT_TRUE(writeFileAtomic(link, "after"));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(bytesOf(target), "after");
}

TEST(File, PipesAndDevicesStayWhatTheyAre) {
  const TemporaryFolder folder;
  const std::string pipe = folder.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = bytesOf(pipe); });
  EXPECT_TRUE(writeFileAtomic(pipe, "through"));
  reader.join();
  EXPECT_EQ(read, "through");
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_TRUE(writeFileAtomic("/dev/null", "gone"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(File, FoldersAreRefused) {
  const TemporaryFolder folder;
  const Status status = writeFileAtomic(folder.path(), "text");
  ASSERT_FALSE(status);
  EXPECT_NE(status.error().message.find(folder.path()), std::string::npos);
  EXPECT_FALSE(fs::exists(folder.path() + ".tmp"));
}

}  // namespace
}  // namespace parkade::test
