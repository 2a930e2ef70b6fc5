// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/row_splitting.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "parkade/mapping/slots/row_pattern.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;

class SlotSplitter {
 public:
  SlotSplitter(const LayeredGrid& grid, const SlotLikelihood& likelihood,
               const RowCompletionOptions& options)
      : grid_(grid), likelihood_(likelihood), options_(options) {}

  /// The slots that stand in place of one member of a row; none where they are not likely.
  [[nodiscard]] std::vector<MapSlot> split(const Row& row, const Member& member,
                                           const MapSlot& slot, const Pattern& pattern) const {
    const double length = member.end - member.begin;
    const int count = static_cast<int>(std::lround(length / pattern.front));
    const double rest = length - count * pattern.front;
    const double depth = pattern.side.norm();
    const double depth_told = (slot.corners[3] - slot.corners[0]).norm();
    if (count < 2 || std::abs(rest) > options_.fit_m || depth < depth_told + kLeastBeyond ||
        hasRearLine(slot)) {
      return {};
    }
    std::vector<MapSlot> parts;
    std::vector<SlotEvidence> evidence;
    for (int i = 0; i < count; ++i) {
      const Vector2d left = row.at(member.begin + i * length / count);
      const Vector2d right = row.at(member.begin + (i + 1) * length / count);
      parts.push_back(unseenSlot(pattern, left, right, slot, options_.corner_sigma_m));
      evidence.push_back(gatherEvidence(grid_, parts.back().corners));
      if (isDenied(evidence.back())) return {};
      setFree(evidence.back(), parts.back());
    }
    const double log_odds = lengthLogOdds(rest) + betweenLogOdds(evidence) +
                            beyondLogOdds(row, member, pattern, depth_told);
    if (log_odds < options_.min_log_odds) return {};
    return parts;
  }

 private:
  static constexpr double kLeastBeyond = 0.8;  // m that the slots are deeper

  static double lengthLogOdds(double rest) {
    constexpr double kSigma = 0.12;    // m, of a length told
    constexpr double kPerMetre = 0.4;  // density of the lengths of slots along the aisle
    const double fits =
        std::exp(-0.5 * rest * rest / (kSigma * kSigma)) / (kSigma * std::sqrt(2.0 * EIGEN_PI));
    return std::log(fits / kPerMetre);
  }

  // The lines between the parts, and whether a car covers one part and none the next: a car along
  // the aisle covers all of them alike.
  [[nodiscard]] double betweenLogOdds(const std::vector<SlotEvidence>& evidence) const {
    constexpr double kParked = 0.35;  // of what is seen
    constexpr double kEmpty = 0.1;
    constexpr double kSeen = 0.3;  // of a part
    constexpr double kUneven = 2.3;
    double sum = 0.0;
    bool is_uneven = false;
    for (std::size_t i = 0; i + 1 < evidence.size(); ++i) {
      const SlotEvidence& a = evidence[i];
      const SlotEvidence& b = evidence[i + 1];
      sum += likelihood_.side(a.right);
      if (std::min(a.seen, b.seen) < kSeen) continue;
      is_uneven = is_uneven || (std::max(a.vehicle, b.vehicle) > kParked &&
                                std::min(a.vehicle, b.vehicle) < kEmpty);
    }
    return sum + (is_uneven ? kUneven : 0.0);
  }

  // Sides that go on deeper than the slot told.
  [[nodiscard]] double beyondLogOdds(const Row& row, const Member& member, const Pattern& pattern,
                                     double depth_told) const {
    constexpr double kPast = 0.15;       // m, a rear line's half width and its error
    constexpr double kStructure = 0.05;  // a wall or pillars close the slot told
    constexpr double kDenied = -10.0;
    const Vector2d inward = pattern.side.normalized();
    const Vector2d left = row.at(member.begin) + (depth_told + kPast) * inward;
    const Vector2d right = row.at(member.end) + (depth_told + kPast) * inward;
    const Vector2d deep = pattern.side - (depth_told + kPast) * inward;
    const SlotEvidence beyond = gatherEvidence(grid_, {left, right, right + deep, left + deep});
    if (beyond.structure_inside > kStructure) return kDenied;
    return likelihood_.side(beyond.left) + likelihood_.side(beyond.right);
  }

  // A line along the rear of what was told would cross the parts: a slot into another row, read
  // from its side, has one.
  [[nodiscard]] bool hasRearLine(const MapSlot& slot) const {
    const auto& c = slot.corners;
    return likelihood_.entrance(gatherEvidence(grid_, {c[3], c[2], c[1], c[0]}).entrance) > 0.0;
  }

  const LayeredGrid& grid_;
  const SlotLikelihood& likelihood_;
  const RowCompletionOptions& options_;
};

}  // namespace

std::vector<std::size_t> splitSlots(std::vector<MapSlot>& slots,
                                    const std::vector<Vector2d>& pillars, const LayeredGrid& grid,
                                    const SlotLikelihood& likelihood,
                                    const RowCompletionOptions& options) {
  const SlotSplitter splitter(grid, likelihood, options);
  const std::vector<Row> rows = findRows(slots);
  const std::vector<std::vector<Pattern>> patterns = findPatterns(rows, slots, pillars);
  std::vector<std::size_t> replaced;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const Member& member : rows[r].members) {
      const MapSlot slot = slots[member.slot];
      if (slot.shape != SlotShape::kParallel) continue;
      for (const Pattern& pattern : patterns[r]) {
        if (pattern.shape != SlotShape::kPerpendicular || !pattern.of_row) continue;
        const std::vector<MapSlot> parts = splitter.split(rows[r], member, slot, pattern);
        if (parts.empty()) continue;
        slots.insert(slots.end(), parts.begin(), parts.end());
        replaced.push_back(member.slot);
        break;
      }
    }
  }
  std::sort(replaced.begin(), replaced.end());  // rows come in any order
  return replaced;
}

}  // namespace parkade::slot_rows
