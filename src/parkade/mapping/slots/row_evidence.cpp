// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_evidence.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/mapping/slots/slot_plausibility.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;
using Corners = std::array<Vector2d, 4>;

class GridProbe {
 public:
  explicit GridProbe(const LayeredGrid& grid) : grid_(grid) {}

  // The class that a layer holds at p; unknown where it holds none or doubts it.
  [[nodiscard]] SemanticClass at(GridLayer layer, const Vector2d& p) const {
    return grid_.at(layer, grid_.cellOf(p)).believed();
  }
  [[nodiscard]] bool isSlotLine(const Vector2d& p) const {
    return at(GridLayer::kParkingLines, p) == SemanticClass::kSlotLine;
  }
  [[nodiscard]] bool isLaneLine(const Vector2d& p) const {
    return at(GridLayer::kParkingLines, p) == SemanticClass::kLaneLine;
  }
  [[nodiscard]] bool isSeen(const Vector2d& p) const {
    return at(GridLayer::kParkingLines, p) != SemanticClass::kUnknown;
  }

  struct Share {
    double painted = 0.0;
    double seen_m = 0.0;
  };
  [[nodiscard]] Share along(const Vector2d& from, const Vector2d& to) const {
    const double step = grid_.resolution();
    const int count = std::max(1, static_cast<int>((to - from).norm() / step));
    int seen = 0;
    int painted = 0;
    for (int i = 0; i < count; ++i) {
      const Vector2d p = from + (i + 0.5) / count * (to - from);
      if (!isSeen(p)) continue;
      ++seen;
      if (isSlotLine(p)) ++painted;
    }
    Share share;
    share.seen_m = seen * step;
    if (seen > 0) share.painted = static_cast<double>(painted) / seen;
    return share;
  }

  // aside: unit, across the line.
  [[nodiscard]] SlotEvidence::Line line(const Vector2d& from, const Vector2d& to,
                                        const Vector2d& aside) const {
    SlotEvidence::Line line;
    double most = -1.0;
    for (const double off : {0.0, -0.05, 0.05, -0.1, 0.1}) {
      const Share share = along(from + off * aside, to + off * aside);
      const double found = share.painted * share.seen_m;
      if (found <= most) continue;
      most = found;
      line.painted = share.painted;
      line.seen_m = share.seen_m;
    }
    double painted = 0.0;
    double seen = 0.0;
    for (const double off : {-0.4, -0.3, 0.3, 0.4}) {
      const Share share = along(from + off * aside, to + off * aside);
      painted += share.painted * share.seen_m;
      seen += share.seen_m;
    }
    if (seen > 0.0) line.beside = painted / seen;
    return line;
  }

 private:
  const LayeredGrid& grid_;
};

void lookInside(const GridProbe& probe, const Corners& c, double step, SlotEvidence& evidence) {
  constexpr double kBorder = 0.3;  // m
  constexpr double kAmid = 0.25;   // of width and depth
  const double width = (c[1] - c[0]).norm();
  const double depth = (c[3] - c[0]).norm();
  double all = 0.0;
  double floor = 0.0;
  double vehicles = 0.0;
  double vehicles_amid = 0.0;
  double seen_amid = 0.0;
  double number_aside = 0.0;
  for (double a = kBorder; a < width - kBorder; a += step) {
    for (double b = kBorder; b < depth - kBorder; b += step) {
      const Vector2d p = c[0] + a / width * (c[1] - c[0]) + b / depth * (c[3] - c[0]);
      all += 1.0;
      const SemanticClass use = probe.at(GridLayer::kAvailability, p);
      const double parked = use == SemanticClass::kVehicle ? 1.0 : 0.0;
      vehicles += parked;
      if (use != SemanticClass::kUnknown) {
        evidence.seen += 1.0;
        const bool is_amid = std::abs(a / width - 0.5) < kAmid && std::abs(b / depth - 0.5) < kAmid;
        seen_amid += is_amid ? 1.0 : 0.0;
        vehicles_amid += is_amid ? parked : 0.0;
      }
      if (isStructure(probe.at(GridLayer::kZoneMarkers, p))) evidence.structure_inside += 1.0;
      if (!probe.isSeen(p)) continue;
      floor += 1.0;
      if (probe.isSlotLine(p)) evidence.lines_inside += 1.0;
      if (probe.isLaneLine(p)) evidence.lanes_inside += 1.0;
      const SemanticClass marking = probe.at(GridLayer::kRoadMarkers, p);
      if (isForDrivers(marking)) evidence.markers_inside += 1.0;
      if (marking == SemanticClass::kWheelStop) evidence.stop_m2 += step * step;
      if (marking != SemanticClass::kPaintedNumber) continue;
      evidence.number_m2 += step * step;
      number_aside += (a / width - 0.5) * step * step;
    }
  }
  if (evidence.number_m2 > 0.0) {
    evidence.number_aside = std::abs(number_aside) / evidence.number_m2;
  }
  if (evidence.seen > 0.0) evidence.vehicle = vehicles / evidence.seen;
  evidence.vehicle_amid = seen_amid > 0.0 ? vehicles_amid / seen_amid : evidence.vehicle;
  if (all > 0.0) {
    evidence.seen /= all;
    evidence.structure_inside /= all;
  }
  if (floor > 0.0) {
    evidence.lines_inside /= floor;
    evidence.lanes_inside /= floor;
    evidence.markers_inside /= floor;
  }
}

// Share of its first metre that is painted, of the line that goes in between the sides and shows
// best; 0 where there is paint beside it as well, as where an area is hatched.
double dividerOf(const GridProbe& probe, const Corners& c) {
  constexpr double kFromSide = 0.4;  // m
  constexpr double kFromEntrance = 0.15;
  constexpr double kLength = 1.0;
  constexpr double kMostBeside = 0.1;
  const double width = (c[1] - c[0]).norm();
  const Vector2d u = (c[1] - c[0]) / width;
  const Vector2d inward = (c[3] - c[0]).normalized();
  const auto look = [&](double s) {
    const Vector2d from = c[0] + s * u + kFromEntrance * inward;
    const GridProbe::Share share = probe.along(from, from + kLength * inward);
    return share.painted * share.seen_m / kLength;
  };
  double most = 0.0;
  for (double s = kFromSide; s <= width - kFromSide; s += 0.05) {
    const double painted = look(s);
    if (painted > most && look(s - 0.3) < kMostBeside && look(s + 0.3) < kMostBeside) {
      most = painted;
    }
  }
  return most;
}

}  // namespace

SlotEvidence gatherEvidence(const LayeredGrid& grid, const Corners& c) {
  const GridProbe probe(grid);
  SlotEvidence evidence;
  const Vector2d u = (c[1] - c[0]).normalized();
  const Vector2d inward = (c[3] - c[0]).normalized();
  const Vector2d n(-inward.y(), inward.x());
  constexpr double kFromCorner = 0.15;  // m
  constexpr double kDeepest = 4.0;      // farther in, cars and the picture's edge hide most
  const double deep = std::min(kDeepest, (c[3] - c[0]).norm());
  evidence.left = probe.line(c[0] + kFromCorner * inward, c[0] + deep * inward, n);
  evidence.right = probe.line(c[1] + kFromCorner * inward, c[1] + deep * inward, n);
  evidence.entrance =
      probe.line(c[0] + kFromCorner * u, c[1] - kFromCorner * u, Vector2d(-u.y(), u.x()));
  evidence.rear =
      probe.line(c[3] + kFromCorner * u, c[2] - kFromCorner * u, Vector2d(-u.y(), u.x()));
  evidence.divider = dividerOf(probe, c);
  int lanes = 0;
  int samples = 0;
  for (double s = kFromCorner; s < (c[1] - c[0]).norm() - kFromCorner; s += grid.resolution()) {
    ++samples;
    for (const double off : {-0.1, 0.0, 0.1, 0.2, 0.3}) {
      if (!probe.isLaneLine(c[0] + s * u - off * inward)) continue;
      ++lanes;
      break;
    }
  }
  if (samples > 0) evidence.lane_ahead = static_cast<double>(lanes) / samples;
  lookInside(probe, c, grid.resolution(), evidence);
  return evidence;
}

SlotEvidence::Line lookAlong(const LayeredGrid& grid, const Vector2d& from, const Vector2d& to) {
  const Vector2d u = (to - from).normalized();
  return GridProbe(grid).line(from, to, Vector2d(-u.y(), u.x()));
}

}  // namespace parkade::slot_rows
