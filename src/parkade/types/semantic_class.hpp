// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace parkade {

/// What a pixel shows. The values are stored in label images and must never change.
enum class SemanticClass : std::uint8_t {
  kUnknown = 0,
  kFloor = 1,
  kSlotLine = 2,
  kLaneLine = 3,  ///< guide and lane lines
  kArrow = 4,
  kSpeedLimitPaint = 5,
  kStopLine = 6,
  kCrossing = 7,
  kSpeedBump = 8,
  kPaintedNumber = 9,  ///< slot numbers and other text on the floor
  kWheelStop = 10,
  kPillar = 11,
  kWall = 12,
  kCeiling = 13,  ///< ceiling, beams, ducts, lamps
  kVehicle = 14,
  kPedestrian = 15,
  kZoneMarker = 16,      ///< painted band and text on a pillar
  kGuideSign = 17,       ///< hanging sign
  kSpeedLimitSign = 18,  ///< upright or hanging sign
};

inline constexpr int kNumSemanticClasses = 19;

/// Stable names in snake_case, by value: "unknown", "floor", "slot_line", ...
inline constexpr std::array<std::string_view, kNumSemanticClasses> kSemanticClassNames = {
    "unknown",           "floor",       "slot_line",  "lane_line",       "arrow",
    "speed_limit_paint", "stop_line",   "crossing",   "speed_bump",      "painted_number",
    "wheel_stop",        "pillar",      "wall",       "ceiling",         "vehicle",
    "pedestrian",        "zone_marker", "guide_sign", "speed_limit_sign"};

/// Painted on the floor (or marked so): it may be worn, or faint.
constexpr bool isPaint(SemanticClass c) {
  return c >= SemanticClass::kSlotLine && c <= SemanticClass::kPaintedNumber;
}

/// Pillar or wall: stands on the ground for good, and nothing is seen through it.
constexpr bool isStructure(SemanticClass c) {
  return c == SemanticClass::kPillar || c == SemanticClass::kWall;
}

}  // namespace parkade
