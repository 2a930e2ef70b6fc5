// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_views.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace parkade {
namespace {

const std::string kSource = PARKADE_SOURCE_DIR;

// A sight with one face whose text stands `down` px of the patch lower than the outline says.
ZoneMarkerSight sightOf(const std::string& text, int down) {
  constexpr int kFine = 4;
  cv::Mat fine(kFine * kTallPatchHeight, kFine * kZonePatchWidth, CV_8UC3, cv::Scalar::all(110));
  int base = 0;
  const cv::Size word = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 2.2, 12, &base);
  cv::putText(fine, text,
              {(fine.cols - word.width) / 2, (fine.rows + word.height) / 2 + kFine * down},
              cv::FONT_HERSHEY_SIMPLEX, 2.2, cv::Scalar::all(230), 12, cv::LINE_AA);
  ZoneMarkerFace face;
  cv::resize(fine, face.around, {kZonePatchWidth, kTallPatchHeight}, 0, 0, cv::INTER_AREA);
  const int first = (kTallPatchHeight - kZonePatchHeight) / 2;
  face.patch = face.around.rowRange(first, first + kZonePatchHeight);
  face.patch_height = 34.0;
  face.height_px = 34.0;
  face.corners = {Eigen::Vector2d(0.0, 100.0), {60.0, 100.0}, {60.0, 134.0}, {0.0, 134.0}};
  ZoneMarkerSight sight;
  sight.legible = true;
  sight.faces = {face};
  return sight;
}

class ReadMarkerTest : public testing::Test {
 protected:
  ReadMarker read(const ZoneMarkerSight& sight) {
    Result<ReadMarker> marker = readMarker(sight, *reader_, kZoneLetters);
    EXPECT_TRUE(marker);
    return marker ? *marker : ReadMarker();
  }
  Result<ZoneTextReader> reader_ = ZoneTextReader::load(kSource + "/models/zone_text.yaml");
};

TEST_F(ReadMarkerTest, FindsATextThatStandsLowerThanTheOutlineSays) {
  ASSERT_TRUE(reader_) << reader_.error().message;
  const ReadMarker straight = read(sightOf("B7", 0));
  ASSERT_EQ(straight.faces.size(), 1U);
  EXPECT_EQ(straight.readings.front().text, "B7");
  EXPECT_EQ(straight.faces.front().corners[0].y(), 100.0);
  const ReadMarker low = read(sightOf("B7", 16));
  EXPECT_EQ(low.readings.front().text, "B7");
  ASSERT_EQ(low.faces.size(), 1U);
  EXPECT_NEAR(low.faces.front().corners[0].y(), 116.0, 8.5);
  EXPECT_NEAR(low.faces.front().corners[2].y(), 150.0, 8.5);
}

TEST_F(ReadMarkerTest, WhatIsCutIsReadLessSurely) {
  ASSERT_TRUE(reader_) << reader_.error().message;
  ZoneMarkerSight sight = sightOf("B7", 0);
  const double whole = read(sight).readings.front().probability;
  sight.legible = false;
  const ReadMarker cut = read(sight);
  EXPECT_EQ(cut.readings.front().text, "B7");
  EXPECT_LT(cut.readings.front().probability, 0.9 * whole);
}

TEST_F(ReadMarkerTest, NothingIsReadWithoutFaces) {
  ASSERT_TRUE(reader_) << reader_.error().message;
  ZoneMarkerSight sight;
  EXPECT_TRUE(read(sight).readings.empty());
  sight.semantic_class = SemanticClass::kSpeedLimitSign;
  EXPECT_TRUE(read(sight).readings.empty());
}

}  // namespace
}  // namespace parkade
