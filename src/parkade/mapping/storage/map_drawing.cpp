// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/storage/map_drawing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace parkade {
namespace {

using Bgr = std::array<std::uint8_t, 3>;

constexpr Bgr kNothing = {38, 36, 34};
constexpr Bgr kFree = {80, 170, 60};
constexpr Bgr kOccupied = {70, 70, 190};
constexpr Bgr kOpen = {60, 190, 210};

constexpr double kMostPixels = 3e8;
constexpr double kLongestSide = 1e6;  // pixels: libpng writes no longer one

Bgr colourOf(SemanticClass semantic_class) {
  switch (semantic_class) {
    case SemanticClass::kFloor:
      return {70, 66, 62};
    case SemanticClass::kSlotLine:
    case SemanticClass::kPaintedNumber:
      return {240, 240, 240};
    case SemanticClass::kLaneLine:
    case SemanticClass::kStopLine:
      return {90, 220, 250};
    case SemanticClass::kArrow:
      return {250, 180, 80};
    case SemanticClass::kSpeedLimitPaint:
    case SemanticClass::kSpeedLimitSign:
      return {90, 90, 250};
    case SemanticClass::kCrossing:
      return {200, 210, 120};
    case SemanticClass::kSpeedBump:
      return {40, 190, 230};
    case SemanticClass::kWheelStop:
      return {150, 110, 190};
    case SemanticClass::kPillar:
    case SemanticClass::kWall:
      return {150, 140, 130};
    case SemanticClass::kZoneMarker:
      return {120, 200, 60};
    case SemanticClass::kGuideSign:
      return {70, 140, 10};
    case SemanticClass::kVehicle:
      return {80, 80, 200};
    case SemanticClass::kPedestrian:
      return {200, 60, 230};
    case SemanticClass::kCeiling:
    case SemanticClass::kUnknown:
      break;
  }
  return kNothing;
}

cv::Vec3b pixelOf(const Bgr& bgr) {
  return {bgr[0], bgr[1], bgr[2]};
}

Bgr slotColour(const MapSlot& slot) {
  if (slot.isFree()) return kFree;
  return slot.isOccupied() ? kOccupied : kOpen;
}

struct Picture {
  cv::Mat image;
  Eigen::Vector2d top_left;  // world, outer corner
  double metres_per_px;

  [[nodiscard]] Eigen::Vector2d world(int u, int v) const {
    return {top_left.x() + (u + 0.5) * metres_per_px, top_left.y() - (v + 0.5) * metres_per_px};
  }
};

bool inside(const MapSlot& slot, const Eigen::Vector2d& p) {
  bool all_left = true;
  bool all_right = true;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d edge = slot.corners[(i + 1) % 4] - slot.corners[i];
    const Eigen::Vector2d to = p - slot.corners[i];
    const double side = edge.x() * to.y() - edge.y() * to.x();
    all_left = all_left && side >= 0.0;
    all_right = all_right && side <= 0.0;
  }
  return all_left || all_right;
}

void drawSlot(Picture& picture, const MapSlot& slot) {
  const cv::Vec3b fill = pixelOf(slotColour(slot));
  Eigen::Vector2d low = slot.corners[0];
  Eigen::Vector2d high = slot.corners[0];
  for (const Eigen::Vector2d& corner : slot.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const double scale = 1.0 / picture.metres_per_px;
  const int u0 = std::max(0, static_cast<int>((low.x() - picture.top_left.x()) * scale));
  const int u1 =
      std::min(picture.image.cols - 1, static_cast<int>((high.x() - picture.top_left.x()) * scale));
  const int v0 = std::max(0, static_cast<int>((picture.top_left.y() - high.y()) * scale));
  const int v1 =
      std::min(picture.image.rows - 1, static_cast<int>((picture.top_left.y() - low.y()) * scale));
  for (int v = v0; v <= v1; ++v) {
    for (int u = u0; u <= u1; ++u) {
      if (!inside(slot, picture.world(u, v))) continue;
      auto& pixel = picture.image.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<uchar>(0.45 * pixel[c] + 0.55 * fill[c]);
    }
  }
}

// Signs hang over the ground and so have no cells: a square where each is.
void drawSign(Picture& picture, const MapObject& object) {
  if (object.semantic_class != SemanticClass::kGuideSign &&
      object.semantic_class != SemanticClass::kSpeedLimitSign) {
    return;
  }
  constexpr double kHalf = 0.25;  // m
  const double scale = 1.0 / picture.metres_per_px;
  const int half = std::max(1, static_cast<int>(std::lround(kHalf * scale)));
  const Eigen::Vector2d at((object.position.x() - picture.top_left.x()) * scale,
                           (picture.top_left.y() - object.position.y()) * scale);
  if (!(at.minCoeff() > -half - 1.0 && at.x() < picture.image.cols + half &&
        at.y() < picture.image.rows + half)) {
    return;  // objects need not lie inside
  }
  const int u = static_cast<int>(std::floor(at.x()));
  const int v = static_cast<int>(std::floor(at.y()));
  const cv::Rect place = cv::Rect(u - half, v - half, 2 * half + 1, 2 * half + 1) &
                         cv::Rect(0, 0, picture.image.cols, picture.image.rows);
  if (!place.empty()) picture.image(place).setTo(pixelOf(colourOf(object.semantic_class)));
}

// What the pictures of a map show, from the lower left to the upper right edge, metres.
struct PictureArea {
  Eigen::Vector2d low;
  Eigen::Vector2d high;
};

PictureArea pictureArea(const ParkingMap& map) {
  constexpr double kFar = std::numeric_limits<double>::max();
  Eigen::Vector2d low = Eigen::Vector2d::Constant(kFar);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-kFar);
  if (const std::optional<LayeredGrid::Bounds> bounds = map.grid.bounds()) {
    low = map.grid.resolution() * bounds->min.cast<double>();
    high = map.grid.resolution() * (bounds->max + Eigen::Vector2i::Ones()).cast<double>();
  }
  for (const MapSlot& slot : map.slots) {
    for (const Eigen::Vector2d& corner : slot.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  if (low.x() > high.x()) low = high = Eigen::Vector2d::Zero();  // an empty map
  return {low, high};
}

Result<Picture> emptyPicture(const ParkingMap& map, double metres_per_px) {
  const Eigen::Vector2d size = mapPictureSize(map, metres_per_px);
  if (const Status fits = checkPictureSize(size); !fits) return fits.error();
  return Picture{cv::Mat(static_cast<int>(size.y()), static_cast<int>(size.x()), CV_8UC3,
                         cv::Scalar(kNothing[0], kNothing[1], kNothing[2])),
                 mapPictureCorner(map), metres_per_px};
}

// A cell of one layer over what the pixel shows already: later layers lie on top; seen-and-absent
// never hides what another layer shows.
void paintCell(const GridCell& cell, cv::Vec3b& pixel) {
  if (!cell.known() || cell.log_odds <= 0) return;
  if (cell.semantic_class == SemanticClass::kFloor && pixel != pixelOf(kNothing)) return;
  pixel = pixelOf(colourOf(cell.semantic_class));
}

// The cells of one layer under a pixel: what shows something beats floor, floor beats nothing.
GridCell cellUnder(const LayeredGrid& grid, GridLayer layer, const Eigen::Vector2d& middle,
                   int across) {
  GridCell shown;
  const double first = -0.5 * (across - 1) * grid.resolution();
  const Eigen::Vector2i low = grid.cellOf(middle + Eigen::Vector2d::Constant(first));
  for (int k = 0; k < across * across; ++k) {
    const GridCell cell = grid.at(layer, low + Eigen::Vector2i(k % across, k / across));
    if (!cell.known() || cell.log_odds <= 0) continue;
    if (cell.semantic_class != SemanticClass::kFloor) return cell;
    shown = cell;
  }
  return shown;
}

}  // namespace

Status checkPictureSize(const Eigen::Vector2d& pixels) {
  if (pixels.minCoeff() >= 1.0 && pixels.maxCoeff() <= kLongestSide &&
      pixels.x() * pixels.y() <= kMostPixels) {
    return {};
  }
  return Error{
      fmt::format("the map's picture would have {:.0f} x {:.0f} pixels, more than {:.0f} or than "
                  "{:.0f} along a side",
                  pixels.x(), pixels.y(), kMostPixels, kLongestSide)};
}

Eigen::Vector2d mapPictureSize(const ParkingMap& map, double metres_per_px) {
  const auto [low, high] = pictureArea(map);
  return ((high - low) / metres_per_px).array().ceil().max(1.0).matrix();
}

double finestMetresPerPx(const ParkingMap& map) {
  const auto [low, high] = pictureArea(map);
  const Eigen::Vector2d size = high - low;
  const double finest =
      std::max(std::sqrt(size.x() * size.y() / kMostPixels), size.maxCoeff() / kLongestSide);
  constexpr double kMargin = 1.01;  // sizes are rounded up to whole pixels
  return std::max(0.01, std::ceil(100.0 * kMargin * finest) / 100.0);
}

Result<cv::Mat> drawMap(const ParkingMap& map, double metres_per_px) {
  Result<Picture> picture = emptyPicture(map, metres_per_px);
  if (!picture) return picture.error();
  for (int v = 0; v < picture->image.rows; ++v) {
    for (int u = 0; u < picture->image.cols; ++u) {
      const Eigen::Vector2i cell = map.grid.cellOf(picture->world(u, v));
      for (const GridLayer layer : kGridLayers) {
        paintCell(map.grid.at(layer, cell), picture->image.at<cv::Vec3b>(v, u));
      }
    }
  }
  for (const MapSlot& slot : map.slots) drawSlot(*picture, slot);
  for (const MapObject& object : map.objects) drawSign(*picture, object);
  return picture->image;
}

Result<cv::Mat> drawLayer(const ParkingMap& map, GridLayer layer, double metres_per_px) {
  Result<Picture> picture = emptyPicture(map, metres_per_px);
  if (!picture) return picture.error();
  const int across =
      std::max(1, static_cast<int>(std::lround(metres_per_px / map.grid.resolution())));
  for (int v = 0; v < picture->image.rows; ++v) {
    for (int u = 0; u < picture->image.cols; ++u) {
      paintCell(cellUnder(map.grid, layer, picture->world(u, v), across),
                picture->image.at<cv::Vec3b>(v, u));
    }
  }
  if (layer == GridLayer::kAvailability) {
    for (const MapSlot& slot : map.slots) drawSlot(*picture, slot);
  }
  return picture->image;
}

Eigen::Vector2d mapPictureCorner(const ParkingMap& map) {
  const PictureArea area = pictureArea(map);
  return {area.low.x(), area.high.y()};
}

cv::Mat drawLocalMap(const LocalMap& map, std::optional<GridLayer> only) {
  cv::Mat image(map.cells(), map.cells(), CV_8UC3,
                cv::Scalar(kNothing[0], kNothing[1], kNothing[2]));
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const Eigen::Vector2i cell = map.lowest() + Eigen::Vector2i(u, image.rows - 1 - v);
      for (const GridLayer layer : kGridLayers) {
        if (only && layer != *only) continue;
        paintCell(map.at(layer, cell), image.at<cv::Vec3b>(v, u));
      }
    }
  }
  return image;
}

std::vector<MapColour> layerLegend(GridLayer layer) {
  using S = SemanticClass;
  std::vector<MapColour> legend{{"never seen", kNothing},
                                {"seen, nothing there", colourOf(S::kFloor)}};
  const auto add = [&legend](std::string_view name, S c) { legend.push_back({name, colourOf(c)}); };
  switch (layer) {
    case GridLayer::kParkingLines:
      add("slot line", S::kSlotLine);
      add("lane line", S::kLaneLine);
      break;
    case GridLayer::kAvailability:
      add("standing vehicle", S::kVehicle);
      for (const MapColour& colour : slotLegend()) legend.push_back(colour);
      break;
    case GridLayer::kRoadMarkers:
      add("arrow", S::kArrow);
      add("speed limit", S::kSpeedLimitPaint);
      add("stop line", S::kStopLine);
      add("crossing", S::kCrossing);
      add("speed bump", S::kSpeedBump);
      add("painted number", S::kPaintedNumber);
      add("wheel stop", S::kWheelStop);
      break;
    case GridLayer::kZoneMarkers:
      add("pillar or wall", S::kPillar);
      add("zone marker", S::kZoneMarker);
      break;
    case GridLayer::kDynamic:
      add("moving vehicle", S::kVehicle);
      add("person", S::kPedestrian);
      break;
  }
  return legend;
}

std::vector<MapColour> mapLegend() {
  std::vector<MapColour> legend;
  for (const GridLayer layer : kGridLayers) {
    if (layer == GridLayer::kDynamic) continue;  // its vehicles look like those that stand
    for (const MapColour& colour : layerLegend(layer)) {
      const bool slot = colour.bgr == kFree || colour.bgr == kOccupied || colour.bgr == kOpen;
      const bool known = std::any_of(legend.begin(), legend.end(), [&](const MapColour& other) {
        return other.name == colour.name;
      });
      if (!slot && !known) legend.push_back(colour);
    }
  }
  legend.push_back({"guide sign", colourOf(SemanticClass::kGuideSign)});
  legend.push_back({"person", colourOf(SemanticClass::kPedestrian)});
  return legend;
}

std::vector<MapColour> slotLegend() {
  return {{"free slot", kFree}, {"occupied slot", kOccupied}, {"slot not known", kOpen}};
}

}  // namespace parkade
