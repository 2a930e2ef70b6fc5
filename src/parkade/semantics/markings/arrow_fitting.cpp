// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/arrow_fitting.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace parkade {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kPlain = 0.7;        // an overlap from which there is nothing to be doubted
constexpr double kApart = 1.0;        // m: an arrow's parts lie no farther apart
constexpr std::ptrdiff_t kMost = 24;  // pieces that are tried together, the largest

// coarse: a first look, several times faster.
ShapeFit bestFit(const Points& points, double pixel, const std::vector<MarkingShape>& shapes,
                 const ArrowLimits& limits, bool coarse = false) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(spread);
  const Eigen::Vector2d axis = eigen.eigenvectors().col(1);
  ShapeSearch search;
  search.heading = std::atan2(axis.y(), axis.x());
  search.turn = M_PI;
  // Heads to one side turn the main axis away from the shaft; a T may be as wide as it is long.
  const double ratio = eigen.eigenvalues()[0] / std::max(eigen.eigenvalues()[1], 1e-9);
  search.half_range = ratio > 0.4 ? M_PI_2 : (ratio > 0.05 ? 0.8 : 0.25);
  search.step = coarse ? M_PI / 30.0 : M_PI / 45.0;
  if (coarse) search.points = 50;
  search.min_length = limits.min_length;
  search.max_length = limits.max_length;
  return fitShape(points, pixel, shapes, search);
}

// A piece, or several taken together, and what they are taken for.
class Part {
 public:
  Part(MarkingPiece paint, double pixel, const std::vector<MarkingShape>& shapes,
       const ArrowLimits& limits)
      : paint_(std::move(paint)), fit_(bestFit(paint_.points, pixel, shapes, limits)) {
    for (const Eigen::Vector2d& p : paint_.points) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    const bool fits = fit_.shape >= 0 && fit_.overlap >= limits.min_overlap;
    is_arrow_ = fits && !shapes[static_cast<std::size_t>(fit_.shape)].meaning().empty();
    // Pixels told rightly. Of a bar some are, whatever it may be; of what fits nothing a few.
    constexpr double kBar = 0.65;
    constexpr double kNothing = 0.3;
    const double share = is_arrow_ ? fit_.overlap : (fits ? kBar * fit_.overlap : kNothing);
    value_ = share * static_cast<double>(paint_.points.size());
  }

  [[nodiscard]] const MarkingPiece& paint() const { return paint_; }
  [[nodiscard]] const ShapeFit& fit() const { return fit_; }
  [[nodiscard]] bool isArrow() const { return is_arrow_; }
  [[nodiscard]] bool isPlain() const { return is_arrow_ && fit_.overlap >= kPlain; }
  [[nodiscard]] double value() const { return value_; }

  // Between the nearest of their points, m; more than kApart: at least so much.
  [[nodiscard]] double distanceTo(const Part& other) const {
    const Eigen::Vector2d gap = (other.low_ - high_).cwiseMax(low_ - other.high_);
    const double least = gap.cwiseMax(0.0).norm();
    if (least > kApart) return least;
    double nearest = std::numeric_limits<double>::max();
    for (const Eigen::Vector2d& p : paint_.points) {
      for (const Eigen::Vector2d& q : other.paint_.points) {
        nearest = std::min(nearest, (p - q).squaredNorm());
      }
    }
    return std::sqrt(nearest);
  }

 private:
  MarkingPiece paint_;
  ShapeFit fit_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d high_ = -low_;
  bool is_arrow_ = false;
  double value_ = 0.0;
};

// Of pieces that are not cut off: what of their pixels lies at an edge is of no interest any more.
MarkingPiece unionOf(const MarkingPiece& a, const MarkingPiece& b) {
  MarkingPiece both = a;
  both.points.insert(both.points.end(), b.points.begin(), b.points.end());
  const auto share = static_cast<double>(a.points.size()) / static_cast<double>(both.points.size());
  both.confidence = share * a.confidence + (1.0 - share) * b.confidence;
  return both;
}

// The parts of a piece that hang together.
std::vector<MarkingPiece> splitAtGaps(const MarkingPiece& piece, double pixel) {
  cv::Point low(std::numeric_limits<int>::max(), std::numeric_limits<int>::max());
  cv::Point high(-low.x, -low.y);
  std::vector<cv::Point> cells;
  for (const Eigen::Vector2d& p : piece.points) {
    const Eigen::Vector2d steps = (p - piece.points.front()) / pixel;  // whole numbers, nearly
    cells.emplace_back(static_cast<int>(std::lround(steps.x())),
                       static_cast<int>(std::lround(steps.y())));
    low = {std::min(low.x, cells.back().x), std::min(low.y, cells.back().y)};
    high = {std::max(high.x, cells.back().x), std::max(high.y, cells.back().y)};
  }
  cv::Mat paint(high.y - low.y + 1, high.x - low.x + 1, CV_8UC1, cv::Scalar(0));
  for (const cv::Point& c : cells) paint.at<std::uint8_t>(c - low) = 255;
  cv::Mat part_of;
  const int count = cv::connectedComponents(paint, part_of, 8, CV_32S);
  std::vector<MarkingPiece> parts(static_cast<std::size_t>(count - 1));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto k = static_cast<std::size_t>(part_of.at<int>(cells[i] - low) - 1);
    parts[k].points.push_back(piece.points[i]);
  }
  for (MarkingPiece& part : parts) {
    part.semantic_class = piece.semantic_class;
    part.confidence = piece.confidence;
  }
  return parts;
}

// Takes the two parts together that gain most by it, as long as any do. A first look at each pair
// tells which; a second one at the best whether it is so.
void unite(std::vector<Part>& parts, double pixel, const std::vector<MarkingShape>& shapes,
           const ArrowLimits& limits) {
  struct Pair {
    std::size_t a, b;  // serial numbers
    double gain;       // by the first look
  };
  std::vector<std::size_t> serial(parts.size());
  for (std::size_t i = 0; i < serial.size(); ++i) serial[i] = i;
  std::size_t next = parts.size();
  std::vector<Pair> pairs;
  const auto consider = [&](std::size_t i, std::size_t j) {
    constexpr double kRough = 0.05;  // by which a first look may err
    if (parts[i].isPlain() && parts[j].isPlain()) return;
    if (parts[i].distanceTo(parts[j]) > kApart) return;
    const MarkingPiece both = unionOf(parts[i].paint(), parts[j].paint());
    const double overlap = bestFit(both.points, pixel, shapes, limits, true).overlap + kRough;
    const double gain =
        overlap * static_cast<double>(both.points.size()) - parts[i].value() - parts[j].value();
    if (overlap >= limits.min_overlap && gain > 0.0) pairs.push_back({serial[i], serial[j], gain});
  };
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = i + 1; j < parts.size(); ++j) consider(i, j);
  }
  const auto placeOf = [&](std::size_t one) {
    return std::find(serial.begin(), serial.end(), one) - serial.begin();
  };
  while (!pairs.empty()) {
    const auto best = std::max_element(
        pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.gain < b.gain; });
    const std::size_t gone[2] = {best->a, best->b};
    pairs.erase(best);
    const Part& first = parts[static_cast<std::size_t>(placeOf(gone[0]))];
    const Part& second = parts[static_cast<std::size_t>(placeOf(gone[1]))];
    Part both(unionOf(first.paint(), second.paint()), pixel, shapes, limits);
    if (!both.isArrow() || both.value() <= first.value() + second.value()) continue;
    for (const std::size_t one : gone) {
      const auto at = placeOf(one);
      serial.erase(serial.begin() + at);
      parts.erase(parts.begin() + at);
      std::erase_if(pairs, [one](const Pair& p) { return p.a == one || p.b == one; });
    }
    parts.push_back(std::move(both));
    serial.push_back(next++);
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) consider(i, parts.size() - 1);
  }
}

}  // namespace

std::vector<FittedArrow> fitArrows(std::vector<MarkingPiece> pieces, double pixel,
                                   const std::vector<MarkingShape>& shapes,
                                   const ArrowLimits& limits) {
  // What does not fit as it is may be several things that touch.
  constexpr std::size_t kLeast = 8;  // px
  constexpr double kClearly = 1.15;
  std::vector<Part> parts;
  for (MarkingPiece& piece : pieces) {
    if (piece.cut) continue;  // its place is not known
    Part whole(std::move(piece), pixel, shapes, limits);
    if (whole.isPlain()) {
      parts.push_back(std::move(whole));
      continue;
    }
    std::vector<MarkingPiece> split = splitAtGaps(whole.paint(), pixel);
    std::erase_if(split, [](const MarkingPiece& p) { return p.points.size() < kLeast; });
    std::vector<Part> own;
    double apart = 0.0;
    if (split.size() > 1 && std::ssize(split) <= kMost) {
      for (MarkingPiece& one : split) own.emplace_back(std::move(one), pixel, shapes, limits);
      unite(own, pixel, shapes, limits);
      for (const Part& part : own) apart += part.value();
    }
    const double least = whole.isArrow() ? kClearly * whole.value() : whole.value();
    if (own.size() > 1 && apart > least) {
      for (Part& part : own) parts.push_back(std::move(part));
    } else {
      parts.push_back(std::move(whole));
    }
  }
  std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.paint().points.size() > b.paint().points.size();
  });
  if (std::ssize(parts) > kMost) parts.erase(parts.begin() + kMost, parts.end());
  unite(parts, pixel, shapes, limits);
  std::vector<FittedArrow> arrows;
  for (const Part& part : parts) {
    if (part.isArrow()) arrows.push_back({part.paint(), part.fit()});
  }
  return arrows;
}

}  // namespace parkade
