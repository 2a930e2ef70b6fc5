// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/core/result.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

// A map in the formats of others, all in the map's local metric frame. Files are written beside
// their final name and renamed, so that a full disk leaves the old ones.

/// Cells across and down of the pictures of exportNav2().
Eigen::Vector2d nav2PictureSize(const ParkingMap& map);

/// One layer as Nav2's map_server reads it: FOLDER/LAYER.pgm (trinary: 0 present, 254 seen and
/// absent, 205 unknown) and LAYER.yaml. All layers of a map share one frame and size. An empty map
/// gives one unknown cell. Fails where the map is too wide for one picture.
Status exportNav2(const ParkingMap& map, GridLayer layer, const std::string& folder);

/// Slots and objects as a GeoJSON FeatureCollection. Coordinates are metres of the local frame,
/// which the member "coordinate_reference" says, as RFC 7946 knows only longitude and latitude.
Status exportGeoJson(const ParkingMap& map, const std::string& path);

/// Slots as Lanelet2 OSM in Autoware's extension: a two-point linestring parking_space with its
/// width per slot, from the aisle to the rear, and one polygon parking_lot around them all.
/// Positions stand in local_x and local_y; lat and lon are nominal.
Status exportLanelet2(const ParkingMap& map, const std::string& path);

}  // namespace parkade
