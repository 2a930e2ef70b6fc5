// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/map_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

#include "parkade/core/units.hpp"
#include "parkade/mapping/map_landmarks.hpp"

namespace parkade {
namespace {

// Every place that lays one of the car's things on one of the map's, once.
class Places {
 public:
  void add(const std::vector<SE2>& seen, const std::vector<SE2>& mapped) {
    for (const SE2& there : mapped) {
      for (const SE2& here : seen) add(there * here.inverse());
    }
  }
  [[nodiscard]] const std::vector<SE2>& all() const { return places_; }

 private:
  void add(const SE2& T_map_vehicle) {
    constexpr double kCell = 0.25;           // m
    constexpr double kTurn = 1.0 * kDegree;  // several slots seen tell the same place
    const auto bin = [](double value, double size) {
      return static_cast<int>(std::lround(value / size));
    };
    const Eigen::Vector2d& p = T_map_vehicle.translation();
    if (known_.insert({bin(p.x(), kCell), bin(p.y(), kCell), bin(T_map_vehicle.angle(), kTurn)})
            .second) {
      places_.push_back(T_map_vehicle);
    }
  }
  std::set<std::tuple<int, int, int>> known_;
  std::vector<SE2> places_;
};

// That leaves about so many line points of a frame.
std::size_t strideTo(std::size_t points, const SemanticFrame& frame) {
  return std::max<std::size_t>(1, frame.line_points.size() / points);
}

// Scores all places by few points, the better ones of them by more.
std::vector<PlaceCandidate> scored(const std::vector<SE2>& places, const SemanticFrame& frame,
                                   const Submap& landmarks, const MapSearchOptions& options) {
  std::vector<PlaceCandidate> candidates;
  for (const SE2& place : places) candidates.push_back({place, 0.0});
  struct Round {
    std::size_t line_points;
    double radius;  // m, by the one of the first round
    int kept;       // of each place that will be registered
  };
  constexpr std::array<Round, 3> kRounds = {{{20, 1.0, 20}, {60, 1.0, 8}, {250, 0.5, 8}}};
  for (const Round& round : kRounds) {
    const PlaceScorer scorer(frame, landmarks, round.radius * options.coarse_radius_m,
                             strideTo(round.line_points, frame));
    for (PlaceCandidate& c : candidates) c.score = scorer.at(c.T_map_vehicle);
    sortByScore(candidates);
    const auto kept = static_cast<std::size_t>(round.kept * options.refined);
    if (candidates.size() > kept) candidates.resize(kept);
  }
  return candidates;
}

SemanticFrame thinned(const SemanticFrame& frame, std::size_t points) {
  SemanticFrame thin = frame;
  thin.line_points.clear();
  const std::size_t stride = strideTo(points, frame);
  for (std::size_t i = 0; i < frame.line_points.size(); i += stride) {
    thin.line_points.push_back(frame.line_points[i]);
  }
  return thin;
}

}  // namespace

SemanticFrame asFrame(const Submap& submap) {
  constexpr double kLeastSigma = 0.03;  // m
  SemanticFrame frame;
  for (const LineFeature& line : submap.lines().features()) {
    frame.line_points.push_back({line.p, line.normal,
                                 std::max(kLeastSigma, 1.0 / std::sqrt(line.weight)),
                                 line.semantic_class});
  }
  for (const PointFeature& landmark : submap.points()) {
    if (!isPointLandmark(landmark.semantic_class)) continue;
    ObjectObservation object;
    object.semantic_class = landmark.semantic_class;
    object.position.head<2>() = landmark.p;
    object.covariance.topLeftCorner<2, 2>() = landmark.covariance;
    object.text = landmark.text;
    object.confidence = 1.0;
    frame.objects.push_back(object);
  }
  return frame;
}

SE2 slotFrame(const std::array<Eigen::Vector2d, 4>& corners) {
  // The left end of the entrance lies to the left of who looks in.
  const Eigen::Vector2d left = corners[0] - corners[1];
  return {std::atan2(left.y(), left.x()) - M_PI_2, 0.5 * (corners[0] + corners[1])};
}

SavedMap::SavedMap(const ParkingMap& map) : landmarks(landmarksOf(map)) {
  for (const MapSlot& slot : map.slots) slots.push_back(slotFrame(slot.corners));
  for (const MapObject& object : map.objects) {
    if (object.semantic_class != SemanticClass::kArrow) continue;
    arrows.emplace_back(object.heading, object.position.head<2>());
  }
  for (const PoseGraphNode& node : map.nodes) way.push_back(node.T_world_vehicle.translation());
}

double SavedMap::heightAt(const Eigen::Vector2d& p) const {
  const auto nearest = std::min_element(
      way.begin(), way.end(), [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
        return (a.head<2>() - p).squaredNorm() < (b.head<2>() - p).squaredNorm();
      });
  return nearest == way.end() ? 0.0 : nearest->z();
}

LoopResult findInMap(const Surroundings& surroundings, const SavedMap& map,
                     const MapSearchOptions& options, const RegistrationOptions& registration) {
  Places places;
  places.add(surroundings.slots, map.slots);
  places.add(surroundings.arrows, map.arrows);
  const SemanticFrame frame =
      thinned(surroundings.features, static_cast<std::size_t>(options.line_points));
  if (places.all().empty() || frame.line_points.empty()) {
    LoopResult nothing;
    nothing.reason = "no slot or arrow is seen yet";
    return nothing;
  }
  RegistrationOptions whole = registration;
  whole.min_inlier_share = options.min_inlier_share;
  whole.max_iterations = options.max_iterations;
  PlaceRules rules;
  rules.refined = options.refined;
  rules.ambiguity = options.ambiguity;
  rules.least_fit = options.least_fit;
  // Places as near as this may end elsewhere: worn lines pull a registration to their like.
  rules.spacing_m = 0.25;
  rules.spacing_rad = 1.0 * kDegree;
  rules.wrong_texts = options.wrong_texts;
  rules.texts_exclude = true;
  rules.landmarks_first = true;
  rules.enough_texts = options.enough_texts;
  rules.least_fit_by_texts = options.least_fit_by_texts;
  return decidePlace(frame, map.landmarks, scored(places.all(), frame, map.landmarks, options),
                     rules, whole);
}

}  // namespace parkade
