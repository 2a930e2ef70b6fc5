// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "parkade/semantics/label_probe.hpp"
#include "parkade/semantics/slots/slot_clues.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"
#include "parkade/semantics/slots/slot_marks.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Side lines of one row: cosine of 6 degrees.
constexpr double kParallelSides = 0.9945;

/// Two marks that may be the entrance of a slot, left and right as who drives in sees them. Level
/// frame. The marks are those it was made of, which must outlive it.
struct SlotCandidate {
  const SlotMark* left = nullptr;
  const SlotMark* right = nullptr;
  Eigen::Vector2d inward = Eigen::Vector2d::UnitX();  ///< unit, along the sides
  SlotShape shape = SlotShape::kPerpendicular;
  SlotMarking marking = SlotMarking::kOpen;
  double depth = 0.0;  ///< m along inward; 0: not seen
  int turned_out = 0;  ///< sides whose meeting line runs only away from the other side
  bool mark_between = false;
  int ends_short = 0;    ///< sides that are seen to end before a slot's least depth
  SlotClues clues = {};  ///< slot_clues.hpp
  double doubt = 0.0;    ///< what other candidates say against it
  double score = 0.0;    ///< log-odds
  std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                            Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};

  [[nodiscard]] Eigen::Vector2d front() const { return right->p - left->p; }
  /// A side of it is too worn for labels (slot_rows.hpp).
  [[nodiscard]] bool isFaint() const { return left->isFaint() || right->isFaint(); }
  /// m, between the side lines.
  [[nodiscard]] double width() const;
  /// m, of the corners: as seen, or as others have it.
  [[nodiscard]] double length() const { return (corners[3] - corners[0]).norm(); }
  /// Sets the corners; usual (m) is the depth where none was seen.
  void complete(double usual);
};

/// The point at shares of a slot's front (from its left) and of its depth.
inline Eigen::Vector2d pointIn(const std::array<Eigen::Vector2d, 4>& corners, double across,
                               double deep) {
  const Eigen::Vector2d front = (1.0 - across) * corners[0] + across * corners[1];
  const Eigen::Vector2d rear = (1.0 - across) * corners[3] + across * corners[2];
  return (1.0 - deep) * front + deep * rear;
}

/// All pairs of marks that have a slot's size and contradict none: no side as plain as theirs
/// between them (along the aisle: none at all), lines that meet them along the entrance within a
/// tolerance by their length, sides that do not both end alike too early; faint lines make slots of
/// their row's width. Clues and score are not set yet (slot_ranking.hpp).
std::vector<SlotCandidate> pairSlotMarks(const std::vector<SlotMark>& marks,
                                         const LabelProbe& probe, const SlotOptions& options);

}  // namespace parkade
