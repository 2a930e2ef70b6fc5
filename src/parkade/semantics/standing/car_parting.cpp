// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/car_parting.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/standing/agent_slots.hpp"
#include "parkade/semantics/standing/object_boxes.hpp"

namespace parkade {
namespace {

using Points = std::vector<Eigen::Vector2d>;

// Indices of the points on the hull's side that faces the viewer, in sweeping order.
std::vector<std::size_t> nearHull(const Points& swept) {
  std::vector<std::size_t> hull;
  for (std::size_t i = 0; i < swept.size(); ++i) {
    while (hull.size() >= 2) {
      const Eigen::Vector2d& a = swept[hull[hull.size() - 2]];
      const Eigen::Vector2d& b = swept[hull.back()];
      // Sweeping to the left, the near side turns to the right.
      if (cross(b - a, swept[i] - b) < 0.0) break;
      hull.pop_back();
    }
    hull.push_back(i);
  }
  return hull;
}

// Where swept points part into two cars: after this index; 0 where they do not.
std::size_t findNotch(const Points& swept, double least_depth) {
  constexpr double kWidest = 1.1;    // m: gaps between cars; between a car's wheels it is wider
  constexpr double kLeastCar = 1.0;  // m: of a car's front at least so much is seen
  const std::vector<std::size_t> hull = nearHull(swept);
  std::size_t best = 0;
  double deepest = least_depth;
  for (std::size_t k = 0; k + 1 < hull.size(); ++k) {
    const Eigen::Vector2d& a = swept[hull[k]];
    const Eigen::Vector2d chord = swept[hull[k + 1]] - a;
    const double length = chord.norm();
    if (length < 0.2) continue;
    const auto depthOf = [&](std::size_t i) { return cross(swept[i] - a, chord) / length; };
    std::size_t at = 0;
    double depth = 0.0;
    for (std::size_t i = hull[k] + 1; i < hull[k + 1]; ++i) {
      const double d = std::abs(depthOf(i));
      if (d > depth) {
        depth = d;
        at = i;
      }
    }
    if (depth <= deepest) continue;
    // Its width half way down, along the chord.
    std::size_t left = at;
    std::size_t right = at;
    while (left > hull[k] && std::abs(depthOf(left)) > 0.5 * depth) --left;
    while (right < hull[k + 1] && std::abs(depthOf(right)) > 0.5 * depth) ++right;
    const double width = std::abs(chord.dot(swept[right] - swept[left])) / length;
    if (width > kWidest) continue;
    if (reachOf(swept, 0, at) < kLeastCar || reachOf(swept, at, swept.size()) < kLeastCar) continue;
    deepest = depth;
    best = at;
  }
  return best;
}

// After which point something else is in between, seen from the viewer; 0 where nothing is.
std::size_t findGap(const Points& swept, const Eigen::Vector2d& viewer) {
  constexpr double kGap = 0.5;  // m
  for (std::size_t i = 1; i < swept.size(); ++i) {
    const Eigen::Vector2d ray = (swept[i - 1] - viewer).normalized();
    if (std::abs(cross(ray, swept[i] - swept[i - 1])) > kGap) return i;
  }
  return 0;
}

// Whether they reach farther than a car; row: the direction that it lies in, where that is known.
bool areTooMany(const GroundBox& box, std::optional<double> row) {
  constexpr double kLongest = 5.8;  // m: no car is longer, or this wide, with its mirrors
  constexpr double kWidest = 2.7;
  if (!row) return box.size.maxCoeff() >= kLongest || box.size.minCoeff() >= kWidest;
  const int across = std::abs(std::cos(*row - box.heading)) > M_SQRT1_2 ? 1 : 0;
  return box.size[across] >= kWidest;
}

// How far the points from begin to before end reach along a direction, m.
double extentAlong(const Points& points, const Eigen::Vector2d& direction, std::size_t begin,
                   std::size_t end) {
  double low = std::numeric_limits<double>::max();
  double high = -low;
  for (std::size_t i = begin; i < end; ++i) {
    low = std::min(low, direction.dot(points[i]));
    high = std::max(high, direction.dot(points[i]));
  }
  return high - low;
}

// By how much two parts of an edge are not as wide as cars in a row are, m. Of the nearer one all
// is seen; the one beyond it may be hidden in part.
double widthMisfit(const Points& floor, std::size_t at, const Eigen::Vector2d& viewer, double row) {
  constexpr double kWidth = 1.85;
  constexpr double kVaries = 0.15;
  constexpr double kFarther = 0.1;
  const Eigen::Vector2d across(-std::sin(row), std::cos(row));
  const auto off = [&](std::size_t begin, std::size_t end) {
    return std::max(0.0, std::abs(extentAlong(floor, across, begin, end) - kWidth) - kVaries);
  };
  const double first = off(0, at);
  const double second = off(at, floor.size());
  const bool first_is_near =
      (floor.front() - viewer).squaredNorm() < (floor.back() - viewer).squaredNorm();
  return first_is_near ? std::min(first, second + kFarther) : std::min(second, first + kFarther);
}

// Where points on the floor that are too many for one car part best into two; 0 where they are not.
std::size_t findSizeLimit(const Points& floor, const Eigen::Vector2d& viewer,
                          std::optional<double> row) {
  constexpr double kStep = 0.15;   // m between the places that are tried
  constexpr double kMisfit = 0.3;  // of a width, in mean distances of points from faces
  // m of each car; in a row the far one may show no more than a corner.
  const double least_part = row ? 0.4 : 1.0;
  double whole = 0.0;
  if (!areTooMany(fitFaces(floor, viewer, &whole, row), row)) return 0;
  std::size_t best = 0;
  const auto count = static_cast<double>(floor.size());
  double least = row ? std::numeric_limits<double>::max() : whole * count;
  Eigen::Vector2d last = floor.front();
  for (std::size_t i = 1; i + 1 < floor.size(); ++i) {
    if ((floor[i] - last).norm() < kStep) continue;
    last = floor[i];
    if (reachOf(floor, 0, i) < least_part || reachOf(floor, i, floor.size()) < least_part) continue;
    const auto middle = floor.begin() + static_cast<std::ptrdiff_t>(i);
    double first = 0.0;
    double second = 0.0;
    fitFaces(Points(floor.begin(), middle), viewer, &first, row);
    fitFaces(Points(middle, floor.end()), viewer, &second, row);
    double both = first * static_cast<double>(i) + second * (count - static_cast<double>(i));
    if (row) both += kMisfit * count * widthMisfit(floor, i, viewer, *row);
    if (both >= least) continue;
    least = both;
    best = i;
  }
  return best;
}

void part(Points swept, const Eigen::Vector2d& viewer, double least_depth,
          const std::vector<SlotObservation>& slots,
          const std::function<Points(const Points&)>& on_floor, std::vector<CarEdge>& out) {
  std::size_t at = findGap(swept, viewer);
  if (at == 0) at = findNotch(swept, least_depth);
  if (at == 0) {
    Points floor = on_floor(swept);
    at = findSlotChange(floor, slots);
    if (at == 0) {
      const std::optional<double> row = findRowHeading(floor, slots);
      at = findSizeLimit(floor, viewer, row);
      if (at == 0) {
        out.push_back({std::move(swept), std::move(floor), row});
        return;
      }
    }
  }
  const auto middle = swept.begin() + static_cast<std::ptrdiff_t>(at);
  part(Points(swept.begin(), middle), viewer, least_depth, slots, on_floor, out);
  part(Points(middle, swept.end()), viewer, least_depth, slots, on_floor, out);
}

}  // namespace

Points sweepOver(const Points& points, const Eigen::Vector2d& viewer) {
  constexpr double kBin = M_PI / 360.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += (p - viewer) / static_cast<double>(points.size());
  const double middle = std::atan2(mean.y(), mean.x());
  std::vector<std::pair<int, std::size_t>> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d d = points[i] - viewer;
    const double turn = std::remainder(std::atan2(d.y(), d.x()) - middle, 2.0 * M_PI);
    order.emplace_back(static_cast<int>(std::floor(turn / kBin)), i);
  }
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const double ra = (points[a.second] - viewer).squaredNorm();
    const double rb = (points[b.second] - viewer).squaredNorm();
    return ra != rb ? ra < rb : a.second < b.second;
  });
  Points out;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && order[k].first == order[k - 1].first) continue;
    out.push_back(points[order[k].second]);
  }
  return out;
}

double reachOf(const Points& points, std::size_t begin, std::size_t end) {
  double reach = 0.0;
  for (std::size_t i = begin; i < end; ++i)
    reach = std::max(reach, (points[i] - points[begin]).norm());
  return reach;
}

std::vector<CarEdge> partCars(Points swept, const Eigen::Vector2d& viewer, double least_depth,
                              const std::vector<SlotObservation>& slots,
                              const std::function<Points(const Points&)>& on_floor) {
  std::vector<CarEdge> cars;
  part(std::move(swept), viewer, least_depth, slots, on_floor, cars);
  return cars;
}

}  // namespace parkade
