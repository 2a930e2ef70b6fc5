// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "parkade/io/sequence_files.hpp"
#include "parkade/io/test_support.hpp"

namespace parkade {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

TEST(ParseSeconds, IsExactToTheNanosecond) {
  EXPECT_EQ(parseSeconds("1311868164.363181"), 1311868164363181000);
  EXPECT_EQ(parseSeconds("1403636584.763555584"), 1403636584763555584);
  EXPECT_EQ(parseSeconds("0.1"), 100000000);
  EXPECT_EQ(parseSeconds("5"), 5000000000);
  EXPECT_EQ(parseSeconds("-0.000000001"), -1);
  EXPECT_EQ(parseSeconds("+2.5"), 2500000000);
  EXPECT_EQ(parseSeconds("1.036224e-01"), 103622400);
  EXPECT_EQ(parseSeconds("1.311868164363181e+09"), 1311868164363181000);
  EXPECT_EQ(parseSeconds("9223372036.854775806"), 9223372036854775806);
}

TEST(ParseSeconds, RoundsFurtherDigits) {
  EXPECT_EQ(parseSeconds("0.0000000014"), 1);
  EXPECT_EQ(parseSeconds("0.0000000015"), 2);
  EXPECT_EQ(parseSeconds("0.00000000049"), 0);
  EXPECT_EQ(parseSeconds("0.0000000005"), 1);
  EXPECT_EQ(parseSeconds("4e-20"), 0);
}

TEST(ParseSeconds, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "-", ".", "1.2.3", "nan", "inf", "1e", "1e5000", "0x10", "1 2",
                           "12s", "--1", "99999999999999"}) {
    EXPECT_EQ(parseSeconds(text), std::nullopt) << text;
  }
}

TEST(FormatSeconds, HasNineDecimalsAndReadsBack) {
  EXPECT_EQ(formatSeconds(1311868164363181000), "1311868164.363181000");
  EXPECT_EQ(formatSeconds(-1), "-0.000000001");
  for (const TimeNs t : {TimeNs{0}, TimeNs{1}, TimeNs{-1500000000}, TimeNs{1403636584763555584}}) {
    EXPECT_EQ(parseSeconds(formatSeconds(t)), t);
  }
}

constexpr const char* kHeader = "#timestamp [ns],wx,wy,wz,ax,ay,az\n";

TEST(CsvReader, ReadsHeaderCrLfBlanksAndAMissingLastNewline) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("data.csv", std::string("\xEF\xBB\xBF") + kHeader +
                                   "\r\n1, 0.5 ,-1e-3,+2,4,5,6\r\n \n2,0,0,0,0,0,9.81");
  const auto table = readImuTable(path);
  ASSERT_TRUE(table.ok()) << table.error().message;
  ASSERT_EQ(table->rows.size(), 2u);
  EXPECT_EQ(table->rows[0].t_ns, 1);
  EXPECT_EQ(table->rows[0].gyro, Eigen::Vector3d(0.5, -1e-3, 2.0));
  EXPECT_EQ(table->rows[1].accel.z(), 9.81);
  EXPECT_EQ(table->lines, (std::vector<int>{3, 5}));
}

std::string imuError(const std::string& rows) {
  const TemporaryFolder folder;
  const auto table = readImuTable(folder.write("data.csv", kHeader + rows));
  return table.ok() ? "" : table.error().message;
}

TEST(CsvReader, NamesFileLineColumnAndValue) {
  EXPECT_THAT(imuError("1,0,0,0,0,0,0\n2,0,zero,0,0,0,0\n"),
              testing::AllOf(HasSubstr("data.csv:3: column 3 (gyro y)"), HasSubstr("'zero'")));
  EXPECT_THAT(imuError("1.5e9,0,0,0,0,0,0\n"),
              testing::AllOf(HasSubstr("data.csv:2: column 1 (timestamp [ns])"),
                             HasSubstr("whole number of nanoseconds, found '1.5e9'")));
  EXPECT_THAT(imuError("1,0,0,0,0,0,1.5x\n"), HasSubstr("found '1.5x'"));
  EXPECT_THAT(imuError("1,0,0,0,0,0,\n"), HasSubstr("column 7 (accel z): expected a number"));
}

TEST(CsvReader, RefusesNanAndInfinityByName) {
  EXPECT_THAT(imuError("1,0,0,0,0,0,0\n2,0,0,0,nan,0,0\n"),
              testing::AllOf(HasSubstr("data.csv:3: column 5 (accel x): NaN is not a measurement"),
                             HasSubstr("'nan'")));
  EXPECT_THAT(imuError("1,0,-inf,0,0,0,0\n"), HasSubstr("not finite, found '-inf'"));
  EXPECT_THAT(imuError("1,0,1e400,0,0,0,0\n"), HasSubstr("not finite, found '1e400'"));
  EXPECT_EQ(imuError("1,0,1e-400,0,0,0,0\n"), "");  // too small for a double: zero
}

TEST(CsvReader, RefusesAMissingColumnAndAnEmptyFile) {
  EXPECT_THAT(imuError("1,0,0,0,0,0,0\n2,0,0,0,0,0\n"),
              testing::AllOf(HasSubstr("data.csv:3: expected 7 columns (timestamp [ns], gyro x"),
                             HasSubstr("found 6")));
  EXPECT_THAT(imuError(""), HasSubstr("no row of data"));
  const auto missing = readImuTable("/nowhere/data.csv");
  ASSERT_FALSE(missing.ok());
  EXPECT_THAT(missing.error().message, HasSubstr("/nowhere/data.csv: cannot open"));
}

TEST(CsvReader, WheelFieldsMayBeEmptyButNotNan) {
  const TemporaryFolder folder;
  const auto table = readWheelTable(folder.write("a.csv", "1,,2.5,\n"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_TRUE(std::isnan(table->rows[0].rear_left_mps));
  EXPECT_EQ(table->rows[0].rear_right_mps, 2.5);
  EXPECT_TRUE(std::isnan(table->rows[0].steering_rad));
  EXPECT_FALSE(readWheelTable(folder.write("b.csv", "1,NaN,2.5,\n")).ok());
}

TEST(CsvReader, ImageListTakesAnyFileName) {
  const TemporaryFolder folder;
  const auto table = readImageTable(folder.write("a.csv", "#t,filename\n1, left 1.png\n"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_EQ(table->rows[0].file, "left 1.png");
  EXPECT_FALSE(readImageTable(folder.write("b.csv", "1,\n")).ok());
  EXPECT_FALSE(readImageTable(folder.write("c.csv", "1\n")).ok());
}

}  // namespace
}  // namespace parkade
