// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "parkade/io/file.hpp"
#include "parkade/io/sequence_test_support.hpp"

// The program itself, where what matters lies in how a command begins or ends.

namespace parkade::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct Ended {
  int code = -1;
  std::string text;  ///< what went to the pipe
};

// arguments: as in a shell, with where the output goes.
Ended runShell(const std::string& arguments) {
  Ended ended;
  FILE* pipe = popen((std::string(PARKADE_PROGRAM) + " " + arguments).c_str(), "r");
  if (pipe == nullptr) return ended;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    ended.text += static_cast<char>(c);
  }
  const int status = pclose(pipe);
  if (WIFEXITED(status)) ended.code = WEXITSTATUS(status);
  return ended;
}

TEST(Program, OutputThatCannotBeWrittenIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const Ended ended = runShell("--version 2>&1 >/dev/full");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.text, HasSubstr("could not be written"));
  EXPECT_EQ(runShell("--version").code, 0);
}

TEST(Program, InfoWritesJsonOfAPathThatIsNoUtf8) {
  const test::TemporaryFolder folder;
  const std::string sequence = folder.path("drive\xFF");
  test::writeEvents(sequence, test::smallEvents());
  const std::string json = folder.path("info.json");
  const Ended ended = runShell("info '" + sequence + "' --json '" + json + "' 2>&1");
  EXPECT_THAT(ended.text, Not(HasSubstr("internal error")));
  EXPECT_THAT(test::bytesOf(json), HasSubstr("drive\xEF\xBF\xBD"));
}

TEST(Program, BevRepairsStampsWhereAsked) {
  const test::TemporaryFolder folder;
  test::writeEvents(folder.path("drive"), test::smallEvents());
  const std::string readings = folder.path("drive/mav0/imu0/data.csv");
  std::istringstream lines(test::bytesOf(readings));
  std::vector<std::string> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(line);
  ASSERT_GT(rows.size(), 4U);
  std::swap(rows[rows.size() - 2], rows[rows.size() - 1]);
  std::string swapped;
  for (const std::string& row : rows) swapped += row + "\n";
  ASSERT_TRUE(writeFileAtomic(readings, swapped).ok());
  const std::string bev =
      "bev '" + folder.path("drive") + "' --out '" + folder.path("out") + "' 2>&1";
  const Ended refused = runShell(bev);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.text, HasSubstr("--tolerate-stamps"));
  const Ended repaired = runShell("bev --tolerate-stamps" + bev.substr(3));
  EXPECT_THAT(repaired.text, Not(HasSubstr("--tolerate-stamps")));
}

TEST(Program, BevWithoutAPictureFails) {
  const test::TemporaryFolder folder;
  test::writeEvents(folder.path("drive"), test::smallEvents());
  for (const char* camera : {"cam0", "cam1"}) {
    const std::string data = folder.path(std::string("drive/mav0/") + camera + "/data");
    ASSERT_GT(std::filesystem::remove_all(data), 1u);
    std::filesystem::create_directory(data);
  }
  const Ended ended =
      runShell("bev '" + folder.path("drive") + "' --out '" + folder.path("out") + "' 2>&1");
  EXPECT_EQ(ended.code, 1);
  EXPECT_THAT(ended.text, AllOf(HasSubstr("drive"), HasSubstr("no picture was written")));
}

}  // namespace
}  // namespace parkade::cli
