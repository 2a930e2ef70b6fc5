// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_extraction.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/semantics/label_probe.hpp"
#include "parkade/semantics/slots/slot_candidates.hpp"
#include "parkade/semantics/slots/slot_marks.hpp"
#include "parkade/semantics/slots/slot_occupancy.hpp"
#include "parkade/semantics/slots/slot_ranking.hpp"
#include "parkade/semantics/slots/slot_rows.hpp"
#include "parkade/semantics/standing/tilt_error.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

Eigen::Matrix4d covarianceOf(const SlotCandidate& c, const BevGeometry& geometry,
                             const BevViews& views, const FloorSigma& sigma) {
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> J;
  for (int k = 0; k < 2; ++k) {
    const SlotMark& mark = k == 0 ? *c.left : *c.right;
    const BevViews::View& view = views.viewAt(geometry, mark.p);
    const Vector2d ray = mark.p - view.foot;
    J.block<2, 2>(2 * k, 0) = sigma.attitude * groundTiltJacobian(ray, view.height);
    J.block<2, 1>(2 * k, 2) = sigma.height / view.height * ray;
    const Vector2d n(-mark.inward.y(), mark.inward.x());
    covariance.block<2, 2>(2 * k, 2 * k) =
        mark.sigma_along * mark.sigma_along * mark.inward * mark.inward.transpose() +
        mark.sigma_aside * mark.sigma_aside * n * n.transpose();
  }
  return covariance + J * J.transpose();
}

SlotObservation observe(const SlotCandidate& c, const LabelProbe& probe, const BevViews& views,
                        const FloorSigma& sigma) {
  SlotObservation slot;
  slot.corners = c.corners;
  slot.entrance_covariance = covarianceOf(c, probe.labels().geometry, views, sigma);
  slot.rear_seen = c.depth > 0.0;
  slot.shape = c.shape;
  slot.marking = c.marking;
  slot.confidence = 1.0 / (1.0 + std::exp(-c.score));
  slot.probability_free = probabilityFree(probe, views, c.corners);
  slot.seen_over_entrance = shareSeenOverEntrance(probe.labels().geometry, views, c.corners);
  return slot;
}

// As they are decided on: of the rows those with faint marks.
void addTrials(const std::vector<SlotCandidate>& candidates,
               const std::vector<SlotCandidate>& in_rows, std::vector<SlotTrial>& trials) {
  const auto add = [&trials](const SlotCandidate& c) {
    trials.push_back({c.left->p, c.right->p, c.clues, c.doubt});
  };
  for (const SlotCandidate& c : candidates) add(c);
  for (const SlotCandidate& c : in_rows) {
    if (c.isFaint()) add(c);
  }
}

}  // namespace

std::vector<SlotObservation> extractSlots(const BevImage& bev, const BevLabels& labels,
                                          const std::vector<LineSegment>& segments,
                                          const BevViews& views, const FloorSigma& sigma,
                                          const SlotOptions& options,
                                          std::vector<SlotTrial>* trials) {
  PARKADE_CHECK(bev.image.size() == labels.labels.size(),
                "a picture of {} x {} pixels, labels of {} x {}", bev.image.cols, bev.image.rows,
                labels.labels.cols, labels.labels.rows);
  cv::Mat grey = bev.image;
  if (bev.image.channels() == 3) cv::cvtColor(bev.image, grey, cv::COLOR_BGR2GRAY);
  const LabelProbe probe(labels);
  const std::vector<SlotMark> marks = findSlotMarks(grey, probe, segments);
  std::vector<SlotCandidate> candidates = pairSlotMarks(marks, probe, options);
  std::vector<const SlotCandidate*> likely =
      likelySlots(candidates, probe, views, options.min_confidence);
  // The rows of these slots, and sides by themselves, with lines that are too worn for labels.
  std::vector<SlotMark> all = marks;
  for (const SlotMark& mark : findFaintMarks(labels, likely, marks, options.min_faint_contrast)) {
    all.push_back(mark);
  }
  for (const SlotMark& mark : findLoneMarks(labels, likely, all, options.min_lone_contrast)) {
    all.push_back(mark);
  }
  std::vector<SlotCandidate> in_rows;
  if (all.size() > marks.size()) {
    in_rows = pairSlotMarks(all, probe, options);
    for (const SlotCandidate* slot : likelySlots(in_rows, probe, views, options.min_confidence)) {
      if (slot->isFaint()) likely.push_back(slot);
    }
    likely = withoutOverlaps(std::move(likely));
  }
  if (trials != nullptr) addTrials(candidates, in_rows, *trials);
  std::vector<SlotObservation> slots;
  for (const SlotCandidate* slot : likely) slots.push_back(observe(*slot, probe, views, sigma));
  return slots;
}

}  // namespace parkade
