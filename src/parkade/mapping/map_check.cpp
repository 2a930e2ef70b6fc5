// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/map_check.hpp"

#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "parkade/geometry/planar.hpp"

namespace parkade {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

constexpr double kMaxCoordinate = 1e4;  // m from the origin along an axis; no garage is that large

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

template <class Vector>
bool near(const Vector& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() < kMaxCoordinate;
}

template <class Vector>
std::string farText(const std::string& what, const Vector& p) {
  return fmt::format("{}: lies at ({:g}) m, farther than {:g} m from the origin", what,
                     fmt::join(p.data(), p.data() + p.size(), ", "), kMaxCoordinate);
}

// Of all points the first that is too far away; false where there is one.
template <class Points>
bool checkNear(const std::string& what, const Points& points, std::vector<std::string>& faults) {
  for (const auto& p : points) {
    if (near(p)) continue;
    faults.push_back(farText(what, p));
    return false;
  }
  return true;
}

void checkSigma(const std::string& what, double sigma, std::vector<std::string>& faults) {
  if (sigma >= 0.0 && sigma < kMaxCoordinate) return;
  faults.push_back(fmt::format("{} of {:g} m, expected 0 to {:g}", what, sigma, kMaxCoordinate));
}

void checkCount(const std::string& what, std::int64_t count, std::vector<std::string>& faults) {
  if (count < 0) faults.push_back(fmt::format("{} of {}, expected 0 or more", what, count));
}

// A tile's far corner counts. One fault per layer: a wrong resolution moves all of its tiles.
void checkTiles(const LayeredGrid& grid, std::vector<std::string>& faults) {
  const double side = grid.resolution() * LayeredGrid::kTileCells;
  for (const GridLayer layer : kGridLayers) {
    const LayeredGrid::TileIndex* first = nullptr;
    int others = 0;
    for (const auto& [at, tile] : grid.tiles(layer)) {
      const Eigen::Vector2d low(side * at.x, side * at.y);
      if (near(low) && near((low.array() + side).matrix().eval())) continue;
      if (first == nullptr) {
        first = &at;
      } else {
        ++others;
      }
    }
    if (first == nullptr) continue;
    const std::string what = fmt::format("tile ({}, {}) of layer {}", first->x, first->y,
                                         kGridLayerNames[static_cast<std::size_t>(layer)]);
    const std::string fault = farText(what, Eigen::Vector2d(side * first->x, side * first->y));
    faults.push_back(others == 0 ? fault
                                 : fmt::format("{} (and {} more of its tiles)", fault, others));
  }
}

// Whether its corners are such that it can be compared with others.
bool checkSlot(const MapSlot& slot, std::vector<std::string>& faults) {
  const std::string what = fmt::format("slot {}", slot.id);
  checkSigma(what + ": corner_sigma", slot.corner_sigma, faults);
  checkCount(what + ": observations", slot.observations, faults);
  if (!checkNear(what, slot.corners, faults)) return false;
  const double area = std::abs(signedArea({slot.corners.begin(), slot.corners.end()}));
  constexpr double kLeast = 1.0;
  if (area < kLeast) {
    faults.push_back(fmt::format("{}: area of {:.2f} m^2", what, area));
    return false;
  }
  return true;
}

void checkOverlaps(std::vector<const MapSlot*> slots, std::vector<std::string>& faults) {
  // Sorted by x: only neighbours are compared.
  const auto left = [](const MapSlot* s) {
    return std::min({s->corners[0].x(), s->corners[1].x(), s->corners[2].x(), s->corners[3].x()});
  };
  const auto right = [](const MapSlot* s) {
    return std::max({s->corners[0].x(), s->corners[1].x(), s->corners[2].x(), s->corners[3].x()});
  };
  std::stable_sort(slots.begin(), slots.end(),
                   [&](const MapSlot* a, const MapSlot* b) { return left(a) < left(b); });
  for (std::size_t i = 0; i < slots.size(); ++i) {
    for (std::size_t j = i + 1; j < slots.size() && left(slots[j]) < right(slots[i]); ++j) {
      const double share = overlapShare(slots[i]->corners, slots[j]->corners);
      constexpr double kMost = 0.3;
      if (share > kMost) {
        faults.push_back(fmt::format("slots {} and {}: {:.0f} % of the smaller one is in both",
                                     std::min(slots[i]->id, slots[j]->id),
                                     std::max(slots[i]->id, slots[j]->id), 100.0 * share));
      }
    }
  }
}

void checkSlots(const ParkingMap& map, std::vector<std::string>& faults) {
  std::set<std::int64_t> ids;
  std::vector<const MapSlot*> sound;
  for (const MapSlot& slot : map.slots) {
    if (!ids.insert(slot.id).second) faults.push_back(fmt::format("slot {}: id repeats", slot.id));
    if (checkSlot(slot, faults)) sound.push_back(&slot);
  }
  checkOverlaps(std::move(sound), faults);
}

void checkObjects(const ParkingMap& map, std::vector<std::string>& faults) {
  std::set<std::int64_t> ids;
  for (const MapObject& object : map.objects) {
    const std::string what = fmt::format("object {}", object.id);
    if (!ids.insert(object.id).second) faults.push_back(what + ": id repeats");
    if (checkNear(what, std::array{object.position}, faults)) {
      checkNear(what + ": outline", object.outline, faults);
    }
    if (!std::isfinite(object.heading)) faults.push_back(what + ": heading is not finite");
    checkSigma(what + ": position_sigma", object.position_sigma, faults);
    checkCount(what + ": observations", object.observations, faults);
  }
}

bool isInformation(const Matrix6d& matrix) {
  const double largest = matrix.cwiseAbs().maxCoeff();
  const double skew = (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
  if (!std::isfinite(largest) || skew > 1e-9 * largest) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(matrix, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -1e-9 * largest;
}

void checkGraph(const ParkingMap& map, std::vector<std::string>& faults) {
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    const PoseGraphNode& node = map.nodes[i];
    const std::string what = fmt::format("node {}", node.id);
    checkNear(what, std::array{node.T_world_vehicle.translation()}, faults);
    if (i > 0 && node.t_ns < map.nodes[i - 1].t_ns) {
      faults.push_back(what + ": is older than the one before");
    }
  }
  for (const PoseGraphEdge& edge : map.edges) {
    const std::string what = fmt::format("edge {} to {}", edge.from, edge.to);
    if (edge.from == edge.to) faults.push_back(what + ": joins a node to itself");
    const double length = edge.T_from_to.translation().norm();
    if (!(length < kMaxCoordinate)) {
      faults.push_back(
          fmt::format("{}: is {:g} m long, more than {:g}", what, length, kMaxCoordinate));
    }
    if (!isInformation(edge.information)) {
      faults.push_back(what + ": its information is no symmetric, positive matrix");
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
  checkTiles(map.grid, faults);
  checkSlots(map, faults);
  checkObjects(map, faults);
  checkGraph(map, faults);
  return faults;
}

}  // namespace parkade
