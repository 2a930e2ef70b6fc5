// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "parkade/eval/map_evaluation_parts.hpp"

namespace parkade {
namespace {

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

// A told object and a real one that it stands for.
struct Pair {
  double distance = 0.0;
  std::size_t told = 0;
  std::size_t real = 0;
};

// Objects of one class within reach of each other, the nearest first.
std::vector<Pair> pairsOf(const ParkingMap& map, const std::vector<Eigen::Vector2d>& told,
                          const MapTruth& truth, double reach) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < told.size(); ++i) {
    for (std::size_t j = 0; j < truth.objects.size(); ++j) {
      if (map.objects[i].semantic_class != truth.objects[j].semantic_class) continue;
      const double distance = (told[i] - truth.objects[j].position.head<2>()).norm();
      if (distance <= reach) pairs.push_back({distance, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
  return pairs;
}

}  // namespace

void scoreObjects(const ParkingMap& map, const MapTruth& truth, const Way& way,
                  MapEvaluation& result) {
  const MapEvaluationOptions& o = result.options;
  std::vector<Eigen::Vector2d> told;
  for (const MapObject& object : map.objects) {
    told.push_back(result.T_truth_map * Eigen::Vector2d(object.position.head<2>()));
  }
  const std::vector<Pair> pairs = pairsOf(map, told, truth, o.object_distance_m);
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

}  // namespace parkade
