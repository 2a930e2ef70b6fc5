// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/mapping/local_map.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

// Maps as pictures for people: CV_8UC3, BGR, x to the right and y up.

/// Fails where a picture of this many pixels across and down is too large, also for a PNG: a
/// damaged file may place cells or slots kilometres apart.
Status checkPictureSize(const Eigen::Vector2d& pixels);

/// Pixels across and down of the pictures of drawMap() and drawLayer().
Eigen::Vector2d mapPictureSize(const ParkingMap& map, double metres_per_px = 0.05);
/// The finest metres per pixel, in hundredths, at which these pictures are not too large.
double finestMetresPerPx(const ParkingMap& map);

/// The map as a picture: layers in colour, free slots green, occupied ones red, unsure ones yellow.
/// Fails where the map is too wide for one picture.
Result<cv::Mat> drawMap(const ParkingMap& map, double metres_per_px = 0.05);

/// One layer alone, with the same edges as drawMap(). A pixel shows the first of its cells that
/// shows something. Layer kAvailability has the map's slots over it. Fails as drawMap() does.
Result<cv::Mat> drawLayer(const ParkingMap& map, GridLayer layer, double metres_per_px = 0.05);

/// Where the upper left edge of these pictures lies, metres.
Eigen::Vector2d mapPictureCorner(const ParkingMap& map);

/// The square around the car, a pixel per cell: one layer, or all of them.
cv::Mat drawLocalMap(const LocalMap& map, std::optional<GridLayer> layer = {});

/// What a colour of a picture stands for.
struct MapColour {
  std::string_view name;
  std::array<std::uint8_t, 3> bgr;
};

/// The colours of one layer's picture.
std::vector<MapColour> layerLegend(GridLayer layer);
/// The colours of pictures with all layers, without those of the slots.
std::vector<MapColour> mapLegend();
/// The colours of slots.
std::vector<MapColour> slotLegend();

}  // namespace parkade
