// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_ranking.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "parkade/geometry/planar.hpp"

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
      const Vector2d p =
          (1.0 - t) * ((1.0 - s) * a[0] + s * a[1]) + t * ((1.0 - s) * a[3] + s * a[2]);
      if (contains(b, p)) ++inside;
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
    for (SlotCandidate& candidate : candidates_) candidate.score = score(candidate);
    weighAgainstOthers();
    return choose();
  }

 private:
  [[nodiscard]] double score(const SlotCandidate& c) const {
    const Vector2d u = c.front().normalized();
    const double length = c.front().norm();
    Vector2d ahead(-u.y(), u.x());
    if (ahead.dot(c.inward) > 0.0) ahead = -ahead;
    const LabelProbe::Shares way = wayInFront(c, u, ahead);
    const double seen_sides = std::min(2.0, 0.5 * (c.left->visible + c.right->visible));
    const Vector2d to_car = probe_.labels().geometry.center - 0.5 * (c.left->p + c.right->p);
    const double facing = to_car.dot(ahead) / std::max(1.0, to_car.norm());
    const LabelProbe::Shares entrance = probe_.along(c.left->p + 0.3 * u, c.right->p - 0.3 * u);
    double s = -1.0 + seen_sides + 2.0 * way.floor - 12.0 * way.paint - 10.0 * paintAcross(c);
    s += (facing > 0.0 ? 1.5 : 3.0) * std::clamp(2.0 * facing, -1.0, 1.0);
    s -= 2.0 * entrance.hidden;
    s -= 20.0 * laneLineAlong(c);
    if (goesOnAsLaneLine(*c.left) || goesOnAsLaneLine(*c.right)) s -= 4.0;
    switch (c.marking) {
      case SlotMarking::kClosed:
      case SlotMarking::kT:
        s += 1.0;
        break;
      case SlotMarking::kL:
        s += 0.7;
        break;
      case SlotMarking::kOpen:
        break;
    }
    if (hasWheelStopInFront(c)) s -= 6.0;
    if (liesBesideTheWay(c)) s -= 1.5;
    if (c.depth > 0.0) s += 0.5;
    // Long and narrow ones are entered from the long side.
    if (c.shape == SlotShape::kPerpendicular && c.depth > 2.45 * length) s -= 1.5;
    if (c.shape == SlotShape::kSlanted && c.marking != SlotMarking::kClosed && neighbours(c) == 0.0)
      s -= 1.5;
    if (c.shape == SlotShape::kParallel && length < 2.45 * c.length()) s -= 2.0;
    s += neighbours(c);
    if (s > 0.0 && hasPillarInside(c)) s -= 5.0;
    return s;
  }

  // Room to drive: floor, arrows, lane lines; no slot lines, no wall. u: along the entrance.
  [[nodiscard]] LabelProbe::Shares wayInFront(const SlotCandidate& c, const Vector2d& u,
                                              const Vector2d& ahead) const {
    LabelProbe::Shares way;
    double rows = 0.0;
    for (double d = 0.4; d < 2.6; d += 0.2) {
      const LabelProbe::Shares one =
          probe_.along(c.left->p + d * ahead + 0.25 * u, c.right->p + d * ahead - 0.25 * u);
      way.floor += one.floor;
      way.paint += one.paint;
      rows += 1.0;
    }
    way.floor /= rows;
    way.paint /= rows;
    return way;
  }

  // The largest share of paint on a line through the slot, along it or across: there is none.
  [[nodiscard]] double paintAcross(const SlotCandidate& c) const {
    double most = 0.0;
    for (const double a : {0.3, 0.5, 0.7}) {
      const Vector2d p = (1.0 - a) * c.corners[0] + a * c.corners[1];
      const Vector2d q = (1.0 - a) * c.corners[3] + a * c.corners[2];
      most = std::max(most, probe_.along(p + 0.1 * (q - p), p + 0.8 * (q - p)).paint);
    }
    for (const double b : {0.2, 0.35, 0.5, 0.65}) {
      const Vector2d p = (1.0 - b) * c.corners[0] + b * c.corners[3];
      const Vector2d q = (1.0 - b) * c.corners[1] + b * c.corners[2];
      most = std::max(most, probe_.along(p + 0.1 * (q - p), p + 0.9 * (q - p)).paint);
    }
    return most;
  }

  // Wheels stop at the rear: what has one behind its first line is seen from there.
  [[nodiscard]] bool hasWheelStopInFront(const SlotCandidate& c) const {
    constexpr double kFrom = 0.2;  // of the slot's depth
    constexpr double kTo = 0.3;
    int stops = 0;
    int samples = 0;
    for (double b = 0.04; b < kTo; b += 0.02) {
      for (double a = kFrom; a <= 1.0 - kFrom; a += 0.05) {
        const Vector2d p = (1.0 - a) * c.corners[0] + a * c.corners[1];
        const Vector2d q = (1.0 - a) * c.corners[3] + a * c.corners[2];
        if (probe_.at((1.0 - b) * p + b * q) == SemanticClass::kWheelStop) ++stops;
        ++samples;
      }
    }
    return stops > samples / 40;
  }

  // Whether the foot of a pillar is seen between the sides, where the way in leads: of what stands
  // upright only the edge towards the camera lies on the ground.
  [[nodiscard]] bool hasPillarInside(const SlotCandidate& c) const {
    constexpr double kAside = 0.25;  // of the width
    constexpr double kDeep = 0.5;    // of the depth
    constexpr double kStep = 0.08;   // m
    constexpr int kLeast = 4;        // samples: a foot of 0.3 m
    const double width = c.front().norm();
    const double across = kStep / width;
    const double along = kStep / c.length();
    int feet = 0;
    for (double a = kAside; a <= 1.0 - kAside; a += across) {
      const Vector2d p = (1.0 - a) * c.corners[0] + a * c.corners[1];
      const Vector2d q = (1.0 - a) * c.corners[3] + a * c.corners[2];
      for (double b = 0.0; b < kDeep; b += along) {
        if (isPillarFoot((1.0 - b) * p + b * q)) ++feet;
      }
    }
    return feet >= kLeast;
  }

  [[nodiscard]] bool isPillarFoot(const Vector2d& p) const {
    if (probe_.at(p) != SemanticClass::kPillar) return false;
    const Vector2d towards = (views_.viewAt(probe_.labels().geometry, p).foot - p).normalized();
    return !probe_.isHidden(p + 0.08 * towards) && !probe_.isHidden(p + 0.2 * towards);
  }

  // Whether the car, driving on, would pass beside the way into the slot, not over it: its aisle
  // would be another one, and the slot is more likely one along this aisle seen from its end.
  [[nodiscard]] bool liesBesideTheWay(const SlotCandidate& c) const {
    constexpr double kAlong = 0.8;  // cosine
    constexpr double kAside = 1.0;  // m
    if (std::abs(c.inward.x()) < kAlong) return false;
    const Vector2d to_car = probe_.labels().geometry.center - 0.5 * (c.left->p + c.right->p);
    const double aside = std::abs(to_car.dot(c.front().normalized()));
    return aside > 0.5 * c.front().norm() + kAside;
  }

  // Share of the entrance along which a lane line runs: those end where slots begin.
  [[nodiscard]] double laneLineAlong(const SlotCandidate& c) const {
    constexpr double kFromCorner = 0.15;  // m
    const double step = probe_.labels().geometry.metres_per_px;
    const Vector2d u = c.front().normalized();
    const double length = c.front().norm() - 2.0 * kFromCorner;
    const int count = static_cast<int>(length / step);
    int painted = 0;
    for (int i = 0; i < count; ++i) {
      const Vector2d p = c.left->p + (kFromCorner + i * step) * u;
      for (int k = -2; k <= 2; ++k) {
        if (probe_.at(p + k * step * c.inward) != SemanticClass::kLaneLine) continue;
        ++painted;
        break;
      }
    }
    return static_cast<double>(painted) / std::max(1, count);
  }

  // Whether the side line of a mark is an aisle's edge: beyond the mark a lane line carries it on.
  // That makes it the entrance of a slot along the aisle.
  [[nodiscard]] bool goesOnAsLaneLine(const SlotMark& mark) const {
    constexpr double kFrom = 0.15;  // m
    constexpr double kTo = 1.6;
    constexpr double kLeast = 0.5;  // m of lane line
    const double step = probe_.labels().geometry.metres_per_px;
    const Vector2d n(-mark.inward.y(), mark.inward.x());
    double painted = 0.0;
    for (double d = kFrom; d < kTo; d += step) {
      for (int k = -2; k <= 2; ++k) {
        if (probe_.at(mark.p - d * mark.inward + k * step * n) != SemanticClass::kLaneLine)
          continue;
        painted += step;
        break;
      }
    }
    return painted > kLeast;
  }

  // What the other candidates say against each one.
  void weighAgainstOthers() {
    constexpr double kMost = 6.0;  // log-odds
    std::vector<double> doubts;
    for (const SlotCandidate& c : candidates_) {
      double doubt = 0.0;
      for (const SlotCandidate& other : candidates_) doubt += doubtBy(c, other);
      doubts.push_back(std::min(doubt, kMost));
    }
    for (std::size_t i = 0; i < candidates_.size(); ++i) candidates_[i].score -= doubts[i];
  }

  // Beside a pillar the gap between two slots is easily taken into one of them: the line between is
  // hidden or worn. Where others are narrower, a wide one is told only if the place of that line is
  // seen to be bare, or if its front is painted from corner to corner and no further: nothing was
  // taken into it then. What borders on a perpendicular slot is no parallel one, and the entrances
  // of slots that share a line lie in one line.
  [[nodiscard]] double doubtBy(const SlotCandidate& c, const SlotCandidate& other) const {
    constexpr double kSure = 1.0;    // log-odds of what speaks against others
    constexpr double kWider = 0.35;  // m
    constexpr double kBare = 1.0;
    if (other.score < kSure || other.shape == SlotShape::kParallel) return 0.0;
    const bool share = other.right == c.left || other.left == c.right;
    if (c.shape == SlotShape::kParallel && share) return 3.0;
    if (other.score > c.score && liesAcross(c, other)) return 3.0;
    if (std::abs(other.inward.dot(c.inward)) < kParallelSides) return 0.0;
    double doubt = 0.0;
    if (share && other.score > c.score && !inLine(c, other)) doubt += 2.0;
    const double narrower = other.width();
    if (c.shape != SlotShape::kParallel && c.width() - narrower > kWider && !frontEndsAtBoth(c)) {
      doubt += isBareAt(c, narrower) ? kBare : 2.0;
    }
    return doubt;
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

  // Whether the front is painted all along and ends at both corners.
  [[nodiscard]] bool frontEndsAtBoth(const SlotCandidate& c) const {
    constexpr double kPainted = 0.8;
    constexpr double kBare = 0.9;
    constexpr double kPast = 0.15;  // m from a corner
    constexpr double kFar = 0.55;
    const Vector2d u = c.front().normalized();
    const Vector2d left = c.left->p;
    const Vector2d right = c.right->p;
    return probe_.along(left + kPast * u, right - kPast * u).paint > kPainted &&
           probe_.along(left - kPast * u, left - kFar * u).floor > kBare &&
           probe_.along(right + kPast * u, right + kFar * u).floor > kBare;
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

  // Slots come in rows: others that share a mark and look the same way.
  [[nodiscard]] double neighbours(const SlotCandidate& c) const {
    double bonus = 0.0;
    for (const SlotCandidate& other : candidates_) {
      if (other.inward.dot(c.inward) < kParallelSides || other.shape != c.shape) continue;
      if (other.right == c.left || other.left == c.right) bonus += 0.5;
    }
    return std::min(bonus, 1.0);
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
