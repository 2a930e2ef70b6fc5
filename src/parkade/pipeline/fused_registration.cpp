// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "parkade/core/log.hpp"
#include "parkade/core/units.hpp"
#include "parkade/pipeline/fused_mapper_impl.hpp"
#include "parkade/pipeline/shared_noise.hpp"

namespace parkade {
namespace {

// By how much more a registration errs that overlaps at the edges of what both have seen: there
// pitch and roll move what a picture shows, all of it together.
double farFactor(const SemanticFrame& frame, const Submap& submap, const SE2& T_map_vehicle,
                 double doubling_distance) {
  const double distance = (T_map_vehicle * frame.labels.geometry.center - submap.middle()).norm();
  const double ratio = distance / doubling_distance;
  return 1.0 + ratio * ratio;
}

}  // namespace

void FusedMapper::Impl::addLoopEdge(const Stretch& stretch, const Registration& fit,
                                    const View& view) {
  if (!edges.empty() && edges.back().kind == EdgeKind::kLoop &&
      edges.back().from == stretch.anchor && edges.back().to == open().anchor) {
    return;  // one per pair of stretches
  }
  PoseGraphEdge edge;
  edge.from = stretch.anchor;
  edge.to = open().anchor;
  edge.kind = EdgeKind::kLoop;
  const SE2 T_open_vehicle = between(open().anchor, view);
  edge.T_from_to = (fit.T_map_vehicle * T_open_vehicle.inverse()).toSE3();
  // The registration's is of the vehicle's pose, the edge's of the anchor's.
  const Eigen::Matrix3d A = T_open_vehicle.inverse().adjoint();
  const Eigen::Matrix3d information = A.transpose() * fit.information * A;
  edge.information.setZero();
  constexpr int kAt[3] = {0, 1, 5};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      edge.information(kAt[i], kAt[j]) = 0.5 * (information(i, j) + information(j, i));
    }
  }
  edges.push_back(edge);
}

Registration FusedMapper::Impl::registerAround(const SemanticFrame& frame, const Submap& submap,
                                               const SE2& expected,
                                               const Eigen::Matrix4d& covariance,
                                               bool may_search) const {
  const double sigma = largestSigma(covariance.topLeftCorner<2, 2>());
  // Half of the narrowest slot is the distance at which rows look alike.
  constexpr double kCertain = 0.25;
  if (sigma < kCertain) {
    return registerFrame(frame, submap, expected, options.registration, viewpoints);
  }
  Registration fit;
  if (may_search) {
    const LoopResult loop =
        searchInSubmap(frame, submap, expected, sigma, std::sqrt(covariance(2, 2)), options.loop,
                       options.registration, viewpoints);
    fit = loop.registration;
    fit.accepted = loop.accepted;
    fit.reason = loop.reason;
  } else {
    fit.reason = "the pose is too uncertain";
  }
  return fit;
}

void FusedMapper::Impl::tryStretch(const SemanticFrame& frame, const View& view, std::size_t index,
                                   bool revisit) {
  const Stretch& stretch = stretches[index];
  // As the submap was drawn and this frame is: by cameras that were learned to be turned meanwhile.
  const SE2 T_anchor_drawn(stretch.rig_turn - frame.rig_turn, {0.0, 0.0});
  const SE2 expected = T_anchor_drawn * between(stretch.anchor, view);
  const Eigen::Matrix4d P = filter.relativeCovariance(stretch.anchor, view.anchor);
  const double sigma = largestSigma(P.topLeftCorner<2, 2>());
  // A submap of this passage knows nothing that the odometry did not see in the same pictures; its
  // own errors, which come again from picture to picture, would pull. It is for odometry that
  // fails.
  if (!revisit && sigma < options.submaps.passage_sigma_m) return;
  ++(revisit ? statistics.revisits : statistics.registrations);
  Registration fit = registerAround(frame, stretch.submap, expected, P, revisit);
  if (!fit.accepted) {
    logDebug("registration to stretch {}: {}", stretch.anchor, fit.reason);
    return;
  }
  const double far =
      farFactor(frame, stretch.submap, fit.T_map_vehicle, options.submaps.doubling_distance_m);
  fit.T_map_vehicle = T_anchor_drawn.inverse() * fit.T_map_vehicle;
  // All registrations to a submap share its error: together they may count it about once. Half the
  // number of those that follow at this spacing, for they do not share all of it.
  constexpr double kShared = 0.5;
  const double uses = std::max(1.0, kShared * (options.submaps.length_m + 5.0) /
                                        std::max(0.1, options.submaps.register_distance_m));
  const Eigen::Matrix3d information = withSharedNoise(
      fit.information,
      uses * sharedNoise(far * options.submaps.sigma_m, far * options.submaps.sigma_deg));
  const FilterUpdate update = filter.updateBetween(stretch.anchor, view.anchor, fit.T_map_vehicle,
                                                   information, options.submaps.gate_probability);
  if (!update.accepted) {
    ++statistics.refused_by_gate;
    return;
  }
  corrected = true;
  ++(revisit ? statistics.loops : statistics.accepted);
  if (!revisit) return;
  // Over the same ground the car stands as high as it did; only where it was near the anchor.
  constexpr double kSamePlace = 3.0;
  const double distance = fit.T_map_vehicle.translation().norm();
  if (distance < kSamePlace) {
    filter.updateHeight(stretch.anchor, 0.0, options.submaps.height_sigma_m + 0.01 * distance,
                        0.999, view.anchor);
  }
  addLoopEdge(stretch, fit, view);
}

void FusedMapper::Impl::readCompass(const SemanticFrame& frame, const View& view) {
  if (!options.compass.enable) return;
  const SE2 in_odometry = SE2::fromSE3(view.odometry.T_odom_vehicle);
  if (view.odometry.health != Health::kTracking) {
    rows.forget();
    compass_scatter.forget();
  }
  rows.add(frame, in_odometry, view.travelled);
  const double expected = poseOf(view).angle();
  const double axis_shift =
      axes < 0 ? 0.0 : wrapAngle(filter.anchor(axes).T_world_vehicle.angle() - axes_heading);
  const std::optional<double> heading = compass.read(frame, expected, view.travelled, axis_shift);
  const std::optional<double> axis = compass.axis();
  if (!axis) return;
  if (axes < 0) {
    axes = filter.addHeadingReference(options.compass.reference_sigma_deg * kDegree);
    axes_heading = filter.anchor(axes).T_world_vehicle.angle();
    axes_rig_turn = frame.rig_turn;
  }
  // Cameras that were learned to be turned since would turn all that is read.
  const double learned = frame.rig_turn - axes_rig_turn;
  if (heading) {
    const double read = *heading + learned;
    const std::optional<double> sigma = compass_scatter.add(read - in_odometry.angle());
    if (sigma) turnTo(read, *sigma, view);
  }
  const double drift = poseOf(view).angle() - in_odometry.angle();
  if (const std::optional<RowReading> row = rows.read(*axis + axis_shift - drift)) {
    turnTo(*axis + learned - row->direction + in_odometry.angle(), row->sigma, view);
  }
}

// The axes tell that the car of a view is headed so.
void FusedMapper::Impl::turnTo(double heading, double sigma, const View& view) {
  const FilterUpdate update = filter.updateTurn(axes, heading - axes_heading, sigma,
                                                options.submaps.gate_probability, view.anchor);
  if (!update.accepted) return;
  ++statistics.headings;
  corrected = true;
}

void FusedMapper::Impl::registerFrameToSubmaps(const SemanticFrame& frame, const View& view) {
  // The oldest stretch of this passage that still overlaps, and the nearest of an earlier one.
  std::optional<std::size_t> recent;
  std::optional<std::size_t> earlier;
  double nearest = 1e9;
  const Eigen::Vector2d& at = frame.labels.geometry.center;
  for (std::size_t i = 0; i + 1 < stretches.size(); ++i) {
    const Stretch& s = stretches[i];
    if (!filter.hasAnchor(s.anchor) || s.submap.frames() == 0) continue;
    const double age = view.travelled - s.end_m;
    if (age < options.submaps.min_age_m) continue;
    const Eigen::Vector2d p = between(s.anchor, view) * at;
    constexpr double kMargin = 3.0;
    if ((p - s.submap.low()).minCoeff() < -kMargin || (s.submap.high() - p).minCoeff() < -kMargin) {
      continue;
    }
    // Floors above and below: a revisit is at the same height.
    constexpr double kSameFloor = 1.5;
    if (std::abs(filter.anchor(s.anchor).z - filter.anchor(view.anchor).z) > kSameFloor) continue;
    if (age < options.submaps.revisit_age_m) {
      if (!recent) recent = i;
      continue;
    }
    const double distance = (p - s.submap.middle()).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    earlier = i;
  }
  if (recent) tryStretch(frame, view, *recent, false);
  if (earlier) tryStretch(frame, view, *earlier, true);
}

}  // namespace parkade
