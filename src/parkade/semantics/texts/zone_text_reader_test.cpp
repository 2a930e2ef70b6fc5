// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_reader.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "parkade/core/random.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"

namespace parkade {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kSource = PARKADE_SOURCE_DIR;

cv::Mat logitsOf(const std::vector<std::vector<float>>& steps) {
  cv::Mat logits(static_cast<int>(steps[0].size()), static_cast<int>(steps.size()), CV_32F);
  for (int t = 0; t < logits.cols; ++t) {
    for (int c = 0; c < logits.rows; ++c) {
      logits.at<float>(c, t) =
          std::log(steps[static_cast<std::size_t>(t)][static_cast<std::size_t>(c)]);
    }
  }
  return logits;
}

// All alignments of two steps over the letters A and B, by hand.
TEST(SequenceLikelihood, SumsOverAllAlignments) {
  const cv::Mat logits = logitsOf({{0.5F, 0.3F, 0.2F}, {0.6F, 0.3F, 0.1F}});
  const auto readings = SequenceLikelihood(logits, "AB").best(16, 16);
  double sum = 0.0;
  for (const TextReading& reading : readings) sum += reading.probability;
  EXPECT_NEAR(sum, 1.0, 1e-6);
  ASSERT_GE(readings.size(), 3U);
  EXPECT_EQ(readings[0].text, "A");  // A-, -A, AA
  EXPECT_NEAR(readings[0].probability, 0.3 * 0.6 + 0.5 * 0.3 + 0.3 * 0.3, 1e-6);
  EXPECT_EQ(readings[1].text, "");
  EXPECT_NEAR(readings[1].probability, 0.3, 1e-6);
}

TEST(SequenceLikelihood, ALetterTwiceNeedsABlankBetween) {
  const float low = 1e-4F;
  const auto once =
      SequenceLikelihood(logitsOf({{low, 1.0F}, {low, 1.0F}, {low, 1.0F}}), "1").best(8, 1);
  EXPECT_EQ(once[0].text, "1");
  const auto twice =
      SequenceLikelihood(logitsOf({{low, 1.0F}, {1.0F, low}, {low, 1.0F}}), "1").best(8, 1);
  EXPECT_EQ(twice[0].text, "11");
}

TEST(SequenceLikelihood, PrefixesHaveTheProbabilityOfAllTheirAlignments) {
  const SequenceLikelihood two(logitsOf({{0.5F, 0.3F, 0.2F}, {0.6F, 0.3F, 0.1F}}), "AB");
  const std::vector<double> p = two.ofPrefixes("AB");
  ASSERT_EQ(p.size(), 3U);
  EXPECT_NEAR(p[0], 0.3, 1e-6);
  EXPECT_NEAR(p[1], 0.3 * 0.6 + 0.5 * 0.3 + 0.3 * 0.3, 1e-6);
  EXPECT_NEAR(p[2], 0.3 * 0.1, 1e-6);
  EXPECT_EQ(two.ofPrefixes("AA")[2], 0.0);  // no blank fits between
  EXPECT_EQ(two.ofPrefixes("Z")[1], 0.0);
  EXPECT_NEAR(two.ofPrefixes(std::string(1, kAnyDigit))[1], 0.0, 1e-12);
  EXPECT_NEAR(two.ofPrefixes({kAnyCapital, 'B'})[2], (0.3 + 0.2) * 0.1, 1e-6);
}

TEST(SequenceLikelihood, TheBeamAgreesWithTheSumOverAllAlignments) {
  Random random(4);
  const std::string alphabet = "AB1";
  cv::Mat logits(4, 7, CV_32F);
  for (int i = 0; i < logits.rows * logits.cols; ++i) {
    logits.at<float>(i) = static_cast<float>(random.normal(0.0, 2.0));
  }
  const SequenceLikelihood likelihood(logits, alphabet);
  for (const TextReading& reading : likelihood.best(500, 10)) {
    EXPECT_NEAR(reading.probability, likelihood.ofPrefixes(reading.text).back(),
                2e-3 + 0.02 * reading.probability)
        << reading.text;
  }
}

/// A YAML file in a folder of its own.
class TextNetworkFiles : public testing::Test {
 protected:
  TextNetworkFiles()
      : folder_(std::filesystem::temp_directory_path() /
                (std::string("parkade_text_") +
                 testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::create_directories(folder_);
  }
  ~TextNetworkFiles() override { std::filesystem::remove_all(folder_); }
  std::string messageOf(const std::string& network, const std::string& letters = "\"0123\"",
                        const std::string& size = "width: 96, height: 40") {
    const std::string path = (folder_ / "text.yaml").string();
    std::ofstream(path) << "network: " << network << "\ninput: {" << size
                        << ", mean: 128, scale: 0.025}\nletters: " << letters << "\n";
    const Result<ZoneTextReader> reader = ZoneTextReader::load(path);
    return reader ? std::string("no failure") : reader.error().message;
  }
  std::filesystem::path folder_;
};

TEST_F(TextNetworkFiles, WrongFilesSayWhatIsWrong) {
  const std::string own = kSource + "/models/zone_text.onnx";
  EXPECT_THAT(messageOf(own), AllOf(HasSubstr("zone_text.onnx"), HasSubstr("4 letters")));
  EXPECT_THAT(messageOf("none.onnx"), HasSubstr("there is no file"));
  EXPECT_THAT(messageOf(own, "\"0123\"", "width: 64, height: 32"),
              AllOf(HasSubstr("64 x 32"), HasSubstr("96 x 40")));
  EXPECT_THAT(messageOf(own, "\"01230\""), HasSubstr("comes twice"));
  EXPECT_THAT(messageOf((folder_ / "text.yaml").string()), HasSubstr("cannot read this ONNX"));
  EXPECT_THAT(messageOf(kSource + "/tests/data/networks/bright.onnx"),
              HasSubstr("bright.onnx: the network's output is"));
}

// A face as findZoneMarkers() would hand it over, in OpenCV's own letters, which no training saw.
cv::Mat renderedFace(const std::string& text, Random& random) {
  constexpr int kFine = 4;
  cv::Mat face(kFine * kZonePatchHeight, kFine * kZonePatchWidth, CV_8UC3,
               cv::Scalar::all(random.uniform(40.0, 160.0)));
  const cv::Scalar back(random.uniform(0.0, 140.0), random.uniform(0.0, 140.0),
                        random.uniform(0.0, 140.0));
  int base = 0;
  const double scale = 1.9;
  const int stroke = 9;
  const cv::Size word = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, scale, stroke, &base);
  const cv::Rect plate(face.cols / 2 - word.width / 2 - 16, 12, word.width + 32, face.rows - 24);
  cv::rectangle(face, plate & cv::Rect(0, 0, face.cols, face.rows), back, cv::FILLED);
  cv::putText(face, text, {face.cols / 2 - word.width / 2, face.rows / 2 + word.height / 2},
              cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar::all(random.uniform(200.0, 255.0)),
              stroke, cv::LINE_AA);
  const double slant = random.normal(0.0, 0.04);
  const cv::Matx23d warp(1.0, slant, -0.5 * slant * face.rows, random.normal(0.0, 0.02), 1.0, 0.0);
  cv::warpAffine(face, face, warp, face.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::GaussianBlur(face, face, {}, random.uniform(1.0, 4.0));
  cv::Mat patch;
  cv::resize(face, patch, {kZonePatchWidth, kZonePatchHeight}, 0, 0, cv::INTER_AREA);
  const cv::Rect inside = cv::Rect(plate.x / kFine, 3, plate.width / kFine, 34) &
                          cv::Rect(0, 0, patch.cols, patch.rows);
  cv::Scalar mean;
  cv::Scalar spread;
  cv::meanStdDev(patch(inside), mean, spread);
  patch.convertTo(patch, CV_32F, 40.0 / spread[0]);
  patch += cv::Scalar::all(128.0) - mean * (40.0 / spread[0]);
  patch.colRange(0, inside.x).setTo(cv::Scalar::all(128.0));
  patch.colRange(inside.br().x, patch.cols).setTo(cv::Scalar::all(128.0));
  patch.convertTo(patch, CV_8UC3);
  return patch;
}

TEST(ZoneTextReader, ReadsRenderedFaces) {
  Result<ZoneTextReader> reader = ZoneTextReader::load(kSource + "/models/zone_text.yaml");
  ASSERT_TRUE(reader) << reader.error().message;
  Random random(3);
  const std::string letters = "ABCDEFGHJKLMNPQRSTUVWXYZ";
  int right = 0;
  constexpr int kFaces = 200;
  for (int i = 0; i < kFaces; ++i) {
    std::string text(1, letters[random.index(letters.size())]);
    text += std::to_string(random.integer(1, 29));
    const auto readings = reader->read(renderedFace(text, random));
    ASSERT_TRUE(readings);
    right += readings->front().text == text ? 1 : 0;
  }
  EXPECT_GE(right, 0.75 * kFaces);  // 0.79 of these letters, blurred and strange to it
}

TEST(ZoneTextReader, ReadsDigitsOnlyWhereToldSo) {
  Result<ZoneTextReader> reader = ZoneTextReader::load(kSource + "/models/zone_text.yaml");
  ASSERT_TRUE(reader) << reader.error().message;
  Random random(6);
  int right = 0;
  int right_of_all = 0;
  constexpr int kFaces = 100;
  for (int i = 0; i < kFaces; ++i) {
    const std::string text = std::to_string(random.integer(1, 299));
    const cv::Mat face = renderedFace(text, random);
    const auto digits = reader->read(face, "0123456789");
    const auto all = reader->read(face);
    ASSERT_TRUE(digits && all);
    for (const TextReading& reading : *digits) {
      EXPECT_EQ(reading.text.find_first_not_of("0123456789"), std::string::npos) << reading.text;
    }
    right += digits->front().text == text ? 1 : 0;
    right_of_all += all->front().text == text ? 1 : 0;
  }
  std::printf("digits alone: %d of %d right, all letters: %d\n", right, kFaces, right_of_all);
  EXPECT_GT(right, right_of_all);
}

TEST(ZoneTextReader, LooksAroundInATallPatch) {
  Result<ZoneTextReader> reader = ZoneTextReader::load(kSource + "/models/zone_text.yaml");
  ASSERT_TRUE(reader) << reader.error().message;
  Random random(3);
  int found = 0;
  constexpr int kFaces = 20;
  for (int i = 0; i < kFaces; ++i) {
    cv::Mat tall(kTallPatchHeight, kZonePatchWidth, CV_8UC3, cv::Scalar::all(128));
    renderedFace("B7", random)
        .copyTo(tall.rowRange(kTallPatchHeight - kZonePatchHeight, tall.rows));
    const auto looks = reader->lookAround(tall);
    ASSERT_TRUE(looks);
    ASSERT_EQ(looks->size(), 5U);
    EXPECT_LT(looks->front().ofPrefixes("B7").back(), 0.5);
    found += looks->back().ofPrefixes("B7").back() > 0.5 ? 1 : 0;
  }
  EXPECT_GE(found, kFaces * 3 / 4);
}

TEST(ZoneTextReader, APlainFaceSaysNothing) {
  Result<ZoneTextReader> reader = ZoneTextReader::load(kSource + "/models/zone_text.yaml");
  ASSERT_TRUE(reader) << reader.error().message;
  const auto readings =
      reader->read(cv::Mat(kZonePatchHeight, kZonePatchWidth, CV_8UC3, cv::Scalar::all(128)));
  ASSERT_TRUE(readings);
  EXPECT_EQ(readings->front().text, "");
}

}  // namespace
}  // namespace parkade
