// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/frame_evidence.hpp"

#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Confidence levels: of what may be hidden floor, two in three; of floor that may as well be paint.
constexpr int kHidden = 5;
constexpr int kOpen = 4;

// The most that floor is sure of where the network holds paint nearly as likely.
int floorLevel(std::uint8_t paint) {
  constexpr double kFaint = 4.0;  // log-odds; as often paint as floor, docs/math/grid.md
  constexpr double kDoubt = 6.0;
  const double below = (255 - paint) / kEvidencePerLogOdds;
  return below < kFaint ? kOpen : below < kDoubt ? kHidden : PackedLabels::kConfidenceLevels - 1;
}

// Not 0 where floor may be faint paint, if it says so: not beside labelled paint.
cv::Mat awayFromPaint(const BevLabels& labels) {
  constexpr double kEdge = 0.08;  // m
  const int edge = static_cast<int>(std::lround(kEdge / labels.geometry.metres_per_px));
  cv::Mat paint;
  cv::inRange(labels.labels, static_cast<int>(SemanticClass::kSlotLine),
              static_cast<int>(SemanticClass::kPaintedNumber), paint);
  cv::dilate(paint, paint, cv::Mat::ones(2 * edge + 1, 2 * edge + 1, CV_8UC1));
  return paint == 0;
}

}  // namespace

double PackedLabels::toBorder(const Eigen::Vector2d& p_level) const {
  const Eigen::Vector2d p = geometry.toPixel(p_level);
  const double px =
      std::min({p.x(), geometry.width_px - 1 - p.x(), p.y(), geometry.height_px - 1 - p.y()});
  return px * geometry.metres_per_px;
}

bool PackedLabels::isMoving(const Eigen::Vector2d& p_level) const {
  return std::any_of(moving.begin(), moving.end(), [&](const Box& box) {
    const Eigen::Vector2d from = p_level - box.center;
    const double c = std::cos(box.heading);
    const double s = std::sin(box.heading);
    return std::abs(c * from.x() + s * from.y()) <= box.half_size.x() &&
           std::abs(c * from.y() - s * from.x()) <= box.half_size.y();
  });
}

PackedLabels packLabels(const SemanticFrame& frame) {
  const BevGeometry& g = frame.labels.geometry;
  const cv::Mat& labels = frame.labels.labels;
  const cv::Mat& confidence = frame.labels.confidence;
  const cv::Mat& smear = frame.smear;
  PARKADE_CHECK(labels.type() == CV_8UC1 && labels.rows == g.height_px && labels.cols == g.width_px,
                "labels of {} x {} pixels, type {}", labels.cols, labels.rows, labels.type());
  PARKADE_CHECK(confidence.empty() || confidence.size() == labels.size(),
                "confidence of {} x {} pixels", confidence.cols, confidence.rows);
  PARKADE_CHECK(smear.empty() || smear.size() == labels.size(), "smear of {} x {} pixels",
                smear.cols, smear.rows);
  const cv::Mat& paint = frame.labels.paint;
  PARKADE_CHECK(paint.empty() || paint.size() == labels.size(), "paint of {} x {} pixels",
                paint.cols, paint.rows);
  const cv::Mat open = paint.empty() ? cv::Mat() : awayFromPaint(frame.labels);
  PackedLabels packed;
  packed.geometry = g;
  packed.pixels.resize(static_cast<std::size_t>(g.width_px) *
                       static_cast<std::size_t>(g.height_px));
  std::size_t at = 0;
  for (int v = 0; v < g.height_px; ++v) {
    const std::uint8_t* label = labels.ptr<std::uint8_t>(v);
    const std::uint8_t* sure = confidence.empty() ? nullptr : confidence.ptr<std::uint8_t>(v);
    const std::uint8_t* smeared = smear.empty() ? nullptr : smear.ptr<std::uint8_t>(v);
    for (int u = 0; u < g.width_px; ++u, ++at) {
      int level = sure == nullptr ? PackedLabels::kConfidenceLevels - 1 : sure[u] >> 5;
      if (smeared != nullptr && smeared[u] != 0) {
        if (smeared[u] == SemanticFrame::kSmear) continue;
        level = std::min(level, kHidden);
      }
      if (label[u] == static_cast<std::uint8_t>(SemanticClass::kFloor) && !open.empty() &&
          open.at<std::uint8_t>(v, u) != 0) {
        level = std::min(level, floorLevel(paint.at<std::uint8_t>(v, u)));
      }
      packed.pixels[at] =
          label[u] == 0 ? 0 : static_cast<std::uint8_t>((label[u] & 0x1F) | (level << 5));
    }
  }
  for (const MovingObservation& object : frame.moving) {
    if (!object.moving) continue;
    // The contact is the nearest ground point: the body lies behind it, as seen from the car. The
    // margin takes in what the picture draws of the body beyond its foot.
    PackedLabels::Box box;
    constexpr double kMargin = 0.5;
    const Eigen::Vector2d size = object.size.cwiseMax(0.5);
    box.half_size = 0.5 * size + Eigen::Vector2d::Constant(kMargin);
    box.heading = object.heading;
    const double away = object.contact.norm();
    box.center = object.contact;
    if (object.semantic_class == SemanticClass::kVehicle && away > 1e-6) {
      const double turn = object.heading - std::atan2(object.contact.y(), object.contact.x());
      const double deep = std::abs(std::cos(turn)) * size.x() + std::abs(std::sin(turn)) * size.y();
      box.center += object.contact / away * (0.5 * deep);
    }
    packed.moving.push_back(box);
  }
  return packed;
}

LayerRole roleOf(SemanticClass semantic_class) {
  switch (semantic_class) {
    case SemanticClass::kFloor:
      return LayerRole::kGround;
    case SemanticClass::kSlotLine:
    case SemanticClass::kLaneLine:
      return LayerRole::kLine;
    case SemanticClass::kArrow:
    case SemanticClass::kSpeedLimitPaint:
    case SemanticClass::kStopLine:
    case SemanticClass::kCrossing:
    case SemanticClass::kSpeedBump:
    case SemanticClass::kPaintedNumber:
    case SemanticClass::kWheelStop:
      return LayerRole::kRoadMarker;
    case SemanticClass::kPillar:
    case SemanticClass::kWall:
    case SemanticClass::kZoneMarker:
      return LayerRole::kStructure;
    case SemanticClass::kVehicle:
      return LayerRole::kVehicle;
    case SemanticClass::kPedestrian:
      return LayerRole::kPerson;
    case SemanticClass::kUnknown:
    case SemanticClass::kCeiling:
    case SemanticClass::kGuideSign:
    case SemanticClass::kSpeedLimitSign:
      break;
  }
  return LayerRole::kNone;
}

EvidenceKernel::EvidenceKernel(const EvidenceOptions& options)
    : full_range_(std::min(options.full_range_m, options.range_m - 1e-3)), range_(options.range_m) {
  const auto inSteps = [](double log_odds) {
    return static_cast<int>(std::lround(log_odds / GridCell::kStep));
  };
  for (int level = 0; level < PackedLabels::kConfidenceLevels; ++level) {
    // The middle of the level's interval; a class that is no more likely than not says nothing.
    const double p = std::clamp((level + 0.5) / PackedLabels::kConfidenceLevels, 0.5, 0.95);
    const double log_odds = std::log(p / (1.0 - p));
    for (int w = 0; w <= kWeights; ++w) {
      const double seen = options.gain * log_odds * w / kWeights;
      const int bare =
          level == kOpen ? 0
                         : std::max(std::min(1, inSteps(seen)), inSteps(options.bare_share * seen));
      steps_[static_cast<std::size_t>(level)][static_cast<std::size_t>(w)] = {
          inSteps(seen), bare, inSteps(options.dynamic_gain * log_odds)};
    }
  }
}

}  // namespace parkade
