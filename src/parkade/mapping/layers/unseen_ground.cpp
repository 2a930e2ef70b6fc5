// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/layers/unseen_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "parkade/mapping/layers/way_eyes.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr GridLayer kLayer = GridLayer::kZoneMarkers;
constexpr double kOpaque = 0.1;  // m of structure that hide what lies behind
constexpr double kThick = 0.35;  // m of structure whose near side is seen

// What a ray may meet in a cell.
enum Cell : std::uint8_t { kOther = 0, kStructure = 1, kSeen = 2 };

// A drive that went astray: its map is too large for an array, and worth none.
bool isAstray(const LayeredGrid::Bounds& bounds) {
  return !checkPictureSize((bounds.max - bounds.min).cast<double>() + Vector2d::Ones());
}

/// The structure layer as an array.
class Raster {
 public:
  Raster(const LayeredGrid& grid, const LayeredGrid::Bounds& bounds)
      : resolution_(grid.resolution()),
        min_(bounds.min),
        size_(bounds.max - bounds.min + Vector2i::Ones()),
        cells_(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()), kOther) {
    grid.forEachKnown(kLayer, [&](const Vector2i& index, const GridCell& cell) {
      if (!isStructure(cell.believed())) return;
      std::uint8_t* found = find(index);
      if (found != nullptr) *found = kStructure;
    });
  }

  [[nodiscard]] std::uint8_t* find(const Vector2i& cell) {
    const Vector2i p = cell - min_;
    if (p.x() < 0 || p.y() < 0 || p.x() >= size_.x() || p.y() >= size_.y()) return nullptr;
    return &cells_[static_cast<std::size_t>(p.y()) * static_cast<std::size_t>(size_.x()) +
                   static_cast<std::size_t>(p.x())];
  }

  // Marks what an eye sees, ray by ray.
  void look(const Vector2d& eye, double range) {
    const int rays = static_cast<int>(std::ceil(2.0 * M_PI * range / resolution_));
    const int steps = static_cast<int>(range / resolution_);
    const int opaque = std::max(1, static_cast<int>(std::lround(kOpaque / resolution_)));
    const int thick = std::max(1, static_cast<int>(std::lround(kThick / resolution_)));
    for (int k = 0; k < rays; ++k) {
      const double angle = 2.0 * M_PI * k / rays;
      const Vector2d step(std::cos(angle), std::sin(angle));
      Vector2d p = eye / resolution_;
      int inside = 0;
      bool hidden = false;
      for (int n = 0; n < steps; ++n, p += step) {
        std::uint8_t* cell =
            find({static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y()))});
        if (cell == nullptr) continue;
        const bool structure = (*cell & kStructure) != 0;
        inside = structure ? inside + 1 : 0;
        hidden = hidden || inside >= opaque;
        if (hidden && (!structure || inside > thick)) break;
        *cell |= kSeen;
      }
    }
  }

 private:
  double resolution_;
  Vector2i min_;
  Vector2i size_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace

void forgetUnseenGround(const std::vector<SE2>& way, double range, LayeredGrid& grid) {
  const auto bounds = grid.bounds(kLayer);
  if (!bounds || way.empty() || isAstray(*bounds)) return;
  Raster raster(grid, *bounds);
  forEachEye(way, [&](const Vector2d& eye) { raster.look(eye, range); });
  std::vector<Vector2i> unseen;
  grid.forEachKnown(kLayer, [&](const Vector2i& index, const GridCell& cell) {
    if (cell.believed() == SemanticClass::kPillar) return;
    const bool seen = anyWithinACell(index, [&](const Vector2i& near) {
      const std::uint8_t* found = raster.find(near);
      return found != nullptr && (*found & kSeen) != 0;
    });
    if (!seen) unseen.push_back(index);
  });
  grid.forget(kLayer, unseen);
}

void retreatFromUnseen(LayeredGrid& grid) {
  constexpr double kBorder = 0.25;  // m
  const auto bounds = grid.bounds(kLayer);
  if (!bounds || isAstray(*bounds)) return;
  const int border = static_cast<int>(std::lround(kBorder / grid.resolution()));
  const int beyond = border + 2;
  const Vector2i origin = bounds->min - Vector2i::Constant(beyond);
  const Vector2i size = bounds->max - bounds->min + Vector2i::Constant(2 * beyond + 1);
  cv::Mat unseen(size.y(), size.x(), CV_8UC1, cv::Scalar(1));
  grid.forEachKnown(kLayer, [&](const Vector2i& index, const GridCell&) {
    const Vector2i p = index - origin;
    unseen.at<std::uint8_t>(p.y(), p.x()) = 0;
  });
  const auto square = [](int reach) {
    return cv::Mat(2 * reach + 1, 2 * reach + 1, CV_8UC1, cv::Scalar(1));
  };
  cv::erode(unseen, unseen, square(1));
  cv::dilate(unseen, unseen, square(border + 1));
  std::vector<Vector2i> lost;
  grid.forEachKnown(kLayer, [&](const Vector2i& index, const GridCell& cell) {
    const Vector2i p = index - origin;
    if (!isStructure(cell.believed()) && unseen.at<std::uint8_t>(p.y(), p.x()) != 0)
      lost.push_back(index);
  });
  grid.forget(kLayer, lost);
}

}  // namespace parkade
