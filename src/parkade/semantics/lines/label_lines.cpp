// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/label_lines.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "parkade/semantics/standing/tilt_error.hpp"

namespace parkade {
namespace {

bool isLine(SemanticClass c) {
  return c == SemanticClass::kSlotLine || c == SemanticClass::kLaneLine ||
         c == SemanticClass::kStopLine;
}

// The paint of one class near a pixel.
struct Patch {
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  // pixels
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  double width = 0.0;
  bool line = false;
};

Patch lookAt(const BevLabels& bev, int u0, int v0, int half, const LabelLineOptions& options) {
  Patch patch;
  const std::uint8_t c = bev.labels.at<std::uint8_t>(v0, u0);
  std::vector<Eigen::Vector2d> pixels;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (int v = std::max(0, v0 - half); v <= std::min(bev.labels.rows - 1, v0 + half); ++v) {
    const std::uint8_t* label = bev.labels.ptr<std::uint8_t>(v);
    const std::uint8_t* sure = bev.confidence.ptr<std::uint8_t>(v);
    for (int u = std::max(0, u0 - half); u <= std::min(bev.labels.cols - 1, u0 + half); ++u) {
      if (label[u] != c || sure[u] < options.min_confidence) continue;
      pixels.emplace_back(u, v);
      mean += pixels.back();
    }
  }
  constexpr std::size_t kLeast = 12;
  if (pixels.size() < kLeast) return patch;
  mean /= static_cast<double>(pixels.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : pixels) spread += (p - mean) * (p - mean).transpose();
  spread /= static_cast<double>(pixels.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(spread);
  // Long and narrow: corners, crossings and blobs are not.
  constexpr double kElongation = 5.0;
  if (eigen.eigenvalues()[1] < kElongation * eigen.eigenvalues()[0]) return patch;
  patch.direction = eigen.eigenvectors().col(1);
  const Eigen::Vector2d across(-patch.direction.y(), patch.direction.x());
  // A short piece around the pixel's foot: where the line's middle is right here.
  double sum = 0.0;
  double squares = 0.0;
  int count = 0;
  const Eigen::Vector2d here(u0, v0);
  constexpr double kHalfPiece = 3.5;
  for (const Eigen::Vector2d& p : pixels) {
    if (std::abs(patch.direction.dot(p - here)) > kHalfPiece) continue;
    const double off = across.dot(p - here);
    sum += off;
    squares += off * off;
    ++count;
  }
  if (count < 5) return patch;
  const double offset = sum / count;
  patch.middle = here + offset * across;
  patch.width = std::sqrt(12.0 * std::max(0.0, squares / count - offset * offset));
  patch.line = patch.width * bev.geometry.metres_per_px < options.max_width_m;
  return patch;
}

}  // namespace

std::vector<LinePoint> linePointsFromLabels(const BevLabels& labels, const BevViews& views,
                                            double attitude_sigma,
                                            const LabelLineOptions& options) {
  std::vector<LinePoint> points;
  const BevGeometry& g = labels.geometry;
  const int half = static_cast<int>(std::lround(options.window_m / g.metres_per_px));
  std::set<std::tuple<int, int, int>> taken;
  // A square lattice turned by atan(1 / stride): one along rows and columns passes by lines that
  // run along them and are narrower than the stride.
  const int stride = options.stride_px;
  const int period = stride > 1 ? stride * stride + 1 : 1;
  for (int v = 0; v < labels.labels.rows; ++v) {
    for (int u = (period - stride * v % period) % period; u < labels.labels.cols; u += period) {
      const auto c = static_cast<SemanticClass>(labels.labels.at<std::uint8_t>(v, u));
      if (!isLine(c)) continue;
      const Patch patch = lookAt(labels, u, v, half, options);
      if (!patch.line) continue;
      LinePoint point;
      point.p_level = g.toGround(patch.middle);
      // Columns run to the right (-y), rows to the back (-x).
      point.normal = Eigen::Vector2d(-patch.direction.x(), patch.direction.y()).normalized();
      point.semantic_class = c;
      const std::tuple<int, int, int> cell = {
          static_cast<int>(std::floor(point.p_level.x() / options.spacing_m)),
          static_cast<int>(std::floor(point.p_level.y() / options.spacing_m)), static_cast<int>(c)};
      if (!taken.insert(cell).second) continue;
      const BevViews::View& view = views.viewAt(g, point.p_level);
      const Eigen::Matrix2d J = groundTiltJacobian(point.p_level - view.foot, view.height);
      point.sigma = std::hypot(options.sigma_px * g.metres_per_px,
                               attitude_sigma * (J * point.normal).norm());
      points.push_back(point);
    }
  }
  return points;
}

std::vector<LineSegment> segmentsOf(const std::vector<LinePoint>& points) {
  constexpr double kBin = M_PI / 36.0;
  constexpr double kOffset = 0.10;
  using Key = std::tuple<int, int, int>;
  std::map<Key, std::vector<const LinePoint*>> groups;
  for (const LinePoint& point : points) {
    // Modulo 180 degrees, with the offset in the bin's own direction.
    const Eigen::Vector2d n =
        point.normal.y() < 0.0 || (point.normal.y() == 0.0 && point.normal.x() < 0.0)
            ? Eigen::Vector2d(-point.normal)
            : point.normal;
    const int bin = static_cast<int>(std::lround(std::atan2(n.y(), n.x()) / kBin)) % 36;
    const Eigen::Vector2d axis(std::cos(bin * kBin), std::sin(bin * kBin));
    groups[{static_cast<int>(point.semantic_class), bin,
            static_cast<int>(std::lround(axis.dot(point.p_level) / kOffset))}]
        .push_back(&point);
  }
  std::vector<LineSegment> segments;
  for (auto& [key, group] : groups) {
    const double angle = std::get<1>(key) * kBin;
    const Eigen::Vector2d along(-std::sin(angle), std::cos(angle));
    std::sort(group.begin(), group.end(), [&](const LinePoint* a, const LinePoint* b) {
      return along.dot(a->p_level) < along.dot(b->p_level);
    });
    std::size_t begin = 0;
    for (std::size_t i = 1; i <= group.size(); ++i) {
      constexpr double kGap = 1.0;
      const bool ends =
          i == group.size() || along.dot(group[i]->p_level - group[i - 1]->p_level) > kGap;
      if (!ends) continue;
      const std::size_t count = i - begin;
      const double length = along.dot(group[i - 1]->p_level - group[begin]->p_level);
      if (count >= 6 && length >= 1.0) {
        Eigen::Vector2d mean = Eigen::Vector2d::Zero();
        for (std::size_t k = begin; k < i; ++k) mean += group[k]->p_level;
        mean /= static_cast<double>(count);
        Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
        double variance = 0.0;
        for (std::size_t k = begin; k < i; ++k) {
          const Eigen::Vector2d d = group[k]->p_level - mean;
          spread += d * d.transpose();
          variance += group[k]->sigma * group[k]->sigma / static_cast<double>(count);
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(spread);
        Eigen::Vector2d direction = eigen.eigenvectors().col(1);
        if (direction.dot(along) < 0.0) direction = -direction;
        LineSegment segment;
        segment.begin = mean + direction * direction.dot(group[begin]->p_level - mean);
        segment.end = mean + direction * direction.dot(group[i - 1]->p_level - mean);
        segment.semantic_class = group[begin]->semantic_class;
        // Points of one line err together: their errors do not average out as if they were many.
        segment.sigma_heading = std::sqrt(variance) / (0.3 * length);
        segment.sigma_offset = std::sqrt(variance);
        segments.push_back(segment);
      }
      begin = i;
    }
  }
  return segments;
}

}  // namespace parkade
