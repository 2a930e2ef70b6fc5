// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/line_extraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "parkade/core/check.hpp"
#include "parkade/core/units.hpp"
#include "parkade/semantics/lines/line_chains.hpp"
#include "parkade/semantics/lines/line_segments.hpp"
#include "parkade/semantics/standing/tilt_error.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

double sampleAt(const cv::Mat& grey, const Vector2d& p) {
  const int u = static_cast<int>(std::floor(p.x()));
  const int v = static_cast<int>(std::floor(p.y()));
  if (u < 0 || v < 0 || u + 1 >= grey.cols || v + 1 >= grey.rows) return -1.0;
  const double a = p.x() - u;
  const double b = p.y() - v;
  const std::uint8_t* up = grey.ptr<std::uint8_t>(v) + u;
  const std::uint8_t* down = grey.ptr<std::uint8_t>(v + 1) + u;
  return (1.0 - b) * ((1.0 - a) * up[0] + a * up[1]) + b * ((1.0 - a) * down[0] + a * down[1]);
}

// The picture across a line, averaged over a few pixels along it.
class Profile {
 public:
  Profile(const cv::Mat& grey, const Vector2d& center, const Vector2d& across, double width)
      : half_(0.5 * width) {
    constexpr double kBeyond = 3.5;
    const Vector2d along(-across.y(), across.x());
    count_ = std::min(kMost, static_cast<int>(std::ceil((half_ + kBeyond) / kStep)) * 2 + 1);
    for (int i = 0; i < count_; ++i) {
      double sum = 0.0;
      for (const double s : {-1.0, 0.0, 1.0}) {
        const double value = sampleAt(grey, center + at(i) * across + s * along);
        if (value < 0.0) return;
        sum += value;
      }
      values_[static_cast<std::size_t>(i)] = sum / 3.0;
    }
    inside_ = true;
  }

  // Offset of the line's middle from where the profile is centred, px; none without clear edges.
  [[nodiscard]] std::optional<double> middle(double min_contrast) const {
    if (!inside_) return std::nullopt;
    const double paint = mean(-0.25 * half_ - kStep, 0.25 * half_ + kStep);
    const double left = paint - mean(-half_ - 3.0, -half_ - 1.5);
    const double right = paint - mean(half_ + 1.5, half_ + 3.0);
    if (left * right <= 0.0 || std::min(std::abs(left), std::abs(right)) < min_contrast) {
      return std::nullopt;
    }
    const std::optional<double> a = crossing(-1, paint - 0.5 * left, left > 0.0 ? 1.0 : -1.0);
    const std::optional<double> b = crossing(1, paint - 0.5 * right, right > 0.0 ? 1.0 : -1.0);
    if (!a || !b) return std::nullopt;
    const double width = *b - *a;
    constexpr double kMaxShift = 1.5;
    const double middle = 0.5 * (*a + *b);
    if (std::abs(middle) > kMaxShift || std::abs(width - 2.0 * half_) > std::max(2.0, half_)) {
      return std::nullopt;
    }
    return middle;
  }

 private:
  static constexpr double kStep = 0.5;
  static constexpr int kMost = 81;

  [[nodiscard]] double at(int i) const { return (i - count_ / 2) * kStep; }
  [[nodiscard]] double mean(double from, double to) const {
    double sum = 0.0;
    int n = 0;
    for (int i = 0; i < count_; ++i) {
      if (at(i) < from || at(i) > to) continue;
      sum += values_[static_cast<std::size_t>(i)];
      ++n;
    }
    return n > 0 ? sum / n : 0.0;
  }
  [[nodiscard]] std::optional<double> crossing(int step, double level, double sign) const {
    for (int i = count_ / 2; i + step >= 0 && i + step < count_; i += step) {
      const double here = sign * (values_[static_cast<std::size_t>(i)] - level);
      const double next = sign * (values_[static_cast<std::size_t>(i + step)] - level);
      if (here >= 0.0 && next < 0.0) return at(i) + step * kStep * here / (here - next);
    }
    return std::nullopt;
  }

  double half_;
  int count_ = 0;
  bool inside_ = false;
  std::array<double, kMost> values_{};
};

// Measures the lines that cross the rows of the picture, or of the transposed one.
class Measurer {
 public:
  Measurer(const cv::Mat& grey, const BevLabels& labels, double attitude_sigma,
           const LineOptions& options)
      : grey_(grey), labels_(labels), attitude_sigma_(attitude_sigma), options_(options) {}

  void run(bool transposed, std::vector<MeasuredLine>& out) const {
    const double scale = labels_.geometry.metres_per_px;
    cv::Mat labels;  // of its own: a square picture would be transposed in its place
    if (transposed) {
      cv::transpose(labels_.labels, labels);
    } else {
      labels = labels_.labels;
    }
    const double max_run = std::sqrt(2.0) * options_.max_width_m / scale + 1.0;
    for (const LineChain& chain : followLines(labels, max_run)) {
      MeasuredLine line = measure(chain, transposed);
      if (line.points.size() >= 2) out.push_back(std::move(line));
    }
  }

 private:
  [[nodiscard]] MeasuredLine measure(const LineChain& chain, bool transposed) const {
    const double scale = labels_.geometry.metres_per_px;
    MeasuredLine line;
    double done = -1e9;  // px along the chain, of the last point
    double travelled = 0.0;
    double width_sum = 0.0;
    for (std::size_t i = 0; i < chain.runs.size(); ++i) {
      const LineRun& run = chain.runs[i];
      double center = 0.0;
      double slope = 0.0;
      chain.fitAround(i, center, slope);
      const double stretch = std::sqrt(1.0 + slope * slope);
      if (i > 0) travelled += (run.row - chain.runs[i - 1].row) * stretch;
      const double width = run.width / stretch;
      // Steeper ones are the other scan's; the margin leaves none out.
      constexpr double kSteepest = 1.05;
      if (run.hidden || std::abs(slope) > kSteepest) continue;
      if (width * scale < options_.min_width_m || width * scale > options_.max_width_m) continue;
      if (confidenceAt(run, transposed) < options_.min_confidence) continue;
      if (i + 1 < chain.runs.size() && (travelled - done) * scale < options_.spacing_m) continue;
      done = travelled;
      Vector2d pixel(center, run.row);
      Vector2d across(1.0 / stretch, -slope / stretch);
      if (transposed) {
        std::swap(pixel.x(), pixel.y());
        std::swap(across.x(), across.y());
      }
      line.points.push_back(pointAt(pixel, across, width, chain.semantic_class));
      line.sigmas.push_back(refined_ * scale);
      width_sum += width * scale;
    }
    line.width = line.points.empty() ? 0.0 : width_sum / static_cast<double>(line.points.size());
    return line;
  }

  [[nodiscard]] int confidenceAt(const LineRun& run, bool transposed) const {
    const int along = static_cast<int>(std::lround(run.center));
    return transposed ? labels_.confidence.at<std::uint8_t>(along, run.row)
                      : labels_.confidence.at<std::uint8_t>(run.row, along);
  }

  [[nodiscard]] LinePoint pointAt(const Vector2d& pixel, const Vector2d& across, double width,
                                  SemanticClass semantic_class) const {
    const BevGeometry& g = labels_.geometry;
    Vector2d middle = pixel;
    refined_ = options_.label_sigma_px;
    if (const auto shift = Profile(grey_, pixel, across, width).middle(options_.min_contrast)) {
      middle += *shift * across;
      refined_ = options_.edge_sigma_px;
    }
    LinePoint point;
    point.p_level = g.toGround(middle);
    point.normal = Vector2d(-across.y(), -across.x());
    point.semantic_class = semantic_class;
    const Eigen::Matrix2d J =
        groundTiltJacobian(point.p_level - g.center, options_.camera_height_m);
    point.sigma =
        std::hypot(refined_ * g.metres_per_px, attitude_sigma_ * (J * point.normal).norm());
    return point;
  }

  const cv::Mat& grey_;
  const BevLabels& labels_;
  double attitude_sigma_;
  const LineOptions& options_;
  mutable double refined_ = 0.0;  // px, of the last point
};

// One point per cell and direction: both scans see lines along the diagonal.
std::vector<LinePoint> thinned(const std::vector<MeasuredLine>& lines, const LineOptions& options,
                               const BevGeometry& g) {
  std::vector<LinePoint> points;
  const double cell = options.spacing_m / std::sqrt(2.0);
  const int columns = static_cast<int>(g.width_px * g.metres_per_px / cell) + 3;
  const int rows = static_cast<int>(g.height_px * g.metres_per_px / cell) + 3;
  constexpr int kDirections = 4;
  std::vector<std::uint8_t> taken(static_cast<std::size_t>(columns * rows), 0);
  for (const MeasuredLine& line : lines) {
    for (const LinePoint& point : line.points) {
      const Vector2d at = point.p_level - g.center;
      const int c = static_cast<int>((at.y() + 0.5 * g.width_px * g.metres_per_px) / cell) + 1;
      const int r = static_cast<int>((at.x() + 0.5 * g.height_px * g.metres_per_px) / cell) + 1;
      if (c < 0 || r < 0 || c >= columns || r >= rows) continue;
      const double angle = std::atan2(point.normal.y(), point.normal.x()) + 2.0 * M_PI;
      const int bin = static_cast<int>(std::lround(angle * kDirections / M_PI)) % kDirections;
      std::uint8_t& bits = taken[static_cast<std::size_t>(r * columns + c)];
      const auto bit = static_cast<std::uint8_t>(1U << static_cast<unsigned>(bin));
      if ((bits & bit) != 0) continue;
      bits = static_cast<std::uint8_t>(bits | bit);
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace

Lines extractLines(const BevImage& bev, const BevLabels& labels, double attitude_sigma,
                   const LineOptions& options) {
  const BevGeometry& g = labels.geometry;
  PARKADE_CHECK(labels.labels.type() == CV_8UC1 && labels.labels.rows == g.height_px &&
                    labels.labels.cols == g.width_px,
                "labels of {} x {} pixels, type {}", labels.labels.cols, labels.labels.rows,
                labels.labels.type());
  PARKADE_CHECK(
      labels.confidence.size() == labels.labels.size() && labels.confidence.type() == CV_8UC1,
      "confidences of {} x {} pixels", labels.confidence.cols, labels.confidence.rows);
  PARKADE_CHECK(bev.image.size() == labels.labels.size(), "a picture of {} x {} pixels",
                bev.image.cols, bev.image.rows);
  cv::Mat grey = bev.image;
  if (bev.image.channels() == 3) cv::cvtColor(bev.image, grey, cv::COLOR_BGR2GRAY);
  const double tilt_sigma = std::hypot(attitude_sigma, options.sight_sigma_deg * kDegree);
  const Measurer measurer(grey, labels, tilt_sigma, options);
  std::vector<MeasuredLine> measured;
  measurer.run(false, measured);
  measurer.run(true, measured);
  Lines lines;
  SegmentOptions segment;
  segment.min_length_m = options.min_length_m;
  segment.camera_height_m = options.camera_height_m;
  segment.viewpoint = g.center;
  lines.segments = fitSegments(measured, tilt_sigma, segment);
  lines.points = thinned(measured, options, g);
  return lines;
}

}  // namespace parkade
