// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/marking_pieces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace parkade {
namespace {

// Gaps in the paint of one object, m: wear, the gaps between a crossing's bars and between digits.
struct ClassGap {
  SemanticClass semantic_class;
  double gap;
};
constexpr int kLeastArrowPart = 8;  // px
constexpr std::array<ClassGap, 7> kGaps = {{{SemanticClass::kArrow, 0.28},
                                            {SemanticClass::kSpeedLimitPaint, 0.60},
                                            {SemanticClass::kStopLine, 0.36},
                                            {SemanticClass::kCrossing, 0.64},
                                            {SemanticClass::kSpeedBump, 0.36},
                                            {SemanticClass::kPaintedNumber, 0.24},
                                            {SemanticClass::kWheelStop, 0.16}}};

cv::Mat hiddenMask(const cv::Mat& labels, int reach) {
  cv::Mat table(1, 256, CV_8UC1, cv::Scalar(255));
  for (int c = 0; c < kNumSemanticClasses; ++c) {
    if (!hidesGround(static_cast<SemanticClass>(c))) table.at<std::uint8_t>(c) = 0;
  }
  cv::Mat hidden;
  cv::LUT(labels, table, hidden);
  cv::rectangle(hidden, cv::Rect(0, 0, hidden.cols, hidden.rows), cv::Scalar(255), 1);
  cv::dilate(hidden, hidden, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8UC1));
  return hidden;
}

// Labels waver between an arrow and the dash of a lane line. Paint that hangs together is one
// thing: all of it an arrow where enough is labelled so, else none.
cv::Mat arrowPaint(const BevLabels& bev) {
  const cv::Mat arrow = bev.labels == static_cast<int>(SemanticClass::kArrow);
  const cv::Rect box = cv::boundingRect(arrow);
  cv::Mat paint = arrow | (bev.labels == static_cast<int>(SemanticClass::kLaneLine));
  cv::Mat piece_of;
  cv::Mat stats;
  cv::Mat centers;
  const int count = cv::connectedComponentsWithStats(paint, piece_of, stats, centers, 8, CV_32S);
  std::vector<int> own(static_cast<std::size_t>(count), 0);
  for (int v = box.y; v < box.y + box.height; ++v) {
    for (int u = box.x; u < box.x + box.width; ++u) {
      if (arrow.at<std::uint8_t>(v, u) != 0)
        ++own[static_cast<std::size_t>(piece_of.at<int>(v, u))];
    }
  }
  constexpr double kEnough = 0.4;
  std::vector<std::uint8_t> kept(own.size(), 0);
  for (std::size_t i = 1; i < own.size(); ++i) {
    const int all = stats.at<int>(static_cast<int>(i), cv::CC_STAT_AREA);
    if (own[i] > 0 && own[i] >= kEnough * all) kept[i] = 255;
  }
  for (int v = 0; v < paint.rows; ++v) {
    const int* index = piece_of.ptr<int>(v);
    std::uint8_t* pixel = paint.ptr<std::uint8_t>(v);
    for (int u = 0; u < paint.cols; ++u) pixel[u] = kept[static_cast<std::size_t>(index[u])];
  }
  return paint;
}

// near_hidden: as hidden, a gap wider; empty: of no interest.
void splitClass(const BevLabels& bev, const cv::Mat& hidden, const cv::Mat& near_hidden,
                const ClassGap& entry, int min_confidence, int min_pixels,
                std::vector<MarkingPiece>& out) {
  const cv::Mat paint = entry.semantic_class == SemanticClass::kArrow
                            ? arrowPaint(bev)
                            : cv::Mat(bev.labels == static_cast<int>(entry.semantic_class));
  if (entry.semantic_class == SemanticClass::kArrow && cv::countNonZero(paint) < min_pixels) return;
  // Joined over gaps in a bounding box only: most classes cover little of a picture.
  const cv::Rect box = cv::boundingRect(paint);
  const int reach =
      std::max(1, static_cast<int>(std::lround(0.5 * entry.gap / bev.geometry.metres_per_px)));
  cv::Mat grown;
  cv::dilate(paint(box), grown, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8UC1));
  cv::Mat piece_of;
  const int count = cv::connectedComponents(grown, piece_of, 8, CV_32S);
  struct Sum {
    double confidence = 0.0;
    int at_edge = 0;
    int near_edge = 0;
  };
  std::vector<MarkingPiece> pieces(static_cast<std::size_t>(count));
  std::vector<Sum> sums(static_cast<std::size_t>(count));
  for (int v = 0; v < box.height; ++v) {
    const std::uint8_t* painted = paint.ptr<std::uint8_t>(v + box.y) + box.x;
    const std::uint8_t* sure = bev.confidence.ptr<std::uint8_t>(v + box.y) + box.x;
    const std::uint8_t* edge = hidden.ptr<std::uint8_t>(v + box.y) + box.x;
    const int* index = piece_of.ptr<int>(v);
    for (int u = 0; u < box.width; ++u) {
      if (painted[u] == 0 || sure[u] < min_confidence) continue;
      const auto i = static_cast<std::size_t>(index[u]);
      pieces[i].points.push_back(bev.geometry.toGround(Eigen::Vector2d(u + box.x, v + box.y)));
      pieces[i].at_edge.push_back(edge[u] != 0);
      sums[i].confidence += sure[u];
      sums[i].at_edge += edge[u] != 0 ? 1 : 0;
      if (!near_hidden.empty() && near_hidden.at<std::uint8_t>(v + box.y, u + box.x) != 0) {
        ++sums[i].near_edge;
      }
    }
  }
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    MarkingPiece& piece = pieces[i];
    if (static_cast<int>(piece.points.size()) < min_pixels) continue;
    constexpr int kTouches = 3;
    piece.semantic_class = entry.semantic_class;
    piece.confidence = sums[i].confidence / (255.0 * static_cast<double>(piece.points.size()));
    piece.cut = sums[i].at_edge >= kTouches;
    piece.may_go_on = sums[i].near_edge >= kTouches;
    out.push_back(std::move(piece));
  }
}

}  // namespace

bool hidesGround(SemanticClass semantic_class) {
  switch (semantic_class) {
    case SemanticClass::kFloor:
    case SemanticClass::kSlotLine:
    case SemanticClass::kLaneLine:
    case SemanticClass::kArrow:
    case SemanticClass::kSpeedLimitPaint:
    case SemanticClass::kStopLine:
    case SemanticClass::kCrossing:
    case SemanticClass::kSpeedBump:
    case SemanticClass::kPaintedNumber:
    case SemanticClass::kWheelStop:
      return false;
    default:
      return true;
  }
}

std::vector<MarkingPiece> findMarkings(const BevLabels& labels, int min_confidence,
                                       int min_pixels) {
  std::array<int, 256> counts{};
  for (int v = 0; v < labels.labels.rows; ++v) {
    const std::uint8_t* row = labels.labels.ptr<std::uint8_t>(v);
    for (int u = 0; u < labels.labels.cols; ++u) ++counts[row[u]];
  }
  std::vector<MarkingPiece> pieces;
  cv::Mat hidden;
  for (const ClassGap& entry : kGaps) {
    if (counts[static_cast<std::size_t>(entry.semantic_class)] < min_pixels) continue;
    constexpr int kBeside = 2;  // px
    if (hidden.empty()) hidden = hiddenMask(labels.labels, kBeside);
    cv::Mat near_hidden;
    if (entry.semantic_class == SemanticClass::kCrossing) {
      constexpr double kBarGap = 0.5;  // m
      near_hidden = hiddenMask(
          labels.labels, static_cast<int>(std::lround(kBarGap / labels.geometry.metres_per_px)));
    }
    const int least = entry.semantic_class == SemanticClass::kArrow
                          ? std::min(kLeastArrowPart, min_pixels)
                          : min_pixels;
    splitClass(labels, hidden, near_hidden, entry, min_confidence, least, pieces);
  }
  return pieces;
}

}  // namespace parkade
