// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace parkade {

/// The five layers of the map (the paper, section 3.4). Values are stored in map files.
enum class GridLayer : std::uint8_t {
  kParkingLines = 0,  ///< layer 1: painted lines of slots and lanes
  kAvailability = 1,  ///< layer 2: slots and their surroundings, free or occupied
  kRoadMarkers = 2,   ///< layer 3: arrows, limits, stop lines, crossings, bumps
  kZoneMarkers = 3,   ///< layer 4: pillars, zone text, signs, walls
  kDynamic = 4,       ///< layer 5: vehicles and pedestrians that move; fades
};

inline constexpr int kNumGridLayers = 5;

inline constexpr std::array<GridLayer, kNumGridLayers> kGridLayers = {
    GridLayer::kParkingLines, GridLayer::kAvailability, GridLayer::kRoadMarkers,
    GridLayer::kZoneMarkers, GridLayer::kDynamic};

/// Stable names, by value; file names of exports.
inline constexpr std::array<std::string_view, kNumGridLayers> kGridLayerNames = {
    "parking_lines", "availability", "road_markers", "zone_markers", "dynamic"};

}  // namespace parkade
