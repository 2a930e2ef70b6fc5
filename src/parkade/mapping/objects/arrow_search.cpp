// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/arrow_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;
using Cell = PaintRaster::Cell;

constexpr double kStep = 0.1;            // m, of the search
constexpr double kCellsPerSight = 16.0;  // labels of cells within 0.2 m err together

// The box of a patch in an arrow's frame: where it lies in the map, and half its size.
struct Window {
  SE2 T_map_window;
  Vector2d half = Vector2d::Zero();
};

Window windowAround(const std::vector<Vector2d>& patch, double heading) {
  const SE2 turn(heading, Vector2d::Zero());
  const SE2 back = turn.inverse();
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::max());
  Vector2d high = -low;
  for (const Vector2d& cell : patch) {
    low = low.cwiseMin(back * cell);
    high = high.cwiseMax(back * cell);
  }
  return {turn * SE2(0.0, 0.5 * (low + high)), 0.5 * (high - low)};
}

// Scores of every place in a window, in one go: two correlations, of paint and of bare floor.
FoundArrow bestOf(const Window& window, const PaintRaster& raster, const ArrowTemplate& look) {
  const Vector2d size(look.halfLength(), look.halfWidth());
  const Vector2i half = ((window.half + 2.0 * size) / kStep).array().ceil().cast<int>();
  cv::Mat1f paint = cv::Mat1f::zeros(2 * half.x() + 1, 2 * half.y() + 1);
  cv::Mat1f bare = paint.clone();
  for (int row = 0; row < paint.rows; ++row) {
    for (int column = 0; column < paint.cols; ++column) {
      const Vector2d p = kStep * Vector2d(row - half.x(), column - half.y());
      const PaintRaster::Shares shares = raster.sharesAt(window.T_map_window * p);
      paint(row, column) = static_cast<float>(shares.paint);
      bare(row, column) = static_cast<float>(shares.bare);
    }
  }
  const Vector2i reach = (size / kStep).array().ceil().cast<int>();
  cv::Mat1f if_paint = cv::Mat1f::zeros(2 * reach.x() + 1, 2 * reach.y() + 1);
  cv::Mat1f if_bare = if_paint.clone();
  for (const ArrowTemplate::Place& place : look.places()) {
    const Vector2i at = reach + Vector2i((place.p / kStep).array().round().cast<int>());
    if_paint(at.x(), at.y()) += static_cast<float>(place.paint);
    if_bare(at.x(), at.y()) += static_cast<float>(place.bare);
  }
  cv::Mat1f scores;
  cv::Mat1f of_bare;
  cv::matchTemplate(paint, if_paint, scores, cv::TM_CCORR);
  cv::matchTemplate(bare, if_bare, of_bare, cv::TM_CCORR);
  scores += of_bare;
  cv::Point best;
  cv::minMaxLoc(scores, nullptr, nullptr, nullptr, &best);
  const Vector2i at = Vector2i(best.y, best.x) + reach - half;
  FoundArrow arrow;
  arrow.look = &look;
  arrow.pose = look.align(raster, window.T_map_window * SE2(0.0, kStep * at.cast<double>()));
  arrow.score = look.score(raster, arrow.pose);
  return arrow;
}

// By how much the first is likelier than the others that lie as it does, or than those that do not.
double leadOf(const std::vector<FoundArrow>& arrows, bool as_it_does) {
  constexpr double kTurned = 0.3;  // rad
  constexpr double kMoved = 0.6;   // m
  const FoundArrow& best = arrows.front();
  double lead = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < arrows.size(); ++i) {
    const SE2 T = best.pose.inverse() * arrows[i].pose;
    const bool same = std::abs(T.angle()) < kTurned && T.translation().norm() < kMoved;
    if (same == as_it_does) lead = std::min(lead, best.score - arrows[i].score);
  }
  return lead / kCellsPerSight;
}

bool isLikely(const FoundArrow& arrow, const PaintRaster& raster,
              const std::vector<Vector2d>& patch) {
  constexpr double kLeast = 15.0;  // log-odds
  constexpr double kSeen = 0.4;
  if (arrow.score < kLeast * kCellsPerSight) return false;
  const ArrowFit fit = fitOf(arrow, raster, patch);
  return fit.seen > kSeen && fit.isGood();
}

}  // namespace

ArrowFit fitOf(const FoundArrow& arrow, const PaintRaster& raster,
               const std::vector<Vector2d>& paint) {
  constexpr double kNear = 0.1;  // m
  int places = 0;
  int seen = 0;
  int shown = 0;
  for (const ArrowTemplate::Place& place : arrow.look->places()) {
    if (!arrow.look->isPaint(place.p)) continue;
    const Cell cell = raster.at(arrow.pose * place.p);
    ++places;
    seen += cell != Cell::kUnknown ? 1 : 0;
    shown += cell == Cell::kPaint ? 1 : 0;
  }
  const SE2 T_arrow_map = arrow.pose.inverse();
  const auto is_own = [&](const Vector2d& cell) {
    const Vector2d p = T_arrow_map * cell;
    for (const double x : {0.0, -kNear, kNear}) {
      for (const double y : {0.0, -kNear, kNear}) {
        if (arrow.look->isPaint(p + Vector2d(x, y))) return true;
      }
    }
    return false;
  };
  const auto explained = std::count_if(paint.begin(), paint.end(), is_own);
  const auto share = [](auto part, auto whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
  };
  return {share(seen, places), share(shown, seen), share(explained, paint.size())};
}

std::optional<FoundArrow> findArrow(const std::vector<Vector2d>& patch, const PaintRaster& raster,
                                    const std::map<std::string, ArrowTemplate>& looks,
                                    double axis) {
  constexpr double kLead = 1.0;  // log-odds
  std::vector<FoundArrow> arrows;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Window window = windowAround(patch, axis + quarter * M_PI_2);
    for (const auto& [meaning, look] : looks) {
      arrows.push_back(bestOf(window, raster, look));
      arrows.back().meaning = meaning;
    }
  }
  std::stable_sort(arrows.begin(), arrows.end(),
                   [](const FoundArrow& a, const FoundArrow& b) { return a.score > b.score; });
  if (arrows.empty() || !isLikely(arrows.front(), raster, patch) || leadOf(arrows, false) < kLead) {
    return std::nullopt;
  }
  FoundArrow best = arrows.front();
  if (leadOf(arrows, true) < kLead) best.meaning.clear();
  return best;
}

}  // namespace parkade
