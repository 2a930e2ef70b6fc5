// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/pose_covariance_io.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "parkade/io/file.hpp"
#include "parkade/io/test_support.hpp"

namespace parkade::test {
namespace {

PoseCovariances someCovariances() {
  PoseCovariances rows(2);
  for (int k = 0; k < 2; ++k) {
    StampedPoseCovariance& row = rows[static_cast<std::size_t>(k)];
    row.t_ns = 1000000000LL * (k + 1);
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) {
        row.covariance(i, j) = row.covariance(j, i) = 1e-4 * (i + 1) * (j + 1) * (k + 1);
      }
    }
  }
  return rows;
}

TEST(PoseCovarianceIo, RoundTrip) {
  const TemporaryFolder folder;
  const std::string path = folder.path("covariance.csv");
  const PoseCovariances rows = someCovariances();
  ASSERT_TRUE(writePoseCovariances(path, rows));
  const Result<PoseCovariances> read = readPoseCovariances(path);
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ((*read)[i].t_ns, rows[i].t_ns);
    EXPECT_LT(((*read)[i].covariance - rows[i].covariance).norm(), 1e-10);
  }
}

TEST(PoseCovarianceIo, BadFilesAreNamedWithTheirLine) {
  const TemporaryFolder folder;
  const std::string path = folder.path("covariance.csv");
  PoseCovariances rows = someCovariances();
  rows[1].t_ns = rows[0].t_ns;
  ASSERT_TRUE(writePoseCovariances(path, rows));
  EXPECT_NE(readPoseCovariances(path).error().message.find(":3:"), std::string::npos);
  rows[0].covariance(0, 0) = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(writePoseCovariances(path, rows));
  EXPECT_NE(readPoseCovariances(path).error().message.find(":2:"), std::string::npos);
  ASSERT_TRUE(writeFileAtomic(path, "1000,1,2,3\n"));
  EXPECT_NE(readPoseCovariances(path).error().message.find("4 columns"), std::string::npos);
  EXPECT_FALSE(readPoseCovariances(folder.path("absent.csv")).ok());
}

}  // namespace
}  // namespace parkade::test
