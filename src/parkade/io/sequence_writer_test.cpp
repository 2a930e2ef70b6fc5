// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sequence_writer.hpp"

#include <gmock/gmock.h>

#include <map>

#include "parkade/io/image_file.hpp"
#include "parkade/io/sequence_files.hpp"
#include "parkade/io/sequence_test_support.hpp"
#include "parkade/io/trajectory_io.hpp"

namespace parkade {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::HasSubstr;

std::map<std::string, std::string> filesOf(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    files[fs::relative(entry.path(), folder).string()] = test::bytesOf(entry.path().string());
  }
  return files;
}

bool same(const SensorEvent& a, const SensorEvent& b) {
  if (a.index() != b.index() || timeOf(a) != timeOf(b)) return false;
  if (const auto* imu = std::get_if<ImuSample>(&a)) {
    const auto& other = std::get<ImuSample>(b);
    return imu->gyro == other.gyro && imu->accel == other.accel;
  }
  if (const auto* wheel = std::get_if<WheelSample>(&a)) {
    const auto& other = std::get<WheelSample>(b);
    return wheel->rear_left_mps == other.rear_left_mps &&
           wheel->rear_right_mps == other.rear_right_mps &&
           std::isnan(wheel->steering_rad) == std::isnan(other.steering_rad);
  }
  const auto& frame = std::get<FrameSet>(a);
  const auto& other = std::get<FrameSet>(b);
  bool equal = frame.index == other.index && frame.image_t_ns == other.image_t_ns;
  for (std::size_t i = 0; i < frame.images.size(); ++i) {
    equal = equal && test::sameImage(frame.images[i], other.images[i]);
  }
  return equal;
}

TEST(SequenceWriter, TheReaderGivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  // Stamps are written on each camera's own clock and read back onto the IMU's.
  Rig rig = test::smallRig();
  rig.cameras[1].time_offset_ns = -7'000'001;
  const std::vector<SensorEvent> events = test::smallEvents();
  test::writeEvents(folder.path("seq"), events, test::lossless(), rig);
  const auto list = readImageTable(folder.path("seq/mav0/cam1/data.csv"));
  ASSERT_TRUE(list.ok());
  EXPECT_EQ(list->rows[0].t_ns, std::get<FrameSet>(events[2]).image_t_ns[1] + 7'000'001);

  auto reader = SequenceReader::open(folder.path("seq"));
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ((*reader)->rig().cameras[1].time_offset_ns, 0);
  EXPECT_EQ((*reader)->info().num_frame_sets, 10);
  EXPECT_TRUE((*reader)->info().has_wheel);
  std::vector<SensorEvent> back = test::readAll(**reader);
  // A frame set lies at the mean of its stamps, 1 ms after the samples that were written with it.
  ASSERT_EQ(back.size(), events.size());
  for (std::size_t i = 0; i < back.size(); ++i) EXPECT_TRUE(same(back[i], events[i])) << i;
}

TEST(SequenceWriter, BytesDoNotDependOnThreads) {
  const TemporaryFolder folder;
  const std::vector<SensorEvent> events = test::smallEvents();
  for (const int threads : {0, 1, 3}) {
    SequenceWriterOptions options;
    options.encode_threads = threads;
    test::writeEvents(folder.path(std::to_string(threads)), events, options);
  }
  const auto files = filesOf(folder.path("0"));
  EXPECT_EQ(files.size(), 28u);  // 19 images, 4 data.csv, 4 sensor.yaml, rig.yaml
  EXPECT_EQ(filesOf(folder.path("1")), files);
  EXPECT_EQ(filesOf(folder.path("3")), files);
}

TEST(SequenceWriter, SensorYamlIsReadAsEurocWritesIt) {
  const TemporaryFolder folder;
  test::writeEvents(folder.path(), {});
  fs::remove(folder.path("rig.yaml"));
  const auto rig = readSequenceRig(folder.path());
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  const Rig expected = test::smallRig();
  ASSERT_EQ(rig->cameras.size(), 2u);
  EXPECT_EQ(rig->cameras[1].camera.width(), 64);
  EXPECT_DOUBLE_EQ(rig->cameras[1].camera.focalLength(), 51.0);
  const SE3 difference =
      rig->cameras[1].T_vehicle_cam.inverse() * expected.cameras[1].T_vehicle_cam;
  EXPECT_LT(difference.log().norm(), 1e-14);
  EXPECT_EQ(rig->imu.accelerometer_random_walk, expected.imu.accelerometer_random_walk);
}

TEST(SequenceWriter, GrayPngDropsTheColour) {
  const TemporaryFolder folder;
  SequenceWriterOptions options;
  options.image_format = "gray-png";
  FrameSet frame_set;
  frame_set.t_ns = 5;
  frame_set.images = {cv::Mat(48, 64, CV_8UC3, cv::Scalar(10, 200, 30)), cv::Mat()};
  test::writeEvents(folder.path(), {frame_set}, options);
  const std::string bytes = test::bytesOf(folder.path("mav0/cam0/data/5.png"));
  ASSERT_GT(bytes.size(), 26u);
  EXPECT_EQ(bytes[25], 0);  // colour type of the header: gray
}

TEST(SequenceWriter, AnInterruptedFolderSaysSoAndIsResumed) {
  const TemporaryFolder folder;
  const std::vector<SensorEvent> events = test::smallEvents();
  SequenceWriterOptions options;
  options.fingerprint = "seed: 1";
  test::writeEvents(folder.path("whole"), events, options);
  const std::string path = folder.path("cut");
  {
    auto writer = SequenceWriter::create(path, test::smallRig(), options);
    ASSERT_TRUE(writer.ok());
    for (std::size_t i = 0; i < events.size() / 2; ++i)
      ASSERT_TRUE((*writer)->write(events[i]).ok());
  }  // killed: no finish()
  folder.write("cut/mav0/cam0/data/123.jpg.tmp", "half");
  EXPECT_FALSE(fs::exists(folder.path("cut/mav0/imu0/data.csv")));
  const SequenceState state = inspectSequence(path);
  EXPECT_TRUE(state.begun);
  EXPECT_FALSE(state.finished);
  EXPECT_EQ(state.fingerprint, "seed: 1");
  EXPECT_THAT(SequenceReader::open(path).error().message, HasSubstr("not written to its end"));

  EXPECT_THAT(SequenceWriter::create(path, test::smallRig(), options).error().message,
              HasSubstr("unfinished sequence already"));
  options.resume = true;
  SequenceWriterOptions other = options;
  other.fingerprint = "seed: 2";
  EXPECT_THAT(SequenceWriter::create(path, test::smallRig(), other).error().message,
              HasSubstr("begun with other options ('seed: 1', now 'seed: 2')"));

  auto writer = SequenceWriter::create(path, test::smallRig(), options);
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  int kept = 0;
  for (SensorEvent event : events) {
    if (auto* frame_set = std::get_if<FrameSet>(&event)) {
      for (std::size_t k = 0; k < 2; ++k) {
        if (frame_set->image_t_ns[k] == 0) continue;
        if (!(*writer)->hasImage(k, frame_set->image_t_ns[k])) continue;
        frame_set->images[k] = cv::Mat();
        ++kept;
      }
    }
    ASSERT_TRUE((*writer)->write(event).ok());
  }
  ASSERT_TRUE((*writer)->finish().ok());
  EXPECT_GT(kept, 5);
  EXPECT_TRUE(inspectSequence(path).finished);
  EXPECT_EQ(filesOf(path), filesOf(folder.path("whole")));
  EXPECT_THAT(SequenceWriter::create(path, test::smallRig(), options).error().message,
              HasSubstr("nothing to resume"));
}

TEST(SequenceWriter, RefusesAFolderThatHoldsASequence) {
  const TemporaryFolder folder;
  test::writeEvents(folder.path(), {});
  EXPECT_THAT(SequenceWriter::create(folder.path(), test::smallRig()).error().message,
              HasSubstr("holds a sequence already"));
}

TEST(SequenceWriter, ACallersMistakesThrow) {
  const TemporaryFolder folder;
  auto writer = SequenceWriter::create(folder.path(), test::smallRig());
  ASSERT_TRUE(writer.ok());
  ImuSample sample;
  sample.t_ns = 5;
  ASSERT_TRUE((*writer)->write(sample).ok());
  EXPECT_THROW(static_cast<void>((*writer)->write(sample)), CheckError);
  FrameSet frame_set;
  frame_set.images.resize(1);
  EXPECT_THROW(static_cast<void>((*writer)->write(frame_set)), CheckError);
  frame_set.images = {cv::Mat(40, 64, CV_8UC1), cv::Mat()};
  EXPECT_THROW(static_cast<void>((*writer)->write(frame_set)), CheckError);
}

TEST(SequenceWriter, CopiesMasksIntoTheFolder) {
  const TemporaryFolder folder;
  Rig rig = test::smallRig();
  rig.cameras[0].mask_path = folder.path("mask.png");
  ASSERT_TRUE(writeImage(rig.cameras[0].mask_path, cv::Mat(48, 64, CV_8UC1, 255), {true}).ok());
  test::writeEvents(folder.path("seq"), {}, {}, rig);
  const auto back = readSequenceRig(folder.path("seq"));
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(test::bytesOf(back->cameras[0].mask_path), test::bytesOf(folder.path("mask.png")));
  EXPECT_THAT(back->cameras[0].mask_path, HasSubstr("seq/masks/cam0.png"));
}

TEST(SequenceWriter, GroundTruthIsFoundAndReadBack) {
  const TemporaryFolder folder;
  test::writeEvents(folder.path(), {});
  std::vector<GroundTruthState> states(3);
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].t_ns = 100 + static_cast<TimeNs>(i);
    states[i].T_world_body = SE3(SO3::exp({0.1, 0.2, 0.3}), {1.0, 2.0, static_cast<double>(i)});
  }
  ASSERT_TRUE(writeGroundTruth(folder.path(), states).ok());
  const auto path = findReference(folder.path());
  ASSERT_TRUE(path.ok());
  const auto file = readTrajectory(*path);
  ASSERT_TRUE(file.ok()) << file.error().message;
  ASSERT_EQ(file->poses.size(), 3u);
  EXPECT_EQ(file->poses[2].t_ns, 102);
  EXPECT_LT((file->poses[2].T_world_body.inverse() * states[2].T_world_body).log().norm(), 1e-15);
}

}  // namespace
}  // namespace parkade
