// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_ranking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/slots/slot_clues.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

// Share of a's area that lies in b, from a grid of points.
double shareInside(const std::array<Vector2d, 4>& a, const std::array<Vector2d, 4>& b) {
  constexpr int kSteps = 8;
  int inside = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double s = (i + 0.5) / kSteps;
      const double t = (j + 0.5) / kSteps;
      if (contains(b, pointIn(a, s, t))) ++inside;
    }
  }
  return static_cast<double>(inside) / (kSteps * kSteps);
}

class SlotRanking {
 public:
  SlotRanking(std::vector<SlotCandidate>& candidates, const LabelProbe& probe,
              const BevViews& views, double min_confidence)
      : candidates_(candidates), probe_(probe), views_(views), min_confidence_(min_confidence) {}

  std::vector<const SlotCandidate*> likely() {
    measureSlotClues(probe_, views_, candidates_);
    for (SlotCandidate& candidate : candidates_) candidate.score = slotLogOdds(candidate.clues);
    weighAgainstOthers();
    return choose();
  }

 private:
  // What the other candidates say against each one.
  void weighAgainstOthers() {
    constexpr double kMost = 6.0;
    std::vector<double> doubts;
    for (const SlotCandidate& c : candidates_) {
      double doubt = 0.0;
      for (const SlotCandidate& other : candidates_) doubt += doubtBy(c, other);
      doubts.push_back(std::min(doubt + doubtOfWidth(c), kMost));
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      candidates_[i].doubt = doubts[i];
      candidates_[i].score -= slotDoubtWeight() * doubts[i];
    }
  }

  // Whether a candidate speaks against others.
  [[nodiscard]] static bool isWitness(const SlotCandidate& c) {
    constexpr double kSure = 1.0;  // log-odds
    return c.score >= kSure && c.shape != SlotShape::kParallel;
  }

  // What borders on a likelier perpendicular slot is hardly a parallel one, and the entrances of
  // slots that share a line lie in one line.
  [[nodiscard]] static double doubtBy(const SlotCandidate& c, const SlotCandidate& other) {
    if (!isWitness(other)) return 0.0;
    const bool share = other.right == c.left || other.left == c.right;
    if (c.shape == SlotShape::kParallel && share && other.score > c.score) return 3.0;
    if (other.score > c.score && liesAcross(c, other)) return 3.0;
    if (std::abs(other.inward.dot(c.inward)) < kParallelSides) return 0.0;
    return share && other.score > c.score && !inLine(c, other) ? 2.0 : 0.0;
  }

  // Beside a pillar the gap between two slots is easily taken into one of them: the line between is
  // hidden or worn. Where others are narrower, a wide one is doubtful, less so if the place of that
  // line is seen to be bare, and not if its front is painted all along, nor if it is but for little
  // and ends at both corners, or at one of them where a neighbour begins at the other: nothing was
  // taken into it then.
  [[nodiscard]] double doubtOfWidth(const SlotCandidate& c) const {
    constexpr double kWider = 0.35;  // m
    constexpr double kBare = 2.0;
    constexpr double kNotBare = 5.0;
    constexpr double kPaintedAlong = 0.9;
    if (c.shape == SlotShape::kParallel) return 0.0;
    bool is_wider = false;
    bool is_bare = true;
    for (const SlotCandidate& other : candidates_) {
      if (!isWitness(other)) continue;
      if (std::abs(other.inward.dot(c.inward)) < kParallelSides) continue;
      if (c.width() - other.width() <= kWider) continue;
      is_wider = true;
      is_bare = is_bare && isBareAt(c, other.width());
    }
    // Across the gap beside a pillar no front goes on.
    if (!is_wider || paintOfFront(c) > kPaintedAlong || frontEnds(c)) return 0.0;
    return is_bare ? kBare : kNotBare;
  }

  // Whether a side line of c begins at a corner of the other's entrance and runs along that one.
  [[nodiscard]] static bool liesAcross(const SlotCandidate& c, const SlotCandidate& other) {
    constexpr double kNear = 0.4;  // m
    constexpr double kAcross = 0.5;
    if (std::abs(c.inward.dot(other.inward)) > kAcross) return false;
    const auto meet = [](const SlotMark* a, const SlotMark* b) {
      return (a->p - b->p).norm() < kNear;
    };
    return meet(c.left, other.left) || meet(c.left, other.right) || meet(c.right, other.left) ||
           meet(c.right, other.right);
  }

  [[nodiscard]] static bool inLine(const SlotCandidate& c, const SlotCandidate& other) {
    constexpr double kStraight = 0.9903;  // cosine of 8 degrees
    const Vector2d a = c.front().normalized();
    return a.dot(other.front().normalized()) > kStraight;
  }

  // Whether the front is painted all along and ends at both corners, or at one of them and at the
  // other a neighbour begins.
  [[nodiscard]] bool frontEnds(const SlotCandidate& c) const {
    constexpr double kPainted = 0.8;
    constexpr double kBare = 0.9;
    constexpr double kPast = 0.15;  // m from a corner
    constexpr double kFar = 0.55;
    const Vector2d u = c.front().normalized();
    const Vector2d left = c.left->p;
    const Vector2d right = c.right->p;
    if (paintOfFront(c) <= kPainted) return false;
    const bool ends_left = probe_.along(left - kPast * u, left - kFar * u).floor > kBare;
    const bool ends_right = probe_.along(right + kPast * u, right + kFar * u).floor > kBare;
    const auto neighbour = [&](const auto& shares) {
      return std::any_of(candidates_.begin(), candidates_.end(), [&](const SlotCandidate& other) {
        return shares(other) && other.score > 0.0 && other.inward.dot(c.inward) > kParallelSides;
      });
    };
    return (ends_left || neighbour([&](const auto& other) { return other.right == c.left; })) &&
           (ends_right || neighbour([&](const auto& other) { return other.left == c.right; })) &&
           (ends_left || ends_right);
  }

  // Share of what is seen, from corner to corner; 0 where that is less than half.
  [[nodiscard]] double paintOfFront(const SlotCandidate& c) const {
    constexpr double kInside = 0.15;  // m from a corner
    const Vector2d inside = kInside * c.front().normalized();
    const LabelProbe::Shares front = probe_.along(c.left->p + inside, c.right->p - inside);
    const double seen = front.paint + front.floor;
    return seen > 0.5 ? front.paint / seen : 0.0;
  }

  // Whether both places of a side line that would leave a slot of this width hold nothing but
  // floor.
  [[nodiscard]] bool isBareAt(const SlotCandidate& c, double width) const {
    const Vector2d front = c.front() * (width / c.width());
    constexpr double kFrom = 0.1;
    constexpr double kTo = 1.0;
    constexpr double kBare = 0.9;
    const auto bare = [&](const Vector2d& p) {
      return probe_.along(p + kFrom * c.inward, p + kTo * c.inward, 0.12).floor > kBare;
    };
    return bare(c.left->p + front) && bare(c.right->p - front);
  }

  [[nodiscard]] std::vector<const SlotCandidate*> choose() const {
    std::vector<const SlotCandidate*> order;
    const double least = std::log(min_confidence_ / (1.0 - min_confidence_));
    for (const SlotCandidate& c : candidates_) {
      if (c.score >= least) order.push_back(&c);
    }
    return withoutOverlaps(std::move(order));
  }

  std::vector<SlotCandidate>& candidates_;
  const LabelProbe& probe_;
  const BevViews& views_;
  double min_confidence_;
};

}  // namespace

std::vector<const SlotCandidate*> withoutOverlaps(std::vector<const SlotCandidate*> slots) {
  std::stable_sort(slots.begin(), slots.end(), [](const SlotCandidate* a, const SlotCandidate* b) {
    return a->score > b->score;
  });
  std::vector<const SlotCandidate*> chosen;
  for (const SlotCandidate* c : slots) {
    constexpr double kOverlap = 0.25;
    const bool taken = std::any_of(chosen.begin(), chosen.end(), [&](const SlotCandidate* other) {
      return shareInside(c->corners, other->corners) > kOverlap ||
             shareInside(other->corners, c->corners) > kOverlap;
    });
    if (!taken) chosen.push_back(c);
  }
  return chosen;
}

std::vector<const SlotCandidate*> likelySlots(std::vector<SlotCandidate>& candidates,
                                              const LabelProbe& probe, const BevViews& views,
                                              double min_confidence) {
  return SlotRanking(candidates, probe, views, min_confidence).likely();
}

}  // namespace parkade
