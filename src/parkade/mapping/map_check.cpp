// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/map_check.hpp"

#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "parkade/geometry/planar.hpp"

namespace parkade {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

constexpr double kMaxCoordinate = 1e5;  // m; no garage is that large

Polygon counterClockwise(Polygon polygon) {
  if (signedArea(polygon) < 0.0) std::reverse(polygon.begin(), polygon.end());
  return polygon;
}

// The part of a polygon left of the line from a to b (Sutherland and Hodgman).
Polygon clip(const Polygon& polygon, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double side_p = cross(b - a, p - a);
    const double side_q = cross(b - a, q - a);
    if (side_p >= 0.0) kept.push_back(p);
    if ((side_p >= 0.0) != (side_q >= 0.0)) {
      kept.push_back(p + (q - p) * (side_p / (side_p - side_q)));
    }
  }
  return kept;
}

bool near(const MapSlot& slot) {
  return std::all_of(slot.corners.begin(), slot.corners.end(), [](const Eigen::Vector2d& p) {
    return p.allFinite() && p.cwiseAbs().maxCoeff() < kMaxCoordinate;
  });
}

void checkSlots(const ParkingMap& map, std::vector<std::string>& faults) {
  std::set<std::int64_t> ids;
  std::vector<const MapSlot*> sound;
  for (const MapSlot& slot : map.slots) {
    if (!ids.insert(slot.id).second) faults.push_back(fmt::format("slot {}: id repeats", slot.id));
    if (!near(slot)) {
      faults.push_back(fmt::format("slot {}: lies farther than {} m", slot.id, kMaxCoordinate));
      continue;
    }
    const double area = std::abs(signedArea({slot.corners.begin(), slot.corners.end()}));
    constexpr double kLeast = 1.0;
    if (area < kLeast) {
      faults.push_back(fmt::format("slot {}: area of {:.2f} m^2", slot.id, area));
      continue;
    }
    if (slot.corner_sigma < 0.0) {
      faults.push_back(fmt::format("slot {}: corner_sigma of {} m", slot.id, slot.corner_sigma));
    }
    sound.push_back(&slot);
  }
  // Sorted by x: only neighbours are compared.
  const auto left = [](const MapSlot* s) {
    return std::min({s->corners[0].x(), s->corners[1].x(), s->corners[2].x(), s->corners[3].x()});
  };
  const auto right = [](const MapSlot* s) {
    return std::max({s->corners[0].x(), s->corners[1].x(), s->corners[2].x(), s->corners[3].x()});
  };
  std::stable_sort(sound.begin(), sound.end(),
                   [&](const MapSlot* a, const MapSlot* b) { return left(a) < left(b); });
  for (std::size_t i = 0; i < sound.size(); ++i) {
    for (std::size_t j = i + 1; j < sound.size() && left(sound[j]) < right(sound[i]); ++j) {
      const double share = overlapShare(sound[i]->corners, sound[j]->corners);
      constexpr double kMost = 0.3;
      if (share > kMost) {
        faults.push_back(fmt::format("slots {} and {}: {:.0f} % of the smaller one is in both",
                                     std::min(sound[i]->id, sound[j]->id),
                                     std::max(sound[i]->id, sound[j]->id), 100.0 * share));
      }
    }
  }
}

void checkGraph(const ParkingMap& map, std::vector<std::string>& faults) {
  for (std::size_t i = 1; i < map.nodes.size(); ++i) {
    if (map.nodes[i].t_ns < map.nodes[i - 1].t_ns) {
      faults.push_back(fmt::format("node {}: is older than the one before", map.nodes[i].id));
    }
  }
  for (const PoseGraphEdge& edge : map.edges) {
    const double largest = edge.information.cwiseAbs().maxCoeff();
    const double skew = (edge.information - edge.information.transpose()).cwiseAbs().maxCoeff();
    bool sound = std::isfinite(largest) && skew <= 1e-9 * largest;
    if (sound) {
      const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(edge.information,
                                                           Eigen::EigenvaluesOnly);
      sound = solver.eigenvalues().minCoeff() >= -1e-9 * largest;
    }
    if (!sound) {
      faults.push_back(fmt::format(
          "edge {} to {}: its information is no symmetric, positive matrix", edge.from, edge.to));
    }
  }
}

}  // namespace

double signedArea(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
  }
  return 0.5 * twice;
}

double overlapShare(const Polygon& a, const Polygon& b) {
  if (a.size() < 3 || b.size() < 3) return 0.0;
  const Polygon other = counterClockwise(b);
  Polygon common = counterClockwise(a);
  const double smaller = std::min(signedArea(common), signedArea(other));
  for (std::size_t i = 0; i < other.size() && !common.empty(); ++i) {
    common = clip(common, other[i], other[(i + 1) % other.size()]);
  }
  return smaller > 0.0 ? std::clamp(signedArea(common) / smaller, 0.0, 1.0) : 0.0;
}

double overlapShare(const std::array<Eigen::Vector2d, 4>& a,
                    const std::array<Eigen::Vector2d, 4>& b) {
  return overlapShare(Polygon(a.begin(), a.end()), Polygon(b.begin(), b.end()));
}

std::vector<std::string> findFaults(const ParkingMap& map) {
  std::vector<std::string> faults;
  checkSlots(map, faults);
  std::set<std::int64_t> ids;
  for (const MapObject& object : map.objects) {
    if (!ids.insert(object.id).second) {
      faults.push_back(fmt::format("object {}: id repeats", object.id));
    }
    if (!object.position.allFinite() || object.position.cwiseAbs().maxCoeff() >= kMaxCoordinate) {
      faults.push_back(fmt::format("object {}: lies farther than {} m", object.id, kMaxCoordinate));
    }
  }
  checkGraph(map, faults);
  return faults;
}

}  // namespace parkade
