// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/line_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace parkade {
namespace {

using Eigen::Vector2d;

double greyAt(const cv::Mat& grey, const Vector2d& p) {
  const int u = std::clamp(static_cast<int>(std::floor(p.x())), 0, grey.cols - 2);
  const int v = std::clamp(static_cast<int>(std::floor(p.y())), 0, grey.rows - 2);
  const double a = std::clamp(p.x() - u, 0.0, 1.0);
  const double b = std::clamp(p.y() - v, 0.0, 1.0);
  const auto at = [&](int y, int x) { return static_cast<double>(grey.at<std::uint8_t>(y, x)); };
  return (1.0 - b) * ((1.0 - a) * at(v, u) + a * at(v, u + 1)) +
         b * ((1.0 - a) * at(v + 1, u) + a * at(v + 1, u + 1));
}

}  // namespace

std::optional<LineEndFinder::End> LineEndFinder::from(const Vector2d& start,
                                                      const Vector2d& outward, double width) const {
  const BevGeometry& g = probe_.labels().geometry;
  const double step = 0.5 * g.metres_per_px;
  constexpr double kReach = 1.2;   // m
  constexpr double kClear = 0.2;   // m of floor that ends a line
  constexpr double kNarrow = 0.5;  // m of a leg or a pole, with floor behind
  double last = 0.0;
  double hidden = 0.0;  // m since then
  double s = 0.0;
  for (; s < kReach && s - last - hidden < kClear; s += step) {
    const Vector2d p = start + s * outward;
    if (probe_.isPaint(p) || isFaintPaint(p)) {
      last = s;
      hidden = 0.0;
    } else if (probe_.isHidden(p)) {
      hidden += step;
      if (hidden > kNarrow) return std::nullopt;
    }
  }
  if (s >= kReach) return std::nullopt;
  const Vector2d at = start + (last + step) * outward;
  if (hidden > 0.0) return End{at, 0.8 + 0.5 * hidden / g.metres_per_px};
  if (const auto shift = edge(at, outward, width)) return End{at + *shift * outward, 0.4};
  return End{at, 0.8};
}

// Worn ends of lines: floor by its label, and a slot's line nearly as likely.
bool LineEndFinder::isFaintPaint(const Vector2d& p) const {
  constexpr double kFaint = -1.5;  // log-odds
  if (probe_.at(p) != SemanticClass::kFloor) return false;
  return probe_.slotEvidence(p) > kFaint;
}

// m along outward from where labels end to where the picture's edge is.
std::optional<double> LineEndFinder::edge(const Vector2d& at, const Vector2d& outward,
                                          double width) const {
  constexpr int kHalf = 12;  // samples each way, half a pixel apart
  const BevGeometry& g = probe_.labels().geometry;
  const double step = 0.5 * g.metres_per_px;
  const Vector2d aside(-outward.y(), outward.x());
  std::array<double, 2 * kHalf + 1> values{};
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (const double k : {-0.25, 0.0, 0.25}) {
      values[static_cast<std::size_t>(i + kHalf)] +=
          greyAt(grey_, g.toPixel(at + i * step * outward + k * width * aside)) / 3.0;
    }
  }
  const auto mean = [&](int from, int to) {
    double sum = 0.0;
    for (int i = from; i <= to; ++i) sum += values[static_cast<std::size_t>(i + kHalf)];
    return sum / (to - from + 1);
  };
  // Close to the end: paint that meets the line may be all there is of it.
  const double paint = mean(-5, -3);
  const double floor = mean(5, 10);
  constexpr double kContrast = 8.0;
  if (std::abs(paint - floor) < kContrast) return std::nullopt;
  const double sign = paint > floor ? 1.0 : -1.0;
  const double level = 0.5 * (paint + floor);
  for (int i = -4; i < 5; ++i) {
    const double here = sign * (values[static_cast<std::size_t>(i + kHalf)] - level);
    const double next = sign * (values[static_cast<std::size_t>(i + 1 + kHalf)] - level);
    if (here >= 0.0 && next < 0.0) return (i + here / (here - next)) * step;
  }
  return std::nullopt;
}

}  // namespace parkade
