// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sequence_report.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "parkade/io/image_file.hpp"
#include "parkade/io/sequence_test_support.hpp"

namespace parkade {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::AllOf;
using testing::HasSubstr;

const Check* find(const SequenceReport& report, const std::string& name) {
  for (const Check& check : report.checks) {
    if (check.name == name) return &check;
  }
  return nullptr;
}

TEST(StreamStatistics, RateJitterAndGaps) {
  std::vector<TimeNs> t_ns;
  for (TimeNs i = 0; i < 100; ++i) t_ns.push_back(i * 10 * kNsPerMs + (i % 2) * kNsPerMs / 10);
  t_ns.erase(t_ns.begin() + 50, t_ns.begin() + 54);
  const StreamStatistics s = streamStatistics(t_ns);
  EXPECT_EQ(s.count, 96u);
  EXPECT_NEAR(s.rate_hz, 100.0, 1.1);
  EXPECT_NEAR(s.jitter_ms, 0.1, 0.01);
  EXPECT_EQ(s.gaps, 1u);
  EXPECT_NEAR(s.largest_gap_ms, 50.0, 0.2);
  EXPECT_EQ(streamStatistics({}).count, 0u);
  EXPECT_EQ(streamStatistics({5}).rate_hz, 0.0);
}

// The small sequence at rest: the IMU feels gravity.
std::vector<SensorEvent> restingEvents() {
  std::vector<SensorEvent> events = test::smallEvents();
  for (SensorEvent& event : events) {
    if (auto* imu = std::get_if<ImuSample>(&event)) {
      imu->gyro = {0.01, 0.0, 0.0};
      imu->accel = {0.0, 0.0, 9.8};
    }
  }
  return events;
}

TEST(SequenceReport, DescribesAWholeSequence) {
  const TemporaryFolder folder;
  test::writeEvents(folder.path(), restingEvents(), test::lossless());
  const auto report = describeSequence(folder.path());
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_FALSE(report->failed());
  EXPECT_EQ(report->frame_sets, 10u);
  EXPECT_EQ(report->complete_frame_sets, 9u);
  ASSERT_TRUE(report->imu && report->wheel);
  EXPECT_NEAR(report->imu->stream.rate_hz, 100.0, 1e-9);
  EXPECT_NEAR(report->imu->gravity, 9.8, 1e-9);
  EXPECT_NEAR(report->imu->quiet_gyro.x(), 0.01, 1e-12);
  EXPECT_NEAR(report->imu->accel_std.norm(), 0.0, 1e-9);
  EXPECT_NEAR(report->wheel->stream.rate_hz, 50.0, 1e-9);
  EXPECT_FALSE(report->wheel->has_steering);
  EXPECT_FALSE(report->reference.has_value());
  EXPECT_NEAR(report->duration_s, 1.0, 1e-9);
  EXPECT_EQ(find(*report, "cam1 gaps")->mark, CheckMark::kWarn);  // it lacks one
  EXPECT_EQ(find(*report, "frame sets")->mark, CheckMark::kWarn);
  EXPECT_EQ(find(*report, "gravity")->mark, CheckMark::kPass);
  EXPECT_EQ(find(*report, "imu0 mounting")->mark, CheckMark::kPass);
  EXPECT_EQ(sequenceJson(*report)["frame_sets"], 10);
  EXPECT_THAT(sequenceText(*report), HasSubstr("0 failed"));
}

TEST(SequenceReport, JudgesDamageAndGoesOn) {
  const TemporaryFolder folder;
  const std::vector<SensorEvent> events = restingEvents();
  test::writeEvents(folder.path(), events, test::lossless());
  const std::string imu = test::bytesOf(folder.path("mav0/imu0/data.csv"));
  folder.write("mav0/imu0/data.csv", imu + "5,0,0,0,0,0,nan\n");
  const TimeNs t_ns = test::framesOf(events)[4].image_t_ns[0];
  fs::remove(folder.path("mav0/cam0/data/" + std::to_string(t_ns) + ".png"));
  const auto report = describeSequence(folder.path());
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->failed());
  EXPECT_THAT(find(*report, "imu0")->detail, AllOf(HasSubstr("data.csv:103:"), HasSubstr("NaN")));
  EXPECT_EQ(report->cameras[0].missing, 1u);
  EXPECT_EQ(find(*report, "cam0 files")->mark, CheckMark::kWarn);
  EXPECT_THAT(find(*report, "cam0 files")->detail, HasSubstr("(line 6)"));
  EXPECT_EQ(report->frame_sets, 10u);
}

TEST(SequenceReport, DecodesAllImagesOnRequest) {
  const TemporaryFolder folder;
  const std::vector<SensorEvent> events = restingEvents();
  test::writeEvents(folder.path(), events, test::lossless());
  const auto frames = test::framesOf(events);
  const auto path = [&](int i) {
    return "mav0/cam0/data/" + std::to_string(frames[static_cast<std::size_t>(i)].image_t_ns[0]) +
           ".png";
  };
  folder.write(path(5), test::bytesOf(folder.path(path(5))).substr(0, 100));
  SequenceReportOptions options;
  EXPECT_EQ(find(*describeSequence(folder.path(), options), "images")->mark, CheckMark::kPass);
  options.decode_images = true;
  options.threads = 2;
  double progress = 0.0;
  options.progress = [&progress](double fraction) { progress = fraction; };
  auto report = describeSequence(folder.path(), options);
  EXPECT_EQ(progress, 1.0);
  EXPECT_EQ(find(*report, "images")->mark, CheckMark::kWarn);
  EXPECT_THAT(find(*report, "images")->detail, HasSubstr("1 of 19"));
  EXPECT_EQ(report->cameras[0].unreadable, 1u);
  ASSERT_TRUE(writeImage(folder.path(path(6)), cv::Mat(10, 20, CV_8UC1, 5), {true}).ok());
  report = describeSequence(folder.path(), options);
  EXPECT_EQ(find(*report, "images")->mark, CheckMark::kFail);
  EXPECT_THAT(find(*report, "images")->detail,
              HasSubstr("20 x 10, the calibration is for 64 x 48"));
}

TEST(SequenceReport, AnAccelerometerWithoutGravityIsSuspect) {
  const TemporaryFolder folder;
  std::vector<SensorEvent> events = restingEvents();
  for (SensorEvent& event : events) {
    if (auto* imu = std::get_if<ImuSample>(&event)) imu->accel.z() = 1.0;  // in units of g
  }
  test::writeEvents(folder.path(), events, test::lossless());
  const auto report = describeSequence(folder.path());
  EXPECT_EQ(find(*report, "gravity")->mark, CheckMark::kWarn);
  EXPECT_FALSE(report->failed());
}

TEST(SequenceReport, DegreesPerSecondAreSuspect) {
  const TemporaryFolder folder;
  std::vector<SensorEvent> events = restingEvents();
  int k = 0;
  for (SensorEvent& event : events) {
    if (auto* imu = std::get_if<ImuSample>(&event)) imu->gyro.z() = ++k % 40 < 20 ? 17.0 : -17.0;
  }
  test::writeEvents(folder.path(), events, test::lossless());
  EXPECT_EQ(find(*describeSequence(folder.path()), "gyroscope")->mark, CheckMark::kWarn);
}

TEST(SequenceReport, AnotherClockFailsAndTheLastStampThereIsHangsNothing) {
  const TemporaryFolder folder;
  std::vector<SensorEvent> events = restingEvents();
  for (SensorEvent& event : events) {
    if (auto* imu = std::get_if<ImuSample>(&event)) imu->t_ns /= 1000;  // microseconds
  }
  test::writeEvents(folder.path(), restingEvents(), test::lossless());
  std::string text = "#t,gx,gy,gz,ax,ay,az\n";
  for (const SensorEvent& event : events) {
    const auto* imu = std::get_if<ImuSample>(&event);
    if (imu != nullptr) text += std::to_string(imu->t_ns) + ",0,0,0,0,0,9.81\n";
  }
  folder.write("mav0/imu0/data.csv", text);
  const auto report = describeSequence(folder.path());
  EXPECT_EQ(find(*report, "imu0 covers images")->mark, CheckMark::kFail);
  folder.write("mav0/imu0/data.csv", text + "9223372036854775807,0,0,0,0,0,9.81\n");
  EXPECT_TRUE(describeSequence(folder.path()).ok());
}

TEST(SequenceReport, MasksAndMountingsAreJudged) {
  const TemporaryFolder folder;
  Rig rig = test::smallRig();
  rig.cameras[0].T_vehicle_cam = SE3(SO3(), {1000.0, 0.0, 500.0});  // millimetres
  test::writeEvents(folder.path(), restingEvents(), test::lossless(), rig);
  EXPECT_EQ(find(*describeSequence(folder.path()), "cam0 mounting")->mark, CheckMark::kWarn);
  rig.cameras[1].mask_path = folder.path() + "/none.png";
  ASSERT_TRUE(writeRig(rig, folder.path() + "/rig.yaml"));
  EXPECT_EQ(find(*describeSequence(folder.path()), "cam1 mask")->mark, CheckMark::kFail);
  ImageEncoding png;
  png.png = true;
  const cv::Mat mask(24, 32, CV_8UC1, cv::Scalar(255));
  ASSERT_TRUE(writeImage(folder.path() + "/none.png", mask, png));
  EXPECT_THAT(find(*describeSequence(folder.path()), "cam1 mask")->detail,
              HasSubstr("32 x 24 px, the calibration is for 64 x 48"));
}

TEST(SequenceReport, TheBrokenLogIsCountedAndFails) {
  PARKADE_NEED_DATA(data);
  const TemporaryFolder folder;
  test::writeEvents(folder.path(), restingEvents(), test::lossless());
  folder.write("mav0/imu0/data.csv", test::bytesOf(data + "/imu_broken_log/data.csv"));
  const auto report = describeSequence(folder.path());
  ASSERT_TRUE(report.ok());
  EXPECT_TRUE(report->failed());
  EXPECT_EQ(report->imu->stream.stamps.backward, 10488u);
  EXPECT_THAT(find(*report, "imu0 stamps")->detail,
              AllOf(HasSubstr("10488 stamps go backwards"), HasSubstr("first in line 790")));
  EXPECT_EQ(find(*report, "gravity")->mark, CheckMark::kPass);  // of the device that is kept
}

TEST(SequenceReport, DescribesEuroc) {
  PARKADE_NEED_DATA(data);
  const auto report = describeSequence(data + "/euroc_mh01_16s");
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_FALSE(report->failed());
  for (const Check& check : report->checks) {
    // One instant of 320 was lost by the recorder.
    const bool gap = check.name == "cam0 gaps" || check.name == "cam1 gaps";
    EXPECT_EQ(static_cast<int>(check.mark), gap ? 1 : 0) << check.name << ": " << check.detail;
  }
  EXPECT_EQ(report->cameras.size(), 2u);
  EXPECT_EQ(report->frame_sets, 319u);
  EXPECT_EQ(report->complete_frame_sets, 319u);
  EXPECT_NEAR(report->frame_rate_hz, 20.0, 0.01);
  EXPECT_NEAR(report->imu->stream.rate_hz, 200.0, 0.1);
  EXPECT_EQ(report->cameras[0].stream.gaps, 1u);
  EXPECT_NEAR(report->cameras[0].stream.largest_gap_ms, 100.0, 0.1);
  EXPECT_EQ(report->reference->count, 4133u);
}

}  // namespace
}  // namespace parkade
