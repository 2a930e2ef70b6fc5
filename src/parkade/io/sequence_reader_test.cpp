// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sequence_reader.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "parkade/io/image_file.hpp"
#include "parkade/io/sequence_test_support.hpp"

namespace parkade {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// A whole small sequence to damage.
class SequenceReaderTest : public testing::Test {
 protected:
  void SetUp() override { test::writeEvents(seq(), test::smallEvents(), test::lossless()); }
  [[nodiscard]] std::string seq(const std::string& name = "") const {
    return folder_.path(name.empty() ? "seq" : "seq/" + name);
  }
  [[nodiscard]] std::string openError(const SequenceReaderOptions& options = {}) const {
    const auto reader = SequenceReader::open(seq(), options);
    return reader.ok() ? "" : reader.error().message;
  }
  // Replaces a line (counts from 1) of a file; an empty text drops it.
  void setLine(const std::string& name, int line, const std::string& text) const {
    std::string content = test::bytesOf(seq(name));
    std::size_t begin = 0;
    for (int i = 1; i < line; ++i) begin = content.find('\n', begin) + 1;
    const std::size_t end = content.find('\n', begin) + 1;
    folder_.write("seq/" + name,
                  content.replace(begin, end - begin, text.empty() ? "" : text + "\n"));
  }
  [[nodiscard]] std::string line(const std::string& name, int number) const {
    std::istringstream stream(test::bytesOf(seq(name)));
    std::string text;
    for (int i = 0; i < number; ++i) std::getline(stream, text);
    return text;
  }
  // File of the n-th image of a camera.
  [[nodiscard]] std::string image(const std::string& camera, int n) const {
    const std::string row = line("mav0/" + camera + "/data.csv", n + 2);
    return "mav0/" + camera + "/data/" + row.substr(row.find(',') + 1);
  }
  test::TemporaryFolder folder_;
};

TEST_F(SequenceReaderTest, EventsComeInTheOrderOfTime) {
  const auto reader = SequenceReader::open(seq());
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  const std::vector<SensorEvent> events = test::readAll(**reader);
  EXPECT_EQ(events.size(), 101u + 51u + 10u);
  for (std::size_t i = 1; i < events.size(); ++i) {
    ASSERT_LE(timeOf(events[i - 1]), timeOf(events[i]));
    if (timeOf(events[i - 1]) != timeOf(events[i])) continue;
    EXPECT_LE(events[i - 1].index(), events[i].index());  // imu, wheel, frame set
  }
  EXPECT_EQ((*reader)->info().num_cameras, 2);
  EXPECT_EQ((*reader)->info().start_ns, timeOf(events.front()));
  EXPECT_EQ((*reader)->info().end_ns, timeOf(events.back()));
  const auto end = (*reader)->next();
  ASSERT_TRUE(end.ok());
  EXPECT_FALSE(end->has_value());
}

TEST_F(SequenceReaderTest, ACameraThatLacksAFrameHasAnEmptyImage) {
  const auto reader = SequenceReader::open(seq());
  const std::vector<FrameSet> frames = test::framesOf(test::readAll(**reader));
  ASSERT_EQ(frames.size(), 10u);
  EXPECT_TRUE(frames[3].images[1].empty());
  EXPECT_EQ(frames[3].image_t_ns[1], 0);
  EXPECT_FALSE(frames[3].images[0].empty());
  EXPECT_EQ(frames[3].t_ns, frames[3].image_t_ns[0]);
  EXPECT_EQ(frames[2].t_ns, frames[2].image_t_ns[0] + kNsPerMs);
  EXPECT_EQ(frames[9].index, 9);
}

TEST_F(SequenceReaderTest, ThreadsChangeNothing) {
  SequenceReaderOptions options;
  std::vector<std::vector<FrameSet>> all;
  for (const int threads : {0, 1, 2}) {
    options.decode_threads = threads;
    options.decode_ahead = threads + 1;
    const auto reader = SequenceReader::open(seq(), options);
    ASSERT_TRUE(reader.ok());
    all.push_back(test::framesOf(test::readAll(**reader)));
  }
  for (std::size_t i = 0; i < all[0].size(); ++i) {
    for (std::size_t k = 1; k < all.size(); ++k) {
      ASSERT_EQ(all[k].size(), all[0].size());
      EXPECT_EQ(all[k][i].t_ns, all[0][i].t_ns);
      EXPECT_TRUE(test::sameImage(all[k][i].images[0], all[0][i].images[0]));
      EXPECT_TRUE(test::sameImage(all[k][i].images[1], all[0][i].images[1]));
    }
  }
}

TEST_F(SequenceReaderTest, ACutThatLeavesNothingIsAnError) {
  SequenceReaderOptions options;
  for (const double start : {1000.0, 1.4e18}) {
    options.start_s = start;
    const auto reader = SequenceReader::open(seq(), options);
    ASSERT_FALSE(reader.ok());
    EXPECT_THAT(reader.error().message, ::testing::HasSubstr("no pictures from"));
    EXPECT_THAT(reader.error().message, ::testing::HasSubstr("pictures from 0.00 s to 0.90 s"));
  }
  // Between two pictures.
  options.start_s = 0.71;
  options.duration_s = 0.05;
  EXPECT_THAT(openError(options), HasSubstr("no pictures from 0.71 s after its start, for 0.05 s"));
}

TEST_F(SequenceReaderTest, SubsetOfCamerasAndCut) {
  SequenceReaderOptions options;
  options.cameras = "cam1";
  options.start_s = 0.2;
  options.duration_s = 0.5;
  options.gray = false;
  const auto reader = SequenceReader::open(seq(), options);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  const std::vector<SensorEvent> events = test::readAll(**reader);
  const TimeNs begin = 1'000'000'000'123'456'789 + 200 * kNsPerMs;
  EXPECT_EQ(timeOf(events.front()), begin);
  EXPECT_EQ(timeOf(events.back()), begin + 500 * kNsPerMs);
  const std::vector<FrameSet> frames = test::framesOf(events);
  ASSERT_EQ(frames.size(), 4u);  // 0.2, 0.4, 0.5, 0.6: the one at 0.3 is lacking
  EXPECT_EQ(frames[0].images.size(), 1u);
  EXPECT_EQ(frames[0].images[0].type(), CV_8UC3);
  EXPECT_EQ(frames[0].index, 0);
  options.cameras = "cam7";
  EXPECT_THAT(openError(options), AllOf(HasSubstr("cam7"), HasSubstr("cam0")));
}

TEST_F(SequenceReaderTest, GrayBesideColourOnRequest) {
  SequenceReaderOptions options;
  const auto framesWith = [&] {
    const auto reader = SequenceReader::open(seq(), options);
    return test::framesOf(test::readAll(**reader));
  };
  const std::vector<FrameSet> gray = framesWith();
  options.gray = false;
  EXPECT_TRUE(framesWith()[0].gray.empty());
  options.gray_beside = true;
  const std::vector<FrameSet> both = framesWith();
  ASSERT_EQ(both.size(), gray.size());
  for (std::size_t i = 0; i < both.size(); ++i) {
    ASSERT_EQ(both[i].gray.size(), gray[i].images.size());
    for (std::size_t c = 0; c < gray[i].images.size(); ++c) {
      ASSERT_EQ(both[i].gray[c].empty(), gray[i].images[c].empty());
      if (gray[i].images[c].empty()) continue;
      EXPECT_EQ(both[i].images[c].type(), CV_8UC3);
      EXPECT_EQ(cv::norm(both[i].gray[c], gray[i].images[c], cv::NORM_INF), 0.0);
    }
  }
}

TEST_F(SequenceReaderTest, BadImagesAreSkippedAndCountedAndTheRunGoesOn) {
  const std::string whole = test::bytesOf(seq(image("cam0", 1)));
  folder_.write("seq/" + image("cam0", 1), whole.substr(0, whole.size() / 2));
  const std::string jpeg = *encodeImage(cv::Mat(48, 64, CV_8UC1, 200), {});
  folder_.write("seq/" + image("cam0", 2), jpeg.substr(0, jpeg.size() - 5));
  fs::remove(seq(image("cam0", 3)));  // camera 1 lacks this instant: no image at all is left
  fs::remove(seq(image("cam1", 5)));
  test::LogCapture log;
  const auto reader = SequenceReader::open(seq());
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  const std::vector<FrameSet> frames = test::framesOf(test::readAll(**reader));
  ASSERT_EQ(frames.size(), 9u);
  EXPECT_TRUE(frames[1].images[0].empty());
  EXPECT_EQ(frames[1].image_t_ns[0], 0);
  EXPECT_FALSE(frames[1].images[1].empty());
  EXPECT_TRUE(frames[2].images[0].empty());
  EXPECT_EQ(frames[8].index, 8);
  EXPECT_EQ((*reader)->counts()[0].skipped, 3);
  EXPECT_EQ((*reader)->counts()[0].delivered, 7);
  EXPECT_EQ((*reader)->counts()[1].skipped, 1);
  ASSERT_EQ(log.lines.size(), 4u);  // the first of each camera, and two counts
  EXPECT_THAT(log.lines[0], AllOf(HasSubstr(image("cam0", 1)), HasSubstr("cut off")));
  EXPECT_THAT(log.lines[1], AllOf(HasSubstr("cam1"), HasSubstr("cannot open")));
  EXPECT_THAT(log.lines[2], HasSubstr("3 of 10 images of cam0"));
  EXPECT_THAT(log.lines[3], HasSubstr("1 of 9 images of cam1"));
}

TEST_F(SequenceReaderTest, AnImageOfAnotherSizeEndsTheStream) {
  ASSERT_TRUE(writeImage(seq(image("cam1", 2)), cv::Mat(24, 32, CV_8UC1, 9), {true}).ok());
  const auto reader = SequenceReader::open(seq());
  std::string error;
  test::readAll(**reader, &error);
  EXPECT_THAT(error,
              AllOf(HasSubstr(image("cam1", 2)), HasSubstr("32 x 24"), HasSubstr("64 x 48")));
  EXPECT_FALSE((*reader)->next()->has_value());
}

TEST_F(SequenceReaderTest, HonoursFileNamesThatAreNotTheStamp) {
  const std::string file = image("cam0", 0);
  fs::rename(seq(file), seq("mav0/cam0/data/first picture.png"));
  const std::string row = line("mav0/cam0/data.csv", 2);
  setLine("mav0/cam0/data.csv", 2, row.substr(0, row.find(',')) + ",first picture.png\r");
  const auto reader = SequenceReader::open(seq());
  ASSERT_TRUE(reader.ok());
  EXPECT_FALSE(test::framesOf(test::readAll(**reader))[0].images[0].empty());
}

TEST_F(SequenceReaderTest, MissingFoldersAndFilesAreNamed) {
  EXPECT_THAT(SequenceReader::open(folder_.path("none")).error().message,
              HasSubstr("none: no such file or folder"));
  EXPECT_THAT(SequenceReader::open(folder_.path()).error().message,
              HasSubstr("not a sequence: expected a folder 'mav0'"));
  fs::rename(seq("mav0/imu0"), seq("mav0/imu"));
  EXPECT_THAT(openError(), HasSubstr("mav0/imu0/data.csv: cannot open"));
  SequenceReaderOptions options;
  options.require_imu = false;
  EXPECT_EQ(openError(options), "");
  fs::rename(seq("mav0/imu"), seq("mav0/imu0"));
  fs::rename(seq("mav0/cam1"), seq("mav0/left"));
  EXPECT_THAT(openError(), AllOf(HasSubstr("mav0/cam1: no such folder"), HasSubstr("--cameras")));
  options.cameras = "cam0";
  EXPECT_EQ(openError(options), "");
}

TEST_F(SequenceReaderTest, BadRowsAreNamed) {
  const std::string row = line("mav0/imu0/data.csv", 7);
  setLine("mav0/imu0/data.csv", 7, row.substr(0, row.rfind(',')) + ",nan");
  EXPECT_THAT(openError(), HasSubstr("imu0/data.csv:7: column 7 (accel z): NaN"));
  setLine("mav0/imu0/data.csv", 7, row.substr(0, row.rfind(',')));
  EXPECT_THAT(openError(), HasSubstr("imu0/data.csv:7: expected 7 columns"));
  setLine("mav0/imu0/data.csv", 7, row);
  setLine("mav0/wheel0/data.csv", 3, "5,fast,,");
  EXPECT_THAT(openError(), HasSubstr("wheel0/data.csv:3: column 2 (rear_left)"));
}

TEST_F(SequenceReaderTest, BackwardStampsAreRefusedOrRepaired) {
  const std::string first = line("mav0/imu0/data.csv", 20);
  const std::string second = line("mav0/imu0/data.csv", 21);
  setLine("mav0/imu0/data.csv", 20, second);
  setLine("mav0/imu0/data.csv", 21, first);
  setLine("mav0/imu0/data.csv", 40, line("mav0/imu0/data.csv", 39));
  EXPECT_THAT(openError(), AllOf(HasSubstr("imu0/data.csv:21:"), HasSubstr("1 stamps go backwards"),
                                 HasSubstr("1 repeat"), HasSubstr("--tolerate-stamps")));
  SequenceReaderOptions options;
  options.tolerate_stamps = true;
  test::LogCapture log;
  const auto reader = SequenceReader::open(seq(), options);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ(log.lines.size(), 1u);
  EXPECT_EQ(test::readAll(**reader).size(), 100u + 51u + 10u);
}

TEST_F(SequenceReaderTest, BackwardImageStampsAreRefused) {
  const std::string first = line("mav0/cam0/data.csv", 3);
  const std::string second = line("mav0/cam0/data.csv", 4);
  setLine("mav0/cam0/data.csv", 3, second);
  setLine("mav0/cam0/data.csv", 4, first);
  EXPECT_THAT(openError(), HasSubstr("cam0/data.csv:4:"));
  SequenceReaderOptions options;
  options.tolerate_stamps = true;
  const auto reader = SequenceReader::open(seq(), options);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(test::framesOf(test::readAll(**reader)).size(), 10u);
}

TEST_F(SequenceReaderTest, BadOptionsAreRefused) {
  SequenceReaderOptions options;
  options.join_tolerance_ms = 51.0;
  EXPECT_THAT(openError(options), HasSubstr("more than half the frame period"));
  options = {};
  options.decode_ahead = 0;
  EXPECT_THAT(openError(options), HasSubstr("decode_ahead 0"));
  options = {};
  options.duration_s = std::nan("");
  EXPECT_THAT(openError(options), AllOf(HasSubstr("duration_s nan"), Not(HasSubstr("decode"))));
  options = {};
  options.start_s = -1.0;
  EXPECT_THAT(openError(options), HasSubstr("start_s -1"));
  for (const char* holed : {",", "cam0,", "cam0,,cam1"}) {
    options = {};
    options.cameras = holed;
    EXPECT_THAT(openError(options), HasSubstr(holed));
  }
}

TEST_F(SequenceReaderTest, BadCalibrationsAreRefused) {
  const std::string rig = test::bytesOf(seq("rig.yaml"));
  const auto damaged = [&](const std::string& from, const std::string& to) {
    std::string text = rig;
    folder_.write("seq/rig.yaml", text.replace(text.find(from), from.size(), to));
    return openError();
  };
  EXPECT_THAT(damaged("camera_model: pinhole", "camera_model: plenoptic"),
              AllOf(HasSubstr("rig.yaml:"), HasSubstr("plenoptic")));
  EXPECT_THAT(damaged("resolution:", "resolutoin:"),
              AllOf(HasSubstr("rig.yaml:"), HasSubstr("resolutoin")));
  EXPECT_THAT(damaged("T_vehicle_cam:\n      - [", "T_vehicle_cam:\n      - [1"),
              AllOf(HasSubstr("rig.yaml:"), HasSubstr("not a rotation")));
}

TEST_F(SequenceReaderTest, AnotherRigTakesThePlaceOfItsOwn) {
  Rig other = test::smallRig();
  other.cameras[1].T_vehicle_cam = SE3(SO3(), {1.0, 2.0, 3.0});
  other.cameras[1].time_offset_ns = 5 * kNsPerMs;
  SequenceReaderOptions options;
  options.rig = folder_.path("other.yaml");
  EXPECT_THAT(openError(options), HasSubstr("other.yaml"));  // none there yet
  ASSERT_TRUE(writeRig(other, options.rig).ok());
  const auto reader = SequenceReader::open(seq(), options);
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ((*reader)->rig().cameras[1].T_vehicle_cam.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ((*reader)->timeOffsets(), (std::vector<TimeNs>{0, 5 * kNsPerMs}));
  EXPECT_EQ((*reader)->rig().cameras[1].time_offset_ns, 0);  // the stamps have it

  ASSERT_TRUE(writeRig(test::smallRig(3), options.rig).ok());
  EXPECT_THAT(openError(options), HasSubstr("the calibration names camera 'cam2'"));
}

TEST(SequenceReaderOnEuroc, ReadsEveryFrameSetTheSameOnAnyThreads) {
  PARKADE_NEED_DATA(data);
  std::vector<double> sums;
  for (const int threads : {1, 2}) {
    SequenceReaderOptions options;
    options.decode_threads = threads;
    options.duration_s = 6.0;
    const auto reader = SequenceReader::open(data + "/euroc_mh01_16s", options);
    ASSERT_TRUE(reader.ok()) << reader.error().message;
    double sum = 0.0;
    for (const FrameSet& frame : test::framesOf(test::readAll(**reader))) {
      ASSERT_EQ(frame.images.size(), 2u);
      sum = 0.5 * sum + cv::sum(frame.images[0])[0] + 2.0 * cv::sum(frame.images[1])[0];
    }
    sums.push_back(sum);
  }
  EXPECT_GT(sums[0], 0.0);
  EXPECT_EQ(sums[0], sums[1]);
}

TEST(SequenceReaderOnEuroc, CountsWhatIsThere) {
  PARKADE_NEED_DATA(data);
  const auto reader = SequenceReader::open(data + "/euroc_mh01_16s");
  ASSERT_TRUE(reader.ok()) << reader.error().message;
  EXPECT_EQ((*reader)->info().num_frame_sets, 319);
  EXPECT_EQ((*reader)->info().num_cameras, 2);
  EXPECT_FALSE((*reader)->info().has_wheel);
  EXPECT_EQ((*reader)->info().start_ns, 1403636580803555840);
}

}  // namespace
}  // namespace parkade
