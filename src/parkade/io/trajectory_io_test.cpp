// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/trajectory_io.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/random.hpp"
#include "parkade/io/test_support.hpp"

namespace parkade {
namespace {

using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

Trajectory randomTrajectory() {
  Random random(3);
  Trajectory poses;
  TimeNs t_ns = 1403636584763555584;
  for (int i = 0; i < 50; ++i) {
    Vector6d xi;
    for (int k = 0; k < 6; ++k) xi[k] = random.normal();
    poses.push_back({t_ns, SE3::exp(xi)});
    t_ns += random.integer(1, 100000000);
  }
  return poses;
}

double largestDifference(const Trajectory& a, const Trajectory& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i].T_world_body.inverse() * b[i].T_world_body).log().norm());
  }
  return largest;
}

TEST(TrajectoryIo, TumAndEurocKeepStampsAndPoses) {
  const TemporaryFolder folder;
  const Trajectory poses = randomTrajectory();
  for (const TrajectoryFormat format : {TrajectoryFormat::kTum, TrajectoryFormat::kEuroc}) {
    const std::string path = folder.path(nameOf(format));
    ASSERT_TRUE(writeTrajectory(path, poses, format).ok());
    const auto file = readTrajectory(path);
    ASSERT_TRUE(file.ok()) << file.error().message;
    EXPECT_EQ(file->format, format);
    ASSERT_EQ(file->poses.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_EQ(file->poses[i].t_ns, poses[i].t_ns);
      EXPECT_EQ(file->poses[i].T_world_body.translation(), poses[i].T_world_body.translation());
    }
    EXPECT_LT(largestDifference(file->poses, poses), 1e-15);
  }
}

TEST(TrajectoryIo, KittiWithAndWithoutTimes) {
  const TemporaryFolder folder;
  const Trajectory poses = randomTrajectory();
  const std::string path = folder.path("poses.txt");
  ASSERT_TRUE(writeTrajectory(path, poses, TrajectoryFormat::kKitti).ok());
  const auto file = readTrajectory(path);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->format, TrajectoryFormat::kKitti);
  EXPECT_FALSE(file->has_stamps);
  EXPECT_EQ(file->poses[3].t_ns, 3 * kNsPerSecond);
  EXPECT_LT(largestDifference(file->poses, poses), 1e-14);

  std::string times;
  for (std::size_t i = 0; i < poses.size(); ++i)
    times += fmt::format("{:e}\n", 0.1 * static_cast<double>(i));
  const std::string times_path = folder.write("times.txt", times);
  const auto timed = readTrajectory(path, {std::nullopt, times_path});
  ASSERT_TRUE(timed.ok()) << timed.error().message;
  EXPECT_TRUE(timed->has_stamps);
  EXPECT_EQ(timed->poses[7].t_ns, 700 * kNsPerMs);

  const auto few = readTrajectory(path, {std::nullopt, folder.write("few.txt", "0.0\n0.1\n")});
  ASSERT_FALSE(few.ok());
  EXPECT_THAT(few.error().message, AllOf(HasSubstr("poses.txt:3"), HasSubstr("holds 2")));
  const auto many =
      readTrajectory(path, {std::nullopt, folder.write("many.txt", times + "99.0\n")});
  ASSERT_FALSE(many.ok());
  EXPECT_THAT(many.error().message, HasSubstr("50 poses, but the times file holds 51"));
}

std::string errorOf(const std::string& content, TrajectoryReadOptions options = {}) {
  const TemporaryFolder folder;
  const auto file = readTrajectory(folder.write("t.txt", content), options);
  return file.ok() ? "" : file.error().message;
}

TEST(TrajectoryIo, NamesFileLineAndValueOfBadInput) {
  EXPECT_THAT(errorOf("# t\n1 0 0 0 0 0 0 1\n2 0 0 nan 0 0 0 1\n"),
              AllOf(HasSubstr("t.txt:3: column 4 (z): NaN"), HasSubstr("'nan'")));
  EXPECT_THAT(errorOf("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1.01\n"),
              AllOf(HasSubstr("t.txt:2:"), HasSubstr("norm 1.01")));
  EXPECT_THAT(errorOf("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0\n"),
              AllOf(HasSubstr("t.txt:2: expected 8 columns"), HasSubstr("found 7")));
  EXPECT_THAT(errorOf("2 0 0 0 0 0 0 1\n1.5 0 0 0 0 0 0 1\n"),
              AllOf(HasSubstr("t.txt:2:"), HasSubstr("1.500000000 s lies before")));
  EXPECT_THAT(errorOf("1 2 3\n"), HasSubstr("t.txt:1: cannot tell the format"));
  EXPECT_THAT(errorOf("# nothing\n"), HasSubstr("holds no pose"));
  EXPECT_THAT(errorOf("1,2,3\n"), HasSubstr("t.txt:1: expected 8 columns"));
  EXPECT_THAT(errorOf("1 0 0 0 0 2 0 0 0 0 1 0\n"),
              AllOf(HasSubstr("t.txt:1: the matrix is no rotation"), HasSubstr("det R = 2")));
  EXPECT_THAT(errorOf("1 0 0 0 0 0 0 1\n", {TrajectoryFormat::kKitti, ""}),
              HasSubstr("t.txt:1: expected 12 columns"));
  EXPECT_THAT(errorOf("1 0 0 0 0 0 0 1\n", {std::nullopt, "times.txt"}),
              HasSubstr("a times file goes with KITTI"));
  EXPECT_THAT(errorOf("one 0 0 0 0 0 0 1\n"), HasSubstr("expected seconds, found 'one'"));
}

TEST(TrajectoryIo, NormalisesWhatIsCloseToARotation) {
  const TemporaryFolder folder;
  const auto file = readTrajectory(folder.write("t.txt", "1 0 0 0 0 0 0 1.0009\n"));
  ASSERT_TRUE(file.ok());
  EXPECT_DOUBLE_EQ(file->poses[0].T_world_body.rotation().quaternion().norm(), 1.0);
}

TEST(TrajectoryIo, KeepsTheFirstOfRepeatedStamps) {
  const TemporaryFolder folder;
  test::LogCapture log;
  const auto file =
      readTrajectory(folder.write("t.txt", "1 5 0 0 0 0 0 1\n1 6 0 0 0 0 0 1\n2 7 0 0 0 0 0 1\n"));
  ASSERT_TRUE(file.ok());
  EXPECT_EQ(file->repeats, 1u);
  ASSERT_EQ(file->poses.size(), 2u);
  EXPECT_EQ(file->poses[0].T_world_body.translation().x(), 5.0);
  EXPECT_EQ(log.lines.size(), 1u);
}

TEST(TrajectoryIo, ReadsThePublishedFiles) {
  PARKADE_NEED_DATA(data);
  const std::string folder = data + "/trajectories/";
  const auto kitti = readTrajectory(folder + "KITTI_00_SPTAM.txt");
  ASSERT_TRUE(kitti.ok()) << kitti.error().message;
  EXPECT_EQ(kitti->poses.size(), 4541u);
  const auto tum = readTrajectory(folder + "fr2_desk_groundtruth.txt");
  ASSERT_TRUE(tum.ok()) << tum.error().message;
  EXPECT_EQ(tum->poses.size(), 20956u);  // of 20957 rows one repeats its stamp
  EXPECT_EQ(tum->repeats, 1u);
  const auto orb = readTrajectory(folder + "fr2_desk_ORB.txt");
  ASSERT_TRUE(orb.ok()) << orb.error().message;
  EXPECT_EQ(orb->poses.size(), 2893u);
  EXPECT_EQ(orb->poses[0].t_ns, 1311868164363181000);
}

TEST(TrajectoryIo, FindsAndReadsTheReferenceOfASequence) {
  PARKADE_NEED_DATA(data);
  const std::string sequence = data + "/euroc_mh01_16s";
  const auto path = findReference(sequence);
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_THAT(*path, HasSubstr("state_groundtruth_estimate0/data.csv"));
  EXPECT_EQ(*findReference(sequence + "/mav0"), *path);
  EXPECT_EQ(*findReference(*path), *path);
  const auto file = readTrajectory(*path);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->poses.size(), 4133u);
  EXPECT_EQ(file->poses[0].t_ns, 1403636580838555648);
  EXPECT_NEAR(file->poses[0].T_world_body.rotation().quaternion().w(), 0.534108, 1e-6);
}

TEST(TrajectoryIo, SaysWhereItLookedForAReference) {
  const TemporaryFolder folder;
  EXPECT_THAT(findReference(folder.path()).error().message, HasSubstr("not a sequence"));
  folder.write("mav0/imu0/data.csv", "");
  EXPECT_THAT(findReference(folder.path()).error().message,
              HasSubstr("state_groundtruth_estimate0"));
}

TEST(TrajectoryIo, ReferenceMeasuredAtAMarkerIsCarriedToTheBody) {
  const TemporaryFolder folder;
  const Trajectory body = randomTrajectory();
  const SE3 T_body_sensor(SO3::fromYawPitchRoll(0.0, 0.0, std::acos(0.0)), {0.3, -0.1, 0.7});
  Trajectory sensor = body;
  for (auto& pose : sensor) pose.T_world_body = pose.T_world_body * T_body_sensor;
  const std::string data = folder.write("mav0/mocap0/data.csv", "");
  ASSERT_TRUE(writeTrajectory(data, sensor, TrajectoryFormat::kEuroc).ok());
  // Without a sensor.yaml the poses are taken as the body's.
  EXPECT_LT(largestDifference(readReference(folder.path())->poses, sensor), 1e-14);
  folder.write("mav0/mocap0/sensor.yaml",
               "sensor_type: pose\nT_BS:\n  cols: 4\n  rows: 4\n  data: "
               "[1, 0, 0, 0.3,  0, 0, -1, -0.1,  0, 1, 0, 0.7,  "
               "0, 0, 0, 1]\n");
  EXPECT_LT(largestDifference(readReference(folder.path())->poses, body), 1e-14);
  EXPECT_LT(largestDifference(readReference(data)->poses, body), 1e-14);
  folder.write("mav0/mocap0/sensor.yaml", "T_BS: [1, 2]\n");
  EXPECT_THAT(readReference(folder.path()).error().message, HasSubstr("sensor.yaml"));
  EXPECT_FALSE(readReference(folder.path("absent")).ok());
}

}  // namespace
}  // namespace parkade
