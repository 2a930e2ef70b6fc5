// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/marking_objects.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "parkade/geometry/se2.hpp"
#include "parkade/semantics/markings/arrow_fitting.hpp"
#include "parkade/semantics/markings/marking_arrows.hpp"
#include "parkade/semantics/markings/marking_pieces.hpp"
#include "parkade/semantics/standing/standing_foot.hpp"
#include "parkade/semantics/standing/tilt_error.hpp"

namespace parkade {
namespace {

// A rectangle around points: x along its longer side.
struct Box {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();
  double length = 0.0;
  double width = 0.0;

  [[nodiscard]] std::vector<Eigen::Vector2d> outline() const {
    const Eigen::Vector2d x = 0.5 * length * along;
    const Eigen::Vector2d y = 0.5 * width * Eigen::Vector2d(-along.y(), along.x());
    return {center - x - y, center + x - y, center + x + y, center - x + y};
  }
};

Box boxAround(const std::vector<Eigen::Vector2d>& points, double pixel) {
  std::vector<cv::Point2f> input;
  input.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    input.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  const cv::RotatedRect rect = cv::minAreaRect(input);
  Box box;
  box.center = {rect.center.x, rect.center.y};
  const bool swap = rect.size.height > rect.size.width;
  const double angle = (rect.angle + (swap ? 90.0 : 0.0)) * M_PI / 180.0;
  box.along = {std::cos(angle), std::sin(angle)};
  box.length = std::max(rect.size.width, rect.size.height) + pixel;
  box.width = std::min(rect.size.width, rect.size.height) + pixel;
  return box;
}

// What each class of box may measure, m, and how much of the box is paint.
struct BoxLimits {
  double min_length, max_length, min_width, max_width, min_fill;
};

std::optional<BoxLimits> limitsOf(SemanticClass c) {
  switch (c) {
    case SemanticClass::kStopLine:
      return BoxLimits{1.0, 9.0, 0.12, 0.9, 0.4};
    case SemanticClass::kCrossing:
      return BoxLimits{1.5, 14.0, 1.0, 5.0, 0.25};
    case SemanticClass::kSpeedBump:
      return BoxLimits{1.5, 14.0, 0.15, 1.2, 0.5};
    case SemanticClass::kWheelStop:
      return BoxLimits{0.3, 2.5, 0.08, 0.6, 0.4};
    case SemanticClass::kPaintedNumber:
      return BoxLimits{0.15, 3.0, 0.1, 2.0, 0.1};
    default:
      return std::nullopt;
  }
}

bool asBox(const MarkingPiece& piece, double pixel, ObjectObservation& object) {
  const std::optional<BoxLimits> limits = limitsOf(piece.semantic_class);
  if (!limits) return false;
  const Box box = boxAround(piece.points, pixel);
  if (box.length < limits->min_length || box.length > limits->max_length ||
      box.width < limits->min_width || box.width > limits->max_width) {
    return false;
  }
  const double fill =
      static_cast<double>(piece.points.size()) * pixel * pixel / (box.length * box.width);
  if (fill < limits->min_fill) return false;
  object.position << box.center, 0.0;
  object.outline = box.outline();
  object.confidence = piece.confidence;
  return true;
}

// sigma_along: m, what the shape leaves open along the heading.
void asArrow(const FittedArrow& arrow, double pixel, const std::vector<MarkingShape>& shapes,
             const MarkingOptions& options, ObjectObservation& object, double& sigma_along) {
  const MarkingPiece& piece = arrow.paint;
  const ShapeFit& fit = arrow.fit;
  const Eigen::Vector2d ahead(std::cos(fit.heading), std::sin(fit.heading));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const MarkingShape& shape = shapes[static_cast<std::size_t>(fit.shape)];
  // Its ends from the paint, where that ends near the shape's: proportions differ.
  double back = std::numeric_limits<double>::max();
  double front = -back;
  for (const Eigen::Vector2d& p : piece.points) {
    back = std::min(back, ahead.dot(p - fit.origin) - 0.5 * pixel);
    front = std::max(front, ahead.dot(p - fit.origin) + 0.5 * pixel);
  }
  const double slack = 0.15 * fit.length;
  back = std::clamp(back, -slack, slack);
  front = std::clamp(front, fit.length - slack, fit.length + slack);
  object.position << fit.origin + 0.5 * (back + front) * ahead, 0.0;
  object.heading = wrapAngle(fit.heading);
  object.sigma_heading = std::max(0.01, 1.5 * pixel / fit.length);
  if (fit.overlap - fit.next >= options.min_lead) object.text = shape.meaning();
  const Eigen::Vector2d tail = fit.origin + shape.low() * fit.length * left;
  const Eigen::Vector2d x = fit.length * ahead;
  const Eigen::Vector2d y = shape.width() * fit.length * left;
  object.outline = {tail, tail + x, tail + x + y, tail + y};
  // Worn ends, or others than the shape's, leave its length open.
  sigma_along = 0.08 * fit.length * (1.0 - fit.overlap);
  // Half covered by its shape is half worn, or something else: told less surely.
  object.confidence = piece.confidence * std::min(1.0, fit.overlap / 0.7);
}

bool asLimit(const MarkingPiece& piece, double pixel, const std::vector<MarkingShape>& shapes,
             const MarkingOptions& options, ObjectObservation& object) {
  std::vector<cv::Point2f> input;
  for (const Eigen::Vector2d& p : piece.points) {
    input.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()));
  }
  cv::Point2f middle;
  float reach = 0.0F;
  cv::minEnclosingCircle(input, middle, reach);
  const Eigen::Vector2d center(middle.x, middle.y);
  const double radius = reach + 0.5 * pixel;
  if (radius < 0.3 || radius > 2.0) return false;
  // A ring: paint near the rim, most of the way round.
  constexpr int kSectors = 24;
  std::array<int, kSectors> sectors{};
  std::vector<Eigen::Vector2d> inner;
  for (const Eigen::Vector2d& p : piece.points) {
    const Eigen::Vector2d d = p - center;
    if (d.norm() > 0.78 * radius) {
      const double turn = (std::atan2(d.y(), d.x()) + M_PI) / (2.0 * M_PI) * kSectors;
      ++sectors[static_cast<std::size_t>(std::min(kSectors - 1, static_cast<int>(turn)))];
    } else {
      inner.push_back(p);
    }
  }
  const auto filled = kSectors - std::count(sectors.begin(), sectors.end(), 0);
  if (filled < kSectors / 2) return false;
  object.position << center, 0.0;
  constexpr int kCorners = 16;
  for (int k = 0; k < kCorners; ++k) {
    const double turn = 2.0 * M_PI * k / kCorners;
    object.outline.emplace_back(center + radius * Eigen::Vector2d(std::cos(turn), std::sin(turn)));
  }
  object.confidence = piece.confidence * static_cast<double>(filled) / kSectors;
  if (inner.size() < 12) return true;
  ShapeSearch search;
  search.step = M_PI / 30.0;
  search.min_length = 0.35 * radius;
  search.max_length = 1.7 * radius;
  const ShapeFit fit = fitShape(inner, pixel, shapes, search);
  // Digits differ less than arrows do.
  if (fit.shape < 0 || fit.overlap < 0.8 * options.min_overlap ||
      fit.overlap - fit.next < 1.5 * options.min_lead) {
    return true;
  }
  object.text = shapes[static_cast<std::size_t>(fit.shape)].meaning();
  object.heading = wrapAngle(fit.heading);
  object.sigma_heading = std::max(0.03, 2.0 * pixel / fit.length);
  return true;
}

}  // namespace

Eigen::Matrix3d groundCovariance(const BevViews& views, const BevGeometry& geometry,
                                 const Eigen::Vector2d& p, double sigma, double attitude_sigma) {
  constexpr double kUneven = 0.02;   // m
  constexpr double kHeight = 0.005;  // m, 1 sigma, of the body over the floor
  const BevViews::View& view = views.viewAt(geometry, p);
  const Eigen::Matrix2d J = groundTiltJacobian(p - view.foot, view.height);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = sigma * sigma * Eigen::Matrix2d::Identity() +
                                     attitude_sigma * attitude_sigma * J * J.transpose();
  const Eigen::Vector2d stretch = kHeight / view.height * (p - view.foot);
  covariance.topLeftCorner<2, 2>() += stretch * stretch.transpose();
  covariance(2, 2) = kUneven * kUneven;
  return covariance;
}

MarkingExtractor::MarkingExtractor(const MarkingOptions& options)
    : options_(options), arrows_(arrowShapes()), limits_(limitShapes()) {}

std::vector<ObjectObservation> MarkingExtractor::extract(const BevLabels& labels,
                                                         const BevViews& views,
                                                         double attitude_sigma) const {
  const double pixel = labels.geometry.metres_per_px;
  std::vector<ObjectObservation> objects;
  const auto add = [&](ObjectObservation& object, double sigma_along,
                       const Eigen::Vector2d& along) {
    object.covariance = groundCovariance(views, labels.geometry, object.position.head<2>(),
                                         options_.sigma_px * pixel, attitude_sigma);
    object.covariance.topLeftCorner<2, 2>() +=
        sigma_along * sigma_along * along * along.transpose();
    objects.push_back(std::move(object));
  };
  std::vector<MarkingPiece> arrows;
  for (MarkingPiece& piece : findMarkings(labels, options_.min_confidence, options_.min_pixels)) {
    if (piece.semantic_class == SemanticClass::kArrow) {
      arrows.push_back(std::move(piece));
      continue;
    }
    constexpr double kStopDepth = 0.16;  // m
    if (piece.semantic_class == SemanticClass::kWheelStop) {
      piece = footOf(piece, views, labels.geometry, kStopDepth);
    }
    if (piece.cut) continue;
    ObjectObservation object;
    object.semantic_class = piece.semantic_class;
    const bool found = piece.semantic_class == SemanticClass::kSpeedLimitPaint
                           ? asLimit(piece, pixel, limits_, options_, object)
                           : asBox(piece, pixel, object);
    if (!found) continue;
    if (!piece.may_go_on) {
      add(object, 0.0, Eigen::Vector2d::UnitX());
      continue;
    }
    constexpr double kNextBar = 0.4;  // m, by which one more would move the middle
    object.confidence *= 0.5;         // others' outlines first
    add(object, kNextBar, (object.outline[1] - object.outline[0]).normalized());
  }
  const ArrowLimits limits{options_.min_overlap, options_.min_arrow_m};
  for (const FittedArrow& arrow : fitArrows(std::move(arrows), pixel, arrows_, limits)) {
    ObjectObservation object;
    object.semantic_class = SemanticClass::kArrow;
    double sigma_along = 0.0;
    asArrow(arrow, pixel, arrows_, options_, object, sigma_along);
    add(object, sigma_along, {std::cos(object.heading), std::sin(object.heading)});
  }
  return objects;
}

}  // namespace parkade
