// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "parkade/core/nearest_first.hpp"
#include "parkade/eval/map_evaluation_parts.hpp"
#include "parkade/geometry/alignment.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/map_check.hpp"

namespace parkade {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;

double areaOf(const Corners& c) {
  return std::abs(signedArea({c.begin(), c.end()}));
}

double iouOf(const Corners& a, const Corners& b) {
  const double area_a = areaOf(a);
  const double area_b = areaOf(b);
  const double common = overlapShare(a, b) * std::min(area_a, area_b);
  const double all = area_a + area_b - common;
  return all > 0.0 ? common / all : 0.0;
}

Eigen::Vector2d entranceOf(const Corners& c) {
  return 0.5 * (c[0] + c[1]);
}

Corners moved(const Corners& corners, const SE2& T) {
  return {T * corners[0], T * corners[1], T * corners[2], T * corners[3]};
}

// Whether the map knows the ground, or what stands on it, within a cell of both entrance corners.
bool isInSight(const Corners& corners, const LayeredGrid& grid, const SE2& T_map_truth) {
  const auto is_known = [&](const Eigen::Vector2d& p) {
    return anyWithinACell(grid.cellOf(T_map_truth * p), [&](const Eigen::Vector2i& cell) {
      return grid.at(GridLayer::kParkingLines, cell).known();
    });
  };
  return is_known(corners[0]) && is_known(corners[1]);
}

// The pair of a slot told and a real one, where they may be the same.
std::optional<SlotMatch> pairOf(const Corners& told, const Corners& real,
                                const MapEvaluationOptions& options) {
  constexpr double kFar = 8.0;
  if ((entranceOf(told) - entranceOf(real)).norm() > kFar) return std::nullopt;
  const double least = std::cos(options.max_turn_deg * M_PI / 180.0);
  const Eigen::Vector2d a = told[1] - told[0];
  const Eigen::Vector2d b = real[1] - real[0];
  if (a.dot(b) < least * a.norm() * b.norm()) return std::nullopt;
  SlotMatch match;
  match.iou = iouOf(told, real);
  if (match.iou < options.min_iou) return std::nullopt;
  for (std::size_t k = 0; k < 4; ++k) match.corner_errors[k] = (told[k] - real[k]).norm();
  return match;
}

// Pairs of map and truth, the best first, each once; in the order of the truth.
std::vector<SlotMatch> matchSlots(const std::vector<Corners>& told, const MapTruth& truth,
                                  const MapEvaluationOptions& options) {
  std::vector<TrackPair> pairs;
  for (std::size_t i = 0; i < told.size(); ++i) {
    for (std::size_t j = 0; j < truth.slots.size(); ++j) {
      const auto match = pairOf(told[i], truth.slots[j].corners, options);
      if (match) pairs.push_back({-match->iou, i, j});
    }
  }
  const auto of_truth = matchNearestFirst(std::move(pairs), told.size(), truth.slots.size());
  std::vector<SlotMatch> matches;
  for (std::size_t j = 0; j < truth.slots.size(); ++j) {
    if (!of_truth[j]) continue;
    SlotMatch match = *pairOf(told[*of_truth[j]], truth.slots[j].corners, options);
    match.map_slot = *of_truth[j];
    match.truth_slot = j;
    matches.push_back(match);
  }
  return matches;
}

bool occupiedAt(const TruthSlot& slot, TimeNs t_ns, const MapTruth& truth) {
  if (slot.occupied) return true;
  constexpr TimeNs kNear = 200'000'000;
  return std::any_of(truth.vehicles.begin(), truth.vehicles.end(), [&](const TruthVehicle& v) {
    return std::abs(v.t_ns - t_ns) < kNear && contains(slot.corners, v.position);
  });
}

// A slot halfway between markers belongs to either.
bool isZone(const std::string& text, const TruthSlot& slot, const MapTruth& truth) {
  if (text == slot.zone) return true;
  constexpr double kTie = 0.5;  // m
  const Eigen::Vector2d middle =
      0.25 * (slot.corners[0] + slot.corners[1] + slot.corners[2] + slot.corners[3]);
  double nearest = std::numeric_limits<double>::infinity();
  double called_so = std::numeric_limits<double>::infinity();
  for (const TruthObject& object : truth.objects) {
    if (object.semantic_class != SemanticClass::kZoneMarker || object.text.empty()) continue;
    const double distance = (object.position.head<2>() - middle).norm();
    nearest = std::min(nearest, distance);
    if (object.text == text) called_so = std::min(called_so, distance);
  }
  return called_so < nearest + kTie;
}

void scoreContent(const MapSlot& told, const TruthSlot& real, const MapTruth& truth,
                  SlotScore& score) {
  const bool occupied = occupiedAt(real, told.last_seen_ns, truth);
  if (!told.isFree() && !told.isOccupied()) {
    ++score.availability_open;
  } else if (occupied == told.isOccupied()) {
    ++score.availability_right;
  }
  if (!real.number.empty()) {
    ++score.numbers;
    score.numbers_right += told.number == real.number ? 1 : 0;
    score.numbers_wrong += !told.number.empty() && told.number != real.number ? 1 : 0;
  }
  if (!real.zone.empty()) {
    ++score.zones;
    score.zones_right += isZone(told.zone, real, truth) ? 1 : 0;
  }
}

// Entrance corners after the rigid motion over the ground that fits them best.
std::vector<double> fittedErrors(const std::vector<Corners>& told, const MapTruth& truth,
                                 const std::vector<SlotMatch>& matches) {
  Points3d source;
  Points3d target;
  for (const SlotMatch& match : matches) {
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Vector2d& a = told[match.map_slot][k];
      const Eigen::Vector2d& b = truth.slots[match.truth_slot].corners[k];
      source.emplace_back(a.x(), a.y(), 0.0);
      target.emplace_back(b.x(), b.y(), 0.0);
    }
  }
  const Alignment fit = alignYaw(source, target);
  std::vector<double> errors;
  for (std::size_t i = 0; i < source.size(); ++i) {
    errors.push_back((fit * source[i] - target[i]).norm());
  }
  return errors;
}

// Slots of the map near the way, and those of them that are none.
void scoreTold(const std::vector<Corners>& told, const Way& way, MapEvaluation& result) {
  std::vector<bool> matched(told.size(), false);
  for (const SlotMatch& match : result.matches) matched[match.map_slot] = true;
  const auto is_there_again = [&](std::size_t i) {
    for (std::size_t k = 0; k < told.size(); ++k) {
      if (matched[k] && (entranceOf(told[i]) - entranceOf(told[k])).norm() < 8.0 &&
          overlapShare(told[i], told[k]) > result.options.duplicate_overlap) {
        return true;
      }
    }
    return false;
  };
  SlotScore& score = result.slots;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (distanceToWay(entranceOf(told[i]), way) > result.options.passed_within_m) continue;
    ++score.told;
    if (matched[i]) continue;
    ++score.wrong;
    result.wrong.push_back(i);
    score.duplicates += is_there_again(i) ? 1 : 0;
  }
}

// Slots of the truth near the way; those of them that are found.
std::vector<SlotMatch> scorePassed(const ParkingMap& map, const MapTruth& truth, const Way& way,
                                   MapEvaluation& result) {
  std::vector<const SlotMatch*> of_truth(truth.slots.size(), nullptr);
  for (const SlotMatch& match : result.matches) of_truth[match.truth_slot] = &match;
  const SE2 T_map_truth = result.T_truth_map.inverse();
  SlotScore& score = result.slots;
  std::vector<SlotMatch> found;
  for (std::size_t j = 0; j < truth.slots.size(); ++j) {
    const TruthSlot& real = truth.slots[j];
    if (distanceToWay(entranceOf(real.corners), way) > result.options.passed_within_m) continue;
    ++score.passed;
    const bool in_sight = isInSight(real.corners, map.grid, T_map_truth);
    score.in_sight += in_sight ? 1 : 0;
    score.found_in_sight += in_sight && of_truth[j] != nullptr ? 1 : 0;
    if (of_truth[j] == nullptr) {
      result.missed.push_back(j);
      continue;
    }
    found.push_back(*of_truth[j]);
    scoreContent(map.slots[of_truth[j]->map_slot], real, truth, score);
  }
  score.found = static_cast<int>(found.size());
  return found;
}

}  // namespace

void scoreSlots(const ParkingMap& map, const MapTruth& truth, const Way& way,
                MapEvaluation& result) {
  std::vector<Corners> told;
  for (const MapSlot& slot : map.slots) told.push_back(moved(slot.corners, result.T_truth_map));
  result.matches = matchSlots(told, truth, result.options);
  const std::vector<SlotMatch> found = scorePassed(map, truth, way, result);
  scoreTold(told, way, result);
  std::vector<double> entrance;
  std::vector<double> all;
  for (const SlotMatch& match : found) {
    const auto& errors = match.corner_errors;
    all.insert(all.end(), errors.begin(), errors.end());
    entrance.insert(entrance.end(), errors.begin(), errors.begin() + 2);
  }
  SlotScore& score = result.slots;
  score.recall = score.passed > 0 ? 1.0 * score.found / score.passed : 0.0;
  score.recall_in_sight = score.in_sight > 0 ? 1.0 * score.found_in_sight / score.in_sight : 0.0;
  score.precision = score.told > 0 ? 1.0 - 1.0 * score.wrong / score.told : 0.0;
  score.availability = score.found > 0 ? 1.0 * score.availability_right / score.found : 0.0;
  score.entrance_error = describe(entrance);
  score.corner_error = describe(all);
  score.fitted_entrance_error = describe(fittedErrors(told, truth, found));
}

}  // namespace parkade
