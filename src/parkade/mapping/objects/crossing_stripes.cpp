// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/crossing_stripes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Span = CrossingStripes::Span;

constexpr double kBin = 0.05;  // m

struct Count {
  int cells = 0;
  int known = 0;
  int paint = 0;
  int blocked = 0;  ///< unknown, by what stands there
  [[nodiscard]] double share() const {
    return known == 0 ? 0.0 : static_cast<double>(paint) / known;
  }
};

// From the lowest to the highest value, but for a share at either end.
Span spanOf(std::vector<double> values, double cut) {
  const auto at = [&](double share) {
    const auto n = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + n, values.end());
    return values[static_cast<std::size_t>(n)];
  };
  return {at(cut), at(1.0 - cut)};
}

class StripeFitter {
 public:
  StripeFitter(const std::vector<Vector2d>& patch, const PaintRaster& raster,
               const LayeredGrid& grid)
      : patch_(patch), raster_(raster), grid_(grid) {
    for (const Vector2d& p : patch) middle_ += p / static_cast<double>(patch.size());
  }

  [[nodiscard]] std::optional<CrossingStripes> fit(double axis) const {
    constexpr double kLeastContrast = 0.5;
    constexpr int kFewest = 3;
    CrossingStripes best;
    for (const int quarter : {0, 1}) {
      for (const double turn : {-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0}) {
        const double heading = axis + quarter * M_PI_2 + turn * M_PI / 180.0;
        const CrossingStripes stripes = fitAcross(SE2(heading, middle_));
        if (stripes.contrast > best.contrast) best = stripes;
      }
    }
    if (best.contrast < kLeastContrast) return std::nullopt;
    findEnds(best);
    if (best.count() < kFewest || best.along.high <= best.along.low) {
      return std::nullopt;
    }
    best.has_ends = hasEnds(best);
    return best;
  }

 private:
  [[nodiscard]] bool hasEnds(const CrossingStripes& s) const {
    constexpr double kSeen = 0.5;
    constexpr double kBare = 0.15;
    for (const int index : {s.from - 1, s.to + 1}) {
      const double y = s.begin(index);
      const Count count = countIn(s.T_map_crossing, s.along, {y, y + s.width});
      if (count.known + count.blocked < kSeen * count.cells || count.share() > kBare) return false;
    }
    return true;
  }

  [[nodiscard]] Count countIn(const SE2& T, const Span& x, const Span& y) const {
    Count count;
    for (double b = y.low + 0.5 * kBin; b < y.high; b += kBin) {
      for (double a = x.low + 0.5 * kBin; a < x.high; a += kBin) {
        const Vector2d p = T * Vector2d(a, b);
        const PaintRaster::Cell cell = raster_.at(p);
        ++count.cells;
        count.known += cell != PaintRaster::Cell::kUnknown ? 1 : 0;
        count.paint += cell == PaintRaster::Cell::kPaint ? 1 : 0;
        count.blocked += cell == PaintRaster::Cell::kUnknown && isBlocked(p) ? 1 : 0;
      }
    }
    return count;
  }

  [[nodiscard]] bool isBlocked(const Vector2d& p) const {
    const Vector2i cell = grid_.cellOf(p);
    return isStructure(grid_.at(GridLayer::kZoneMarkers, cell).believed()) ||
           grid_.at(GridLayer::kAvailability, cell).believed() == SemanticClass::kVehicle;
  }

  // Period, width and phase by the profile across the stripes.
  [[nodiscard]] CrossingStripes fitAcross(const SE2& T) const {
    constexpr double kCut = 0.05;
    constexpr double kMostPeriod = 1.6;  // m
    const SE2 T_crossing_map = T.inverse();
    std::vector<double> xs;
    std::vector<double> ys;
    for (const Vector2d& cell : patch_) {
      const Vector2d p = T_crossing_map * cell;
      xs.push_back(p.x());
      ys.push_back(p.y());
    }
    CrossingStripes best;
    best.T_map_crossing = T;
    best.along = spanOf(std::move(xs), kCut);
    const Span across = spanOf(std::move(ys), 0.5 * kCut);
    std::vector<double> shares;
    for (double y = across.low; y < across.high; y += kBin) {
      shares.push_back(countIn(T, best.along, {y, y + kBin}).share());
    }
    for (double period = 0.6; period <= kMostPeriod; period += 0.5 * kBin) {
      if (2.0 * period > across.high - across.low) break;
      for (double phase = 0.0; phase < period; phase += kBin) {
        for (const double duty : {0.4, 0.5, 0.6}) {
          const double contrast = contrastOf(shares, period, phase, duty);
          if (contrast <= best.contrast) continue;
          best.contrast = contrast;
          best.period = period;
          best.width = duty * period;
          best.first = across.low + phase;
        }
      }
    }
    return best;
  }

  // Mean of the shares on stripes, less that of those between.
  static double contrastOf(const std::vector<double>& shares, double period, double phase,
                           double duty) {
    double on = 0.0;
    double off = 0.0;
    int n_on = 0;
    int n_off = 0;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const double y = (static_cast<double>(i) + 0.5) * kBin - phase;
      const double within = y / period - std::floor(y / period);
      (within < duty ? on : off) += shares[i];
      ++(within < duty ? n_on : n_off);
    }
    if (n_on == 0 || n_off == 0) return 0.0;
    return on / n_on - off / n_off;
  }

  // The outermost stripes that show, and where they end.
  void findEnds(CrossingStripes& s) const {
    constexpr double kShows = 0.25;
    constexpr int kMost = 20;
    const SE2 T_crossing_map = s.T_map_crossing.inverse();
    double highest = 0.0;
    for (const Vector2d& cell : patch_) {
      highest = std::max(highest, (T_crossing_map * cell).y());
    }
    bool any = false;
    for (int index = -1; index < kMost && s.begin(index) < highest; ++index) {
      const double y = s.begin(index);
      if (countIn(s.T_map_crossing, s.along, {y, y + s.width}).share() < kShows) continue;
      if (!any) s.from = index;
      any = true;
      s.to = index;
    }
    if (any) s.along = lengthOf(s);
  }

  [[nodiscard]] Span lengthOf(const CrossingStripes& s) const {
    constexpr double kReach = 1.0;  // m, beyond the span so far
    constexpr double kHalf = 0.5;   // of what shows in the middle
    const auto share_at = [&](double x) {
      Count count;
      for (int index = s.from; index <= s.to; ++index) {
        const double y = s.begin(index);
        const Count one = countIn(s.T_map_crossing, {x, x + kBin}, {y, y + s.width});
        count.known += one.known;
        count.paint += one.paint;
      }
      return count.share();
    };
    const double middle = 0.5 * (s.along.low + s.along.high);
    const double usual =
        countIn(s.T_map_crossing, s.along, s.across()).share() * s.period / s.width;
    Span length{middle, middle};
    for (double x = middle; x < s.along.high + kReach; x += kBin) {
      if (share_at(x) > kHalf * usual) length.high = x + kBin;
    }
    for (double x = middle; x > s.along.low - kReach; x -= kBin) {
      if (share_at(x) > kHalf * usual) length.low = x;
    }
    return length;
  }

  const std::vector<Vector2d>& patch_;
  const PaintRaster& raster_;
  const LayeredGrid& grid_;
  Vector2d middle_ = Vector2d::Zero();
};

}  // namespace

bool CrossingStripes::holds(const Vector2d& p) const {
  const int index = static_cast<int>(std::floor((p.y() - first) / period));
  const double y = p.y() - begin(index);
  return p.x() > along.low + kBin && p.x() < along.high - kBin && index >= from && index <= to &&
         y > kBin && y < width - kBin;
}

std::vector<Vector2d> CrossingStripes::outline() const {
  const Span y = across();
  std::vector<Vector2d> corners;
  for (const Vector2d& p : {Vector2d(along.low, y.low), Vector2d(along.high, y.low),
                            Vector2d(along.high, y.high), Vector2d(along.low, y.high)}) {
    corners.push_back(T_map_crossing * p);
  }
  return corners;
}

std::optional<CrossingStripes> fitStripes(const std::vector<Vector2d>& patch,
                                          const PaintRaster& raster, const LayeredGrid& grid,
                                          double axis) {
  return StripeFitter(patch, raster, grid).fit(axis);
}

}  // namespace parkade
