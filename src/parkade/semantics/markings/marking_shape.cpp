// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/marking_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

struct Placement {
  Eigen::Vector2d origin;
  double heading = 0.0;
  double length = 1.0;
};

// Intersection over union; points stands for `all` pixels of the given area.
double overlapOf(const MarkingShape& shape, const Placement& at,
                 const std::vector<Eigen::Vector2d>& points, double all, double pixel) {
  const double c = std::cos(at.heading) / at.length;
  const double s = std::sin(at.heading) / at.length;
  int inside = 0;
  for (const Eigen::Vector2d& p : points) {
    const double dx = p.x() - at.origin.x();
    const double dy = p.y() - at.origin.y();
    if (shape.covers(c * dx + s * dy, c * dy - s * dx)) ++inside;
  }
  const double both = inside * all / static_cast<double>(points.size());
  const double area = shape.area() * at.length * at.length / (pixel * pixel);
  return both / std::max(all + area - both, 1.0);
}

// Steps in heading, place and size that shrink while none of them helps.
double refine(const MarkingShape& shape, const std::vector<Eigen::Vector2d>& points, double all,
              double pixel, double heading_step, Placement& at) {
  double best = overlapOf(shape, at, points, all, pixel);
  double move = 1.5 * pixel;
  double turn = 0.5 * heading_step;
  for (int round = 0; round < 16 && move > 0.12 * pixel; ++round) {
    bool better = false;
    const Eigen::Vector2d ahead(std::cos(at.heading), std::sin(at.heading));
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const Eigen::Vector2d middle = at.origin + 0.5 * at.length * ahead;
    for (int k = 0; k < 10; ++k) {
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      Placement next = at;
      if (k < 2) next.origin += sign * move * ahead;
      if (k == 2 || k == 3) next.origin += sign * move * left;
      if (k == 4 || k == 5) {  // about its middle
        next.heading += sign * turn;
        next.origin = middle - 0.5 * at.length *
                                   Eigen::Vector2d(std::cos(next.heading), std::sin(next.heading));
      }
      if (k == 6 || k == 7) next.length += sign * move;  // tip
      if (k > 7) {                                       // tail
        next.length += sign * move;
        next.origin -= sign * move * ahead;
      }
      if (next.length < 2.0 * pixel) continue;
      const double overlap = overlapOf(shape, next, points, all, pixel);
      if (overlap <= best + 1e-9) continue;
      best = overlap;
      at = next;
      better = true;
      break;
    }
    if (better) continue;
    move *= 0.5;
    turn *= 0.5;
  }
  return best;
}

}  // namespace

MarkingShape::MarkingShape(std::string meaning,
                           const std::vector<std::vector<Eigen::Vector2d>>& polygons)
    : meaning_(std::move(meaning)) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d high = -low;
  for (const auto& polygon : polygons) {
    for (const Eigen::Vector2d& p : polygon) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  PARKADE_CHECK((high - low).minCoeff() > 0.0, "shape {}: empty", meaning_);
  constexpr double kFine = 4.0 * kCells;  // drawn finer than it is kept
  const double scale = kFine / (high.x() - low.x());
  const int columns = static_cast<int>(std::lround((high.y() - low.y()) * scale));
  cv::Mat picture(static_cast<int>(kFine), std::max(1, columns), CV_8UC1, cv::Scalar(0));
  for (const auto& polygon : polygons) {
    std::vector<cv::Point> corners;
    for (const Eigen::Vector2d& p : polygon) {
      constexpr double kShift = 16.0;
      corners.emplace_back(
          static_cast<int>(std::lround(((high.y() - p.y()) * scale - 0.5) * kShift)),
          static_cast<int>(std::lround(((high.x() - p.x()) * scale - 0.5) * kShift)));
    }
    cv::fillPoly(picture, std::vector<std::vector<cv::Point>>{corners}, cv::Scalar(255), 8, 4);
  }
  fill(picture);
  // The middle of the frame of the polygons is lost but for y = 0, which is the axis.
  low_ = low.y() / (high.x() - low.x());
}

MarkingShape::MarkingShape(std::string meaning, const cv::Mat& picture)
    : meaning_(std::move(meaning)) {
  const cv::Rect box = cv::boundingRect(picture);
  PARKADE_CHECK(!box.empty(), "shape {}: empty", meaning_);
  fill(picture(box));
  low_ = -0.5 * width_;
}

void MarkingShape::fill(const cv::Mat& picture) {
  width_ = static_cast<double>(picture.cols) / picture.rows;
  columns_ = std::max(1, static_cast<int>(std::lround(width_ * kCells)));
  cv::Mat small;
  cv::resize(picture, small, cv::Size(columns_, kCells), 0.0, 0.0, cv::INTER_AREA);
  cells_.assign(static_cast<std::size_t>(kCells * columns_), 0);
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < columns_; ++j) {
      const bool on = small.at<std::uint8_t>(kCells - 1 - i, columns_ - 1 - j) >= 128;
      cells_[static_cast<std::size_t>(i * columns_ + j)] = on ? 1 : 0;
    }
  }
  area_ = static_cast<double>(std::count(cells_.begin(), cells_.end(), 1)) / (kCells * kCells);
}

ShapeFit fitShape(const std::vector<Eigen::Vector2d>& points, double pixel,
                  const std::vector<MarkingShape>& shapes, const ShapeSearch& search) {
  ShapeFit fit;
  if (points.empty() || shapes.empty()) return fit;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / search.points);
  std::vector<Eigen::Vector2d> some;
  for (std::size_t i = 0; i < points.size(); i += stride) some.push_back(points[i]);
  const auto all = static_cast<double>(points.size());

  // The extent along and across a heading tells the place and the size of every shape.
  std::vector<Placement> best(shapes.size());
  std::vector<double> overlap(shapes.size(), 0.0);
  const int steps = static_cast<int>(std::ceil(search.half_range / search.step));
  const int turns = static_cast<int>(std::lround(2.0 * M_PI / search.turn));
  for (int k = -steps; k <= steps; ++k) {
    if (turns == 1 && k == steps && search.half_range >= M_PI - 1e-9) continue;
    const double heading = search.heading + k * search.step;
    const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
    double x0 = std::numeric_limits<double>::max();
    double x1 = -x0;
    double y0 = x0;
    double y1 = x1;
    for (const Eigen::Vector2d& p : points) {
      const double x = ahead.dot(p);
      const double y = ahead.x() * p.y() - ahead.y() * p.x();
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
    const double length = x1 - x0 + pixel;
    const double width = y1 - y0 + pixel;
    if (length < search.min_length || length > search.max_length) continue;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const MarkingShape& shape = shapes[i];
      const double expected = shape.width() * length;
      if (std::abs(expected - width) > search.width_slack * expected + 3.0 * pixel) continue;
      for (int turn = 0; turn < turns; ++turn) {
        // The other way round the extents change their signs.
        const double sign = turn == 0 ? 1.0 : -1.0;
        const double tail = turn == 0 ? x0 - 0.5 * pixel : -(x1 + 0.5 * pixel);
        const double middle = sign * 0.5 * (y0 + y1);
        const double axis = middle - (shape.low() + 0.5 * shape.width()) * length;
        const Eigen::Vector2d facing = sign * ahead;
        Placement at;
        at.origin = tail * facing + axis * Eigen::Vector2d(-facing.y(), facing.x());
        at.heading = heading + turn * search.turn;
        at.length = length;
        const double found = overlapOf(shape, at, some, all, pixel);
        if (found <= overlap[i]) continue;
        overlap[i] = found;
        best[i] = at;
      }
    }
  }

  // Only those near the best are worth a closer look.
  const double most = *std::max_element(overlap.begin(), overlap.end());
  constexpr double kClose = 0.75;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (overlap[i] <= 0.0 || overlap[i] < kClose * most) continue;
    overlap[i] = refine(shapes[i], some, all, pixel, search.step, best[i]);
  }
  const auto top = std::max_element(overlap.begin(), overlap.end());
  if (*top <= 0.0) return fit;
  const auto index = static_cast<std::size_t>(top - overlap.begin());
  fit.shape = static_cast<int>(index);
  fit.overlap = *top;
  fit.origin = best[index].origin;
  fit.heading = best[index].heading;
  fit.length = best[index].length;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].meaning() != shapes[index].meaning()) fit.next = std::max(fit.next, overlap[i]);
  }
  return fit;
}

}  // namespace parkade
