// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/segmentation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "parkade/core/random.hpp"
#include "parkade/semantics/networks/label_decoding.hpp"

namespace parkade {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kNetworks = std::string(PARKADE_SOURCE_DIR) + "/tests/data/networks/";
constexpr auto kDark = static_cast<std::uint8_t>(SemanticClass::kPillar);
constexpr auto kMiddle = static_cast<std::uint8_t>(SemanticClass::kFloor);
constexpr auto kBright = static_cast<std::uint8_t>(SemanticClass::kSlotLine);

/// A class map in a folder of its own, for a network by its full path.
class ClassMapFile : public testing::Test {
 protected:
  ClassMapFile()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("parkade_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~ClassMapFile() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) {
    const std::string path = (folder_ / "map.yaml").string();
    std::ofstream(path) << text;
    return path;
  }
  std::string bright(const std::string& input = "width: 48, height: 32, any_size: true",
                     const std::string& classes = "pillar, floor, slot_line") {
    return write("network: " + kNetworks + "bright.onnx\ninput: {" + input +
                 ", mean: 127.5, scale: 0.00784314, metres_per_px: 0.04}\nclasses: [" + classes +
                 "]\n");
  }
  static std::string messageOf(const std::string& path) {
    const Result<SegmentationNetwork> network = SegmentationNetwork::load(path);
    return network ? std::string("no failure") : network.error().message;
  }

  std::filesystem::path folder_;
};

// Dark, middle and bright bands, with the middle of the picture not seen.
BevImage bands(int width, int height, double metres_per_px) {
  BevImage bev;
  bev.geometry.width_px = width;
  bev.geometry.height_px = height;
  bev.geometry.metres_per_px = metres_per_px;
  bev.t_ns = 77;
  bev.image = cv::Mat(height, width, CV_8UC3, cv::Scalar::all(128));
  bev.image.colRange(0, width / 3).setTo(cv::Scalar::all(20));
  bev.image.colRange(width * 2 / 3, width).setTo(cv::Scalar::all(240));
  bev.valid = cv::Mat(height, width, CV_8UC1, cv::Scalar(255));
  bev.valid.rowRange(height / 2, height / 2 + 2).setTo(0);
  return bev;
}

TEST_F(ClassMapFile, AUsersNetworkLabelsEveryPixel) {
  Result<SegmentationNetwork> network = SegmentationNetwork::load(bright());
  ASSERT_TRUE(network) << network.error().message;
  const BevImage bev = bands(48, 32, 0.04);
  const Result<BevLabels> labels = network->segment(bev);
  ASSERT_TRUE(labels) << labels.error().message;
  EXPECT_EQ(labels->t_ns, 77);
  EXPECT_EQ(labels->geometry.width_px, 48);
  EXPECT_EQ(labels->labels.at<std::uint8_t>(3, 5), kDark);
  EXPECT_EQ(labels->labels.at<std::uint8_t>(3, 24), kMiddle);
  EXPECT_EQ(labels->labels.at<std::uint8_t>(3, 45), kBright);
  // Softmax of (g, 0.5, -g) at g = (20 - 127.5) / 127.5.
  const double g = (127.5 - 20.0) / 127.5;
  const double p = std::exp(g) / (std::exp(g) + std::exp(0.5) + std::exp(-g));
  EXPECT_NEAR(labels->confidence.at<std::uint8_t>(3, 5), 255.0 * p, 1.0);
  EXPECT_EQ(labels->labels.at<std::uint8_t>(16, 5), 0);
  EXPECT_EQ(labels->confidence.at<std::uint8_t>(16, 5), 0);
}

TEST_F(ClassMapFile, OtherSizesAndScalesAreBroughtToTheNetworks) {
  Result<SegmentationNetwork> network = SegmentationNetwork::load(bright());
  ASSERT_TRUE(network) << network.error().message;
  for (const double metres : {0.02, 0.04, 0.06}) {
    const BevImage bev = bands(150, 90, metres);
    const Result<BevLabels> labels = network->segment(bev);
    ASSERT_TRUE(labels) << labels.error().message;
    ASSERT_EQ(labels->labels.size(), bev.image.size());
    EXPECT_EQ(labels->labels.at<std::uint8_t>(80, 10), kDark) << metres;
    EXPECT_EQ(labels->labels.at<std::uint8_t>(80, 75), kMiddle) << metres;
    EXPECT_EQ(labels->labels.at<std::uint8_t>(80, 148), kBright) << metres;
  }
}

TEST_F(ClassMapFile, ANetworkOfOneSizeSaysWhichOne) {
  Result<SegmentationNetwork> network = SegmentationNetwork::load(bright("width: 48, height: 32"));
  ASSERT_TRUE(network) << network.error().message;
  EXPECT_TRUE(network->segment(bands(48, 32, 0.04)).ok());
  const Result<BevLabels> labels = network->segment(bands(60, 32, 0.04));
  ASSERT_FALSE(labels);
  EXPECT_THAT(labels.error().message, AllOf(HasSubstr("48 x 32 px"), HasSubstr("60 x 32 px")));
}

TEST_F(ClassMapFile, FourChannelsPerClassAreTheBlocksPixels) {
  Result<SegmentationNetwork> network = SegmentationNetwork::load(
      write("network: " + kNetworks +
            "blocks.onnx\ninput: {width: 16, height: 16, mean: 127.5, scale: 0.00784314}\n"
            "classes: [floor, vehicle]\n"));
  ASSERT_TRUE(network) << network.error().message;
  cv::Mat image(16, 16, CV_8UC1);
  cv::Mat expected(16, 16, CV_8UC1);
  Random random(3);
  for (int v = 0; v < 16; ++v) {
    for (int u = 0; u < 16; ++u) {
      const bool vehicle = random.chance(0.5);
      image.at<std::uint8_t>(v, u) = vehicle ? 200 : 30;
      expected.at<std::uint8_t>(v, u) =
          static_cast<std::uint8_t>(vehicle ? SemanticClass::kVehicle : SemanticClass::kFloor);
    }
  }
  const Result<ViewLabels> labels = network->segmentView(image);
  ASSERT_TRUE(labels) << labels.error().message;
  EXPECT_EQ(cv::countNonZero(labels->labels != expected), 0);
  // It knows no metres per pixel, so it takes no bird's-eye picture.
  const Result<BevLabels> bev = network->segment(bands(16, 16, 0.04));
  ASSERT_FALSE(bev);
  EXPECT_THAT(bev.error().message, HasSubstr("metres_per_px"));
}

TEST_F(ClassMapFile, LabelsOfViewsMayBeCoarserThanWhatTheNetworkSees) {
  const std::string path = write("network: " + kNetworks +
                                 "coarse.onnx\n"
                                 "input: {width: 32, height: 16, any_size: true, mean: 127.5, "
                                 "scale: 0.00784313725}\n"
                                 "classes: [floor, vehicle]\n");
  Result<SegmentationNetwork> network = SegmentationNetwork::load(path);
  ASSERT_TRUE(network) << network.error().message;
  cv::Mat image(16, 32, CV_8UC1, cv::Scalar(30));
  image(cv::Rect(6, 2, 4, 8)) = 200;
  const Result<ViewLabels> labels = network->segmentView(image);
  ASSERT_TRUE(labels) << labels.error().message;
  cv::Mat expected(8, 16, CV_8UC1, cv::Scalar(static_cast<int>(SemanticClass::kFloor)));
  expected(cv::Rect(3, 1, 2, 4)) = static_cast<int>(SemanticClass::kVehicle);
  ASSERT_EQ(labels->labels.size(), expected.size());
  EXPECT_EQ(cv::countNonZero(labels->labels != expected), 0);
}

TEST_F(ClassMapFile, WithItsMirrorImageAPictureIsLabelledLikeIt) {
  // One that sees to the sides, and one whose channels are the pixels of blocks.
  const std::array<std::string, 2> networks = {
      "layers.onnx\ninput: {width: 24, height: 16, any_size: true, mean: 127.5, "
      "scale: 0.00784313725}\nclasses: [floor, vehicle, pillar, zone_marker, guide_sign]\n",
      "blocks.onnx\ninput: {width: 24, height: 16, mean: 127.5, scale: 0.00784313725}\n"
      "classes: [floor, vehicle]\n"};
  for (const std::string& network : networks) {
    const auto load = [&](const std::string& more) {
      return SegmentationNetwork::load(write("network: " + kNetworks + network + more));
    };
    Result<SegmentationNetwork> plain = load("");
    Result<SegmentationNetwork> mirroring = load("mirror: true\n");
    ASSERT_TRUE(plain) << plain.error().message;
    ASSERT_TRUE(mirroring) << mirroring.error().message;
    cv::Mat image(16, 24, CV_8UC3);
    cv::RNG(4).fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::Mat mirrored;
    cv::flip(image, mirrored, 1);
    const auto labelsOf = [](Result<SegmentationNetwork>& of, const cv::Mat& picture) {
      return of->segmentView(picture)->labels.clone();
    };
    cv::Mat flipped;
    cv::flip(labelsOf(mirroring, mirrored), flipped, 1);
    EXPECT_EQ(cv::countNonZero(labelsOf(mirroring, image) != flipped), 0) << network;
    cv::flip(labelsOf(plain, mirrored), flipped, 1);
    const bool sees_sides = cv::countNonZero(labelsOf(plain, image) != flipped) > 0;
    EXPECT_EQ(sees_sides, network.rfind("layers", 0) == 0) << network;
    if (!sees_sides) {
      EXPECT_EQ(cv::countNonZero(labelsOf(plain, image) != labelsOf(mirroring, image)), 0);
    }
  }
}

TEST_F(ClassMapFile, BadModelsEndWithAClearMessage) {
  EXPECT_THAT(messageOf((folder_ / "none.yaml").string()), HasSubstr("none.yaml"));
  EXPECT_THAT(messageOf(write("network: gone.onnx\ninput: {width: 16, height: 16}\n"
                              "classes: [floor, wall]\n")),
              AllOf(HasSubstr("there is no file"), HasSubstr("gone.onnx")));
  std::ofstream(folder_ / "text.onnx") << "this is no network";
  EXPECT_THAT(messageOf(write("network: text.onnx\ninput: {width: 16, height: 16}\n"
                              "classes: [floor, wall]\n")),
              AllOf(HasSubstr("text.onnx"), HasSubstr("cannot read")));
  EXPECT_THAT(messageOf(bright("width: 48, height: 32", "floor, wall")),
              AllOf(HasSubstr("2 classes"), HasSubstr("1 x 3 x 32 x 48")));
  EXPECT_THAT(
      messageOf(bright("width: 48, height: 32", "floor, wall, slotline")),
      AllOf(HasSubstr("'slotline' is unknown"), HasSubstr("slot_line"), HasSubstr("map.yaml:3")));
  EXPECT_THAT(messageOf(bright("width: 48, hight: 32")), HasSubstr("hight"));
  EXPECT_THAT(messageOf(bright("width: 4, height: 32")), HasSubstr("expected 8 to 8192"));
  EXPECT_THAT(messageOf(write("network: " + kNetworks +
                              "vector.onnx\ninput: {width: 16, height: 16}\n"
                              "classes: [floor, wall]\n")),
              AllOf(HasSubstr("output is 1 x 3"), HasSubstr("channels x height x width")));
}

TEST_F(ClassMapFile, AnInputOfAnotherSizeIsRefused) {
  // blocks.onnx wants even sides, to give half of them.
  EXPECT_THAT(messageOf(write("network: " + kNetworks +
                              "blocks.onnx\ninput: {width: 17, height: 16}\n"
                              "classes: [floor, vehicle]\n")),
              AllOf(HasSubstr("2 classes"), HasSubstr("17 x 16")));
}

TEST(LabelDecoding, ProbabilitiesAreThoseOfSoftmax) {
  const std::vector<SemanticClass> classes{SemanticClass::kFloor, SemanticClass::kWall,
                                           SemanticClass::kVehicle, SemanticClass::kArrow};
  const std::array<int, 4> shape{1, 4, 9, 31};
  cv::Mat logits(4, shape.data(), CV_32F);
  Random random(5);
  for (int c = 0; c < 4; ++c) {
    for (int i = 0; i < 9 * 31; ++i) {
      logits.ptr<float>(0, c)[i] = static_cast<float>(random.normal(0.0, 4.0));
    }
  }
  const DecodedLabels decoded = decodeLogits(logits, classes, cv::Size(31, 9));
  EXPECT_TRUE(decoded.slot_line.empty());
  for (int i = 0; i < 9 * 31; ++i) {
    int best = 0;
    double total = 0.0;
    for (int c = 0; c < 4; ++c) {
      if (logits.ptr<float>(0, c)[i] > logits.ptr<float>(0, best)[i]) best = c;
    }
    const double top = logits.ptr<float>(0, best)[i];
    for (int c = 0; c < 4; ++c) total += std::exp(logits.ptr<float>(0, c)[i] - top);
    ASSERT_EQ(decoded.labels.data[i], static_cast<int>(classes[static_cast<std::size_t>(best)]));
    ASSERT_NEAR(decoded.confidence.data[i], 255.0 / total, 1.1);
  }
}

TEST(LabelDecoding, EvidenceIsWhatAClassLacksToTheLikeliest) {
  // Two channels mean slot lines: the better one counts.
  const std::vector<SemanticClass> classes{SemanticClass::kFloor, SemanticClass::kSlotLine,
                                           SemanticClass::kSlotLine, SemanticClass::kArrow};
  const std::array<int, 4> shape{1, 4, 1, 4};
  cv::Mat logits(4, shape.data(), CV_32F);
  const std::array<std::array<float, 4>, 4> values = {{{2.0F, 5.0F, 0.0F, 30.0F},
                                                       {1.0F, 1.0F, 3.0F, 0.0F},
                                                       {0.0F, 3.0F, -1.0F, 0.0F},
                                                       {-1.0F, 4.0F, 2.0F, 25.0F}}};
  for (int c = 0; c < 4; ++c) {
    std::copy_n(values[static_cast<std::size_t>(c)].begin(), 4, logits.ptr<float>(0, c));
  }
  const DecodedLabels decoded = decodeLogits(logits, classes, cv::Size(4, 1));
  const std::array<int, 4> lines{230, 205, 255, 0};
  const std::array<int, 4> paint{230, 230, 255, 130};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(decoded.slot_line.data[i], lines[i]) << i;
    EXPECT_EQ(decoded.paint.data[i], paint[i]) << i;
  }
}

TEST(LabelDecoding, UnknownMayBeLeftOut) {
  const std::vector<SemanticClass> classes{SemanticClass::kUnknown, SemanticClass::kFloor,
                                           SemanticClass::kWall};
  const std::array<float, 3> values{5.0F, 1.0F, 2.0F};
  // A channel per class, and four for the pixels of a block.
  for (const int per_class : {1, 4}) {
    const std::array<int, 4> shape{1, 3 * per_class, 1, 1};
    cv::Mat logits(4, shape.data(), CV_32F);
    for (int c = 0; c < 3 * per_class; ++c) {
      *logits.ptr<float>(0, c) = values[static_cast<std::size_t>(c / per_class)];
    }
    const cv::Size size = per_class == 1 ? cv::Size(1, 1) : cv::Size(2, 2);
    EXPECT_EQ(decodeLogits(logits, classes, size).labels.data[0],
              static_cast<int>(SemanticClass::kUnknown));
    const DecodedLabels decoded = decodeLogits(logits, classes, size, true);
    for (std::size_t i = 0; i < decoded.labels.total(); ++i) {
      EXPECT_EQ(decoded.labels.data[i], static_cast<int>(SemanticClass::kWall));
      EXPECT_NEAR(decoded.confidence.data[i], 255.0 / (1.0 + std::exp(-1.0)), 1.1);
    }
  }
}

TEST(FindModel, NamesThePlacesItLookedAt) {
  const Result<std::string> path = findModel("no_such_network");
  ASSERT_FALSE(path);
  EXPECT_THAT(path.error().message,
              AllOf(HasSubstr("no_such_network.yaml"), HasSubstr("PARKADE_MODELS")));
}

}  // namespace
}  // namespace parkade
