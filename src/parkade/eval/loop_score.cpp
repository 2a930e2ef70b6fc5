// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/loop_score.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "parkade/eval/association.hpp"
#include "parkade/geometry/se2.hpp"

namespace parkade {
namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr int kAngle = 5;  // of an edge's information

// Where the nodes were in truth, by id; those that the truth covers.
std::map<std::int64_t, SE2> truePlaces(const ParkingMap& map, const Trajectory& driven) {
  Trajectory nodes;
  for (const PoseGraphNode& node : map.nodes) nodes.push_back({node.t_ns, node.T_world_vehicle});
  std::stable_sort(nodes.begin(), nodes.end(),
                   [](const auto& a, const auto& b) { return a.t_ns < b.t_ns; });
  AssociationOptions options;
  options.interpolate = true;
  const Result<Association> pairs = associate(nodes, driven, options);
  if (!pairs) return {};
  std::map<TimeNs, SE2> at;
  for (const StampedPose& pose : pairs->reference) {
    at.emplace(pose.t_ns, SE2::fromSE3(pose.T_world_body));
  }
  std::map<std::int64_t, SE2> places;
  for (const PoseGraphNode& node : map.nodes) {
    const auto found = at.find(node.t_ns);
    if (found != at.end()) places.emplace(node.id, found->second);
  }
  return places;
}

// Its length in the directions that are known.
double knownLength(const Eigen::Vector2d& error, const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(information.topLeftCorner<2, 2>());
  double squares = 0.0;
  for (int k = 0; k < 2; ++k) {
    const bool known = eigen.eigenvalues()[k] * kWrongLoopDistance * kWrongLoopDistance >= 1.0;
    if (known) squares += std::pow(eigen.eigenvectors().col(k).dot(error), 2);
  }
  return std::sqrt(squares);
}

}  // namespace

LoopScore scoreLoops(const ParkingMap& map, const Trajectory& driven) {
  const std::map<std::int64_t, SE2> places = truePlaces(map, driven);
  LoopScore score;
  std::vector<double> errors;
  std::vector<double> turns;
  for (const PoseGraphEdge& edge : map.edges) {
    const auto from = places.find(edge.from);
    const auto to = places.find(edge.to);
    if (edge.kind != EdgeKind::kLoop || from == places.end() || to == places.end()) continue;
    const SE2 T_true_told =
        (from->second.inverse() * to->second).inverse() * SE2::fromSE3(edge.T_from_to);
    const double error = knownLength(T_true_told.translation(), edge.information);
    const double allowed = kWrongLoopAngle / kDegrees;
    const bool heading = edge.information(kAngle, kAngle) * allowed * allowed >= 1.0;
    const double turn = std::abs(T_true_told.angle()) * kDegrees;
    ++score.told;
    score.wrong += error > kWrongLoopDistance || (heading && turn > kWrongLoopAngle) ? 1 : 0;
    errors.push_back(error);
    if (heading) turns.push_back(turn);
  }
  score.error = describe(errors);
  score.turn = describe(turns);
  return score;
}

}  // namespace parkade
