// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/map_evaluation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/eval/association.hpp"
#include "parkade/geometry/alignment.hpp"
#include "parkade/mapping/map_check.hpp"

namespace parkade {
namespace {

using Corners = std::array<Eigen::Vector2d, 4>;
using Way = std::vector<Eigen::Vector2d>;

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

double distanceToWay(const Eigen::Vector2d& p, const Way& way) {
  double best = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& q : way) best = std::min(best, (p - q).squaredNorm());
  return std::sqrt(best);
}

Corners moved(const Corners& corners, const SE2& T) {
  return {T * corners[0], T * corners[1], T * corners[2], T * corners[3]};
}

bool inside(const Eigen::Vector2d& p, const Corners& c) {
  bool odd = false;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& a = c[i];
    const Eigen::Vector2d& b = c[(i + 1) % 4];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) odd = !odd;
  }
  return odd;
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

// Pairs of map and truth, the best first, each once.
std::vector<SlotMatch> matchSlots(const std::vector<Corners>& told, const MapTruth& truth,
                                  const MapEvaluationOptions& options) {
  std::vector<SlotMatch> pairs;
  const double least = std::cos(options.max_turn_deg * M_PI / 180.0);
  for (std::size_t i = 0; i < told.size(); ++i) {
    for (std::size_t j = 0; j < truth.slots.size(); ++j) {
      const Corners& real = truth.slots[j].corners;
      constexpr double kFar = 8.0;
      if ((entranceOf(told[i]) - entranceOf(real)).norm() > kFar) continue;
      const Eigen::Vector2d a = told[i][1] - told[i][0];
      const Eigen::Vector2d b = real[1] - real[0];
      if (a.dot(b) < least * a.norm() * b.norm()) continue;
      SlotMatch match{i, j, iouOf(told[i], real), {}};
      if (match.iou < options.min_iou) continue;
      for (std::size_t k = 0; k < 4; ++k) match.corner_errors[k] = (told[i][k] - real[k]).norm();
      pairs.push_back(match);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const SlotMatch& a, const SlotMatch& b) { return a.iou > b.iou; });
  std::vector<bool> told_used(told.size(), false);
  std::vector<bool> real_used(truth.slots.size(), false);
  std::vector<SlotMatch> matches;
  for (const SlotMatch& pair : pairs) {
    if (told_used[pair.map_slot] || real_used[pair.truth_slot]) continue;
    told_used[pair.map_slot] = true;
    real_used[pair.truth_slot] = true;
    matches.push_back(pair);
  }
  return matches;
}

bool occupiedAt(const TruthSlot& slot, TimeNs t_ns, const MapTruth& truth) {
  if (slot.occupied) return true;
  constexpr TimeNs kNear = 200'000'000;
  return std::any_of(truth.vehicles.begin(), truth.vehicles.end(), [&](const TruthVehicle& v) {
    return std::abs(v.t_ns - t_ns) < kNear && inside(v.position, slot.corners);
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

void scoreSlots(const ParkingMap& map, const MapTruth& truth, const Way& way,
                MapEvaluation& result) {
  const MapEvaluationOptions& o = result.options;
  std::vector<Corners> told;
  for (const MapSlot& slot : map.slots) told.push_back(moved(slot.corners, result.T_truth_map));
  result.matches = matchSlots(told, truth, o);
  SlotScore& score = result.slots;
  std::vector<const SlotMatch*> of_truth(truth.slots.size(), nullptr);
  std::vector<bool> matched(told.size(), false);
  for (const SlotMatch& match : result.matches) {
    of_truth[match.truth_slot] = &match;
    matched[match.map_slot] = true;
  }
  std::vector<double> entrance;
  std::vector<double> all;
  std::vector<SlotMatch> found;
  const SE2 T_map_truth = result.T_truth_map.inverse();
  for (std::size_t j = 0; j < truth.slots.size(); ++j) {
    if (distanceToWay(entranceOf(truth.slots[j].corners), way) > o.passed_within_m) continue;
    ++score.passed;
    const bool in_sight = isInSight(truth.slots[j].corners, map.grid, T_map_truth);
    score.in_sight += in_sight ? 1 : 0;
    score.found_in_sight += in_sight && of_truth[j] != nullptr ? 1 : 0;
    if (of_truth[j] == nullptr) {
      result.missed.push_back(j);
      continue;
    }
    const SlotMatch& match = *of_truth[j];
    found.push_back(match);
    all.insert(all.end(), match.corner_errors.begin(), match.corner_errors.end());
    entrance.insert(entrance.end(), match.corner_errors.begin(), match.corner_errors.begin() + 2);
    scoreContent(map.slots[match.map_slot], truth.slots[j], truth, score);
  }
  score.found = static_cast<int>(found.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    const bool near = distanceToWay(entranceOf(told[i]), way) <= o.passed_within_m;
    if (!near) continue;
    ++score.told;
    if (matched[i]) continue;
    ++score.wrong;
    result.wrong.push_back(i);
    for (std::size_t k = 0; k < told.size(); ++k) {
      const bool twice = matched[k] && (entranceOf(told[i]) - entranceOf(told[k])).norm() < 8.0 &&
                         overlapShare(told[i], told[k]) > o.duplicate_overlap;
      if (!twice) continue;
      ++score.duplicates;
      break;
    }
  }
  score.recall = score.passed > 0 ? 1.0 * score.found / score.passed : 0.0;
  score.recall_in_sight = score.in_sight > 0 ? 1.0 * score.found_in_sight / score.in_sight : 0.0;
  score.precision = score.told > 0 ? 1.0 - 1.0 * score.wrong / score.told : 0.0;
  score.availability = score.found > 0 ? 1.0 * score.availability_right / score.found : 0.0;
  score.entrance_error = describe(entrance);
  score.corner_error = describe(all);
  score.fitted_entrance_error = describe(fittedErrors(told, truth, found));
}

bool passedBy(const TruthObject& object, const Way& way, double within) {
  return std::any_of(way.begin(), way.end(), [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d to = p - object.position.head<2>();
    const double distance = to.norm();
    if (distance > within) return false;
    // A face is legible from up to 60 degrees off its normal.
    return object.faces.empty() ||
           std::any_of(object.faces.begin(), object.faces.end(),
                       [&](const Eigen::Vector2d& n) { return n.dot(to) > 0.5 * distance; });
  });
}

void scoreObjects(const ParkingMap& map, const MapTruth& truth, const Way& way,
                  MapEvaluation& result) {
  struct Pair {
    double distance;
    std::size_t told;
    std::size_t real;
  };
  const MapEvaluationOptions& o = result.options;
  std::vector<Pair> pairs;
  std::vector<Eigen::Vector2d> told;
  for (const MapObject& object : map.objects) {
    told.push_back(result.T_truth_map * Eigen::Vector2d(object.position.head<2>()));
  }
  for (std::size_t i = 0; i < told.size(); ++i) {
    for (std::size_t j = 0; j < truth.objects.size(); ++j) {
      if (map.objects[i].semantic_class != truth.objects[j].semantic_class) continue;
      const double distance = (told[i] - truth.objects[j].position.head<2>()).norm();
      if (distance <= o.object_distance_m) pairs.push_back({distance, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  std::vector<bool> told_used(told.size(), false);
  std::vector<int> taken(truth.objects.size(), 0);
  std::vector<const Pair*> first(truth.objects.size(), nullptr);
  for (const Pair& pair : pairs) {
    if (told_used[pair.told] || taken[pair.real] >= truth.objects[pair.real].places) continue;
    told_used[pair.told] = true;
    if (taken[pair.real]++ == 0) first[pair.real] = &pair;
  }
  std::map<SemanticClass, std::vector<double>> errors;
  for (std::size_t j = 0; j < truth.objects.size(); ++j) {
    const TruthObject& object = truth.objects[j];
    if (!passedBy(object, way, o.passed_within_m)) continue;
    ObjectScore& score = result.objects[object.semantic_class];
    ++score.passed;
    if (first[j] == nullptr) continue;
    ++score.found;
    errors[object.semantic_class].push_back(first[j]->distance);
    if (object.text.empty()) continue;
    ++score.texts;
    score.texts_right += map.objects[first[j]->told].text == object.text ? 1 : 0;
  }
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (distanceToWay(told[i], way) > o.passed_within_m) continue;
    ObjectScore& score = result.objects[map.objects[i].semantic_class];
    ++score.told;
    score.wrong += told_used[i] ? 0 : 1;
  }
  for (auto& [semantic_class, score] : result.objects) {
    score.position_error = describe(errors[semantic_class]);
  }
}

}  // namespace

Result<SE3> placeByFirstPose(TimeNs t_ns, const SE3& T_map_vehicle, const Trajectory& driven) {
  AssociationOptions options;
  options.interpolate = true;
  const Result<Association> pairs = associate({{t_ns, T_map_vehicle}}, driven, options);
  if (!pairs) {
    return Error{fmt::format("no reference where the map begins: {}", pairs.error().message)};
  }
  const SE3& there = pairs->reference.front().T_world_body;
  const SE3& here = pairs->estimate.front().T_world_body;
  SE3 T = (SE2::fromSE3(there) * SE2::fromSE3(here).inverse()).toSE3();
  T.translation().z() = there.translation().z() - here.translation().z();
  return T;
}

Result<MapEvaluation> evaluateMap(const ParkingMap& map, const SE2& T_truth_map,
                                  const MapTruth& truth, const MapEvaluationOptions& options) {
  MapEvaluation result;
  result.options = options;
  result.T_truth_map = T_truth_map;
  Way way;
  constexpr double kSpacing = 0.1;
  for (const auto& pose : truth.driven) {
    const Eigen::Vector2d p = pose.T_world_body.translation().head<2>();
    if (way.empty() || (p - way.back()).norm() >= kSpacing) way.push_back(p);
  }
  scoreSlots(map, truth, way, result);
  scoreObjects(map, truth, way, result);
  result.loops = scoreLoops(map, truth.driven);
  for (Eigen::Vector2d& p : way) p = T_truth_map.inverse() * p;
  for (const GridLayer layer : kGridLayers) {
    if (layer == GridLayer::kDynamic) continue;
    const Result<LayerScore> score =
        scoreLayer(map.grid, layer, T_truth_map, truth, way, options.passed_within_m);
    if (!score) return score.error();
    result.layers[layer] = *score;
  }
  return result;
}

}  // namespace parkade
