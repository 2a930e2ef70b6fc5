// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kSquare = 0.1392;      // cosine of 82 degrees: what is nearer to 90 is square
constexpr double kMostSlant = 0.89;     // cosine of 27 degrees
constexpr double kAlongFront = 0.1745;  // rad, 10 degrees
constexpr double kSideBySide = 0.1047;  // rad, 6 degrees
constexpr double kMostOff = 0.45;       // rad, however short
constexpr double kPlainSide = 0.8;      // m of a side in sight
constexpr double kShortAcross = 0.9;    // m of a line that meets a side
constexpr double kEndOff = 0.06;  // m, of a piece of line: short ones know their direction badly

// How far (rad) the direction of a line may be off of which so much (m) is seen.
double allowedAngle(double usual, double seen) {
  constexpr double kShortest = 0.1;  // m
  return std::min(usual + kEndOff / std::max(seen, kShortest), kMostOff);
}

class MarkPairing {
 public:
  MarkPairing(const std::vector<SlotMark>& marks, const LabelProbe& probe,
              const SlotOptions& options)
      : marks_(marks), probe_(probe), options_(options) {}

  std::vector<SlotCandidate> pairs() {
    for (const SlotMark& left : marks_) {
      for (const SlotMark& right : marks_) {
        if (std::optional<SlotCandidate> candidate = pair(left, right)) {
          candidates_.push_back(*candidate);
        }
      }
    }
    completeDepths();
    return std::move(candidates_);
  }

 private:
  [[nodiscard]] std::optional<SlotCandidate> pair(const SlotMark& left,
                                                  const SlotMark& right) const {
    if (left.side == right.side || !runSideBySide(left, right)) return std::nullopt;
    SlotCandidate c;
    c.left = &left;
    c.right = &right;
    constexpr double kBar = 0.1;  // m: bars know their sides' direction, too
    c.inward =
        (std::max(left.visible, kBar) * left.inward + std::max(right.visible, kBar) * right.inward)
            .normalized();
    const Vector2d front = right.p - left.p;
    const double length = front.norm();
    // Left of who drives in is left of inward.
    const double width = cross(c.inward, -front);
    if (width <= 0.0) return std::nullopt;
    if (!fitsRow(left, length) || !fitsRow(right, length)) return std::nullopt;
    const double cosine = std::abs(front.dot(c.inward)) / length;
    if (cosine > kMostSlant) return std::nullopt;
    const bool is_plain = std::max(left.visible, right.visible) >= kPlainSide && cosine <= kSquare;
    for (const SlotMark* mark : {&left, &right}) {
      // A short piece of line, or what passes for one, knows its direction less well than sides.
      const bool may_cross = is_plain && mark->across_length < kShortAcross;
      if (!may_cross && crossesFront(*mark, front)) return std::nullopt;
    }
    c.shape = cosine > kSquare ? SlotShape::kSlanted : SlotShape::kPerpendicular;
    if (width < options_.min_width_m || width > options_.max_width_m) {
      if (c.shape == SlotShape::kSlanted || length < options_.min_parallel_length_m ||
          length > options_.max_parallel_length_m) {
        return std::nullopt;
      }
      c.shape = SlotShape::kParallel;
    }
    const double between = sideBetween(c);
    c.mark_between = between >= 0.0;
    if (c.mark_between && c.shape == SlotShape::kParallel) return std::nullopt;
    if (between > 0.9 * std::min(left.visible, right.visible)) return std::nullopt;
    c.turned_out = turnedOut(c);
    if (!measureDepth(c)) return std::nullopt;
    tellMarking(c);
    // A worn line by itself is hardly a side where the entrance does not show.
    const bool shows = c.marking == SlotMarking::kClosed || c.marking == SlotMarking::kT;
    if ((left.is_lone || right.is_lone) && !shows) return std::nullopt;
    return c;
  }

  [[nodiscard]] static bool runSideBySide(const SlotMark& left, const SlotMark& right) {
    // What is seen of a mark's direction: without a side the length of the line that is seen.
    const auto seen = [](const SlotMark& mark) {
      return mark.isSideless() ? mark.across_length : mark.visible;
    };
    const double shorter = std::min(seen(left), seen(right));
    return left.inward.dot(right.inward) > std::cos(allowedAngle(kSideBySide, shorter));
  }

  // Whether a line that meets the side runs elsewhere than along the entrance.
  [[nodiscard]] static bool crossesFront(const SlotMark& mark, const Vector2d& front) {
    if (mark.across.isZero()) return false;
    const double allowed = allowedAngle(kAlongFront, mark.across_length);
    return std::abs(cross(mark.across, front)) > std::sin(allowed) * front.norm();
  }

  // Faint lines make slots as wide as the others of their row.
  [[nodiscard]] static bool fitsRow(const SlotMark& mark, double length) {
    constexpr double kSame = 0.12;  // m
    return !mark.isFaint() || std::abs(length - mark.row_width) < kSame;
  }

  // Where a line meets a side at the entrance, it runs (or its bar points) towards the other side:
  // how often it does not.
  [[nodiscard]] int turnedOut(const SlotCandidate& c) const {
    const Vector2d u = (c.right->p - c.left->p).normalized();
    constexpr double kLook = 0.5;  // m: bars are short, worn lines have holes
    constexpr double kPaint = 0.25;
    const auto turnsIn = [&](const SlotMark& mark, double sign) {
      if (mark.across.isZero()) return true;
      const double from = 0.5 * mark.width + 0.04;
      const LabelProbe::Shares seen =
          probe_.along(mark.p + sign * from * u, mark.p + sign * kLook * u, 0.04);
      return seen.paint + seen.hidden > kPaint;
    };
    return (turnsIn(*c.left, 1.0) ? 0 : 1) + (turnsIn(*c.right, -1.0) ? 0 : 1);
  }

  // How much is seen (m) of another side between the two, at most; less than 0: there is none. It
  // would make them no neighbours.
  [[nodiscard]] double sideBetween(const SlotCandidate& c) const {
    const Vector2d front = c.right->p - c.left->p;
    const double length = front.norm();
    constexpr double kOff = 0.4;
    double seen = -1.0;
    for (const SlotMark& mark : marks_) {
      if (mark.inward.dot(c.inward) < kParallelSides) continue;
      const double s = (mark.p - c.left->p).dot(front) / length;
      if (s < kOff || s > length - kOff) continue;
      if (std::abs(cross(front, mark.p - c.left->p)) > kOff * length) continue;
      seen = std::max(seen, mark.visible);
    }
    return seen;
  }

  // From rear corners, or from where side lines end. False where they contradict a slot.
  [[nodiscard]] bool measureDepth(SlotCandidate& c) const {
    const bool parallel = c.shape == SlotShape::kParallel;
    const double least = parallel ? options_.min_parallel_depth_m : options_.min_depth_m;
    const double most = parallel ? options_.max_parallel_depth_m : options_.max_depth_m;
    std::array<double, 2> ends{};
    std::array<double, 2> early{};
    int seen = 0;
    for (int k = 0; k < 2; ++k) {
      const SlotMark& front = k == 0 ? *c.left : *c.right;
      double best = 0.0;
      double& ended = early[static_cast<std::size_t>(k)];
      for (const SlotMark& mark : marks_) {
        if (mark.side != front.side || mark.inward.dot(front.inward) > -kParallelSides) continue;
        const double depth = (mark.p - front.p).dot(c.inward);
        if (depth >= least && depth <= most && (best == 0.0 || depth < best)) best = depth;
        if (depth > ended && depth < least && endsFor(front, depth, least)) ended = depth;
      }
      ends[static_cast<std::size_t>(k)] = best;
      if (best > 0.0) ++seen;
      if (ended > 0.0) ++c.ends_short;
    }
    if (seen == 2) {
      constexpr double kSame = 0.25;
      if (std::abs(ends[0] - ends[1]) < kSame) c.depth = 0.5 * (ends[0] + ends[1]);
    }
    if (parallel && std::min(c.left->visible, c.right->visible) > most + 0.3) return false;
    // One alone may be worn or in the dark, and two where they end apart.
    constexpr double kAlike = 0.4;
    const bool both = c.ends_short == 2 && std::abs(early[0] - early[1]) < kAlike;
    return !both || c.depth > 0.0;
  }

  // Whether a side line goes on nowhere between a place on it and a slot's least depth: a line that
  // short belongs to no such slot. Worn ones go on.
  [[nodiscard]] bool endsFor(const SlotMark& front, double depth, double least) const {
    constexpr double kStart = 0.3;  // m
    constexpr double kLeast = 1.0;  // m: far from the car lines fade a little before their end
    if (least - depth < kLeast) return false;
    const LabelProbe::Shares rest = probe_.along(front.p + (depth + kStart) * front.inward,
                                                 front.p + least * front.inward, 0.08);
    return rest.floor > 0.9 && !isFaintLine(front, depth + kStart, least);
  }

  // Whether a side line is held for one, on average from one distance to another, where it is no
  // longer labelled so.
  [[nodiscard]] bool isFaintLine(const SlotMark& front, double from, double to) const {
    constexpr double kBare = -5.0;  // log-odds
    const double step = probe_.labels().geometry.metres_per_px;
    const Vector2d aside = step * Vector2d(-front.inward.y(), front.inward.x());
    double sum = 0.0;
    int count = 0;
    for (double d = from; d <= to; d += step) {
      const Vector2d p = front.p + d * front.inward;
      if (probe_.at(p) != SemanticClass::kFloor) continue;
      sum += std::max(
          {probe_.slotEvidence(p), probe_.slotEvidence(p + aside), probe_.slotEvidence(p - aside)});
      ++count;
    }
    return count > 0 && sum > kBare * count;
  }

  void tellMarking(SlotCandidate& c) const {
    const Vector2d front = c.right->p - c.left->p;
    const double length = front.norm();
    const Vector2d u = front / length;
    constexpr double kPastBar = 0.5;
    const auto bar = [&](const SlotMark& mark, double sign) {
      const double from = 0.5 * mark.width + 0.04;
      return probe_.along(mark.p + sign * from * u, mark.p + sign * (from + 0.14) * u, 0.04).paint >
             0.6;
    };
    const double middle =
        probe_.along(c.left->p + kPastBar * u, c.right->p - kPastBar * u, 0.04).paint;
    const bool inner = bar(*c.left, 1.0) || bar(*c.right, -1.0);
    const bool outer = bar(*c.left, -1.0) || bar(*c.right, 1.0);
    if (middle > 0.5) {
      c.marking = SlotMarking::kClosed;
    } else if (inner) {
      c.marking = outer ? SlotMarking::kT : SlotMarking::kL;
    }
  }

  // Slots of one garage are alike: the middle of what is seen serves where a rear is hidden.
  void completeDepths() {
    for (const SlotShape shape :
         {SlotShape::kPerpendicular, SlotShape::kParallel, SlotShape::kSlanted}) {
      std::vector<double> depths;
      for (const SlotCandidate& c : candidates_) {
        if (c.shape == shape && c.depth > 0.0) depths.push_back(c.depth);
      }
      double usual =
          shape == SlotShape::kParallel ? options_.usual_parallel_depth_m : options_.usual_depth_m;
      if (!depths.empty()) usual = median(std::move(depths));
      for (SlotCandidate& c : candidates_) {
        if (c.shape != shape) continue;
        // Sides may be seen further than that.
        const bool parallel = shape == SlotShape::kParallel;
        const double most = parallel ? options_.max_parallel_depth_m : options_.max_depth_m;
        const double seen = std::min(std::max(c.left->visible, c.right->visible), most);
        c.complete(std::max(usual, seen));
      }
    }
  }

  const std::vector<SlotMark>& marks_;
  const LabelProbe& probe_;
  const SlotOptions& options_;
  std::vector<SlotCandidate> candidates_;
};

}  // namespace

double SlotCandidate::width() const {
  return std::abs(cross(inward, front()));
}

void SlotCandidate::complete(double usual) {
  const double d = depth > 0.0 ? depth : usual;
  corners = {left->p, right->p, right->p + d * inward, left->p + d * inward};
}

std::vector<SlotCandidate> pairSlotMarks(const std::vector<SlotMark>& marks,
                                         const LabelProbe& probe, const SlotOptions& options) {
  return MarkPairing(marks, probe, options).pairs();
}

}  // namespace parkade
