// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_clues.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/semantics/slots/slot_candidates.hpp"
#include "parkade/semantics/slots/slot_weights.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kUsualWidth = 2.5;  // m, where no row tells

// Slots come in rows: others that share a mark and look the same way.
double neighbours(const SlotCandidate& c, const std::vector<SlotCandidate>& others) {
  double count = 0.0;
  for (const SlotCandidate& other : others) {
    if (other.inward.dot(c.inward) < kParallelSides || other.shape != c.shape) continue;
    if (other.right == c.left || other.left == c.right) count += 0.5;
  }
  return std::min(count, 1.0);
}

// Radians between the sides, or between the front and a line that meets a side there.
double largestAngle(const SlotCandidate& c) {
  double sine = std::abs(cross(c.left->inward, c.right->inward));
  const Vector2d u = c.front().normalized();
  for (const SlotMark* mark : {c.left, c.right}) {
    if (!mark->across.isZero()) sine = std::max(sine, std::abs(cross(mark->across, u)));
  }
  return std::asin(std::min(1.0, sine));
}

class SlotClueFinder {
 public:
  SlotClueFinder(const LabelProbe& probe, const BevViews& views) : probe_(probe), views_(views) {}

  [[nodiscard]] SlotClues find(const SlotCandidate& c, double neighbours,
                               double usual_width) const {
    const Vector2d u = c.front().normalized();
    Vector2d ahead(-u.y(), u.x());
    if (ahead.dot(c.inward) > 0.0) ahead = -ahead;
    const LabelProbe::Shares way = wayInFront(c, u, ahead);
    const Vector2d to_car = probe_.labels().geometry.center - 0.5 * (c.left->p + c.right->p);
    const double facing = 2.0 * to_car.dot(ahead) / std::max(1.0, to_car.norm());
    const bool parallel = c.shape == SlotShape::kParallel;
    const bool slanted = c.shape == SlotShape::kSlanted;
    const auto flag = [](bool holds) { return holds ? 1.0 : 0.0; };
    // Little paint says as much as much of it.
    const auto most = [](double value) { return std::min(1.0, value); };
    return {std::min({1.0, c.left->visible, c.right->visible}),
            way.floor,
            most(20.0 * way.paint),
            most(8.0 * paintAcross(c)),
            std::clamp(facing, 0.0, 1.0),
            std::clamp(-facing, 0.0, 1.0),
            flag(goesOnAsLaneLine(*c.left) || goesOnAsLaneLine(*c.right)),
            flag(c.marking == SlotMarking::kClosed),
            flag(c.marking == SlotMarking::kT),
            flag(c.marking == SlotMarking::kL),
            wheelStopInFront(c),
            flag(slanted),
            flag(parallel),
            neighbours,
            pillarInside(c),
            parallel ? 0.0
                     : most(2.0 * std::min(std::abs(c.width() - usual_width),
                                           std::abs(c.width() - kUsualWidth))),
            slanted ? 0.0 : 10.0 * std::abs(u.dot(c.inward)),
            flag(c.isFaint()),
            0.5 * c.turned_out,
            flag(c.mark_between),
            0.5 * (flag(c.left->is_bar) + flag(c.right->is_bar)),
            most(3.0 * largestAngle(c)),
            0.5 * c.ends_short,
            0.5 * (flag(c.left->is_front_end) + flag(c.right->is_front_end))};
  }

 private:
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

  // Wheels stop at the rear: what has one behind its first line is seen from there. How plainly.
  [[nodiscard]] double wheelStopInFront(const SlotCandidate& c) const {
    constexpr double kFrom = 0.2;  // of the slot's depth
    constexpr double kTo = 0.3;
    int stops = 0;
    int samples = 0;
    for (double b = 0.04; b < kTo; b += 0.02) {
      for (double a = kFrom; a <= 1.0 - kFrom; a += 0.05) {
        if (probe_.at(pointIn(c.corners, a, b)) == SemanticClass::kWheelStop) ++stops;
        ++samples;
      }
    }
    constexpr double kSome = 0.025;  // of what is looked at
    constexpr double kStop = 0.1;
    const double share = static_cast<double>(stops) / samples;
    return std::clamp((share - kSome) / (kStop - kSome), 0.0, 1.0);
  }

  // How much of the foot of a pillar is seen between the sides, where the way in leads: of what
  // stands upright only the edge towards the camera lies on the ground.
  [[nodiscard]] double pillarInside(const SlotCandidate& c) const {
    constexpr double kAside = 0.25;  // of the width
    constexpr double kDeep = 0.5;    // of the depth
    constexpr double kStep = 0.08;   // m
    constexpr int kLeast = 3;        // samples: edges are ragged
    constexpr double kMost = 9.0;    // more: a foot of 0.7 m
    const double width = c.front().norm();
    const double across = kStep / width;
    const double along = kStep / c.length();
    int feet = 0;
    for (double a = kAside; a <= 1.0 - kAside; a += across) {
      for (double b = 0.0; b < kDeep; b += along) {
        const Vector2d p = pointIn(c.corners, a, b);
        if (isPillarFoot(p) && standsInside(c, p)) ++feet;
      }
    }
    return std::clamp((feet - kLeast) / kMost, 0.0, 1.0);
  }

  [[nodiscard]] bool isPillarFoot(const Vector2d& p) const {
    if (probe_.at(p) != SemanticClass::kPillar) return false;
    const Vector2d towards = (views_.viewAt(probe_.labels().geometry, p).foot - p).normalized();
    return !probe_.isHidden(p + 0.08 * towards) && !probe_.isHidden(p + 0.2 * towards);
  }

  // Whether the pillar seen at p stands between the sides. The edge of a smear runs along the sight
  // line; what is seen of it in a slot may be of one that stands beside.
  [[nodiscard]] bool standsInside(const SlotCandidate& c, const Vector2d& p) const {
    constexpr double kMargin = 0.1;  // of the width
    const Vector2d foot = footOf(p);
    const Vector2d u = c.front().normalized();
    const Vector2d deep(-u.y(), u.x());
    const Vector2d entrance = foot - (foot - c.left->p).dot(deep) / c.inward.dot(deep) * c.inward;
    const double share = (entrance - c.left->p).dot(u) / c.front().norm();
    return share > kMargin && share < 1.0 - kMargin;
  }

  // Where a pillar that is seen at p stands: from there towards the camera as far as it is seen,
  // ragged edges let alone.
  [[nodiscard]] Vector2d footOf(const Vector2d& p) const {
    constexpr double kAside = 0.16;  // m
    constexpr double kGap = 0.2;
    const double step = probe_.labels().geometry.metres_per_px;
    const Vector2d to_camera = views_.viewAt(probe_.labels().geometry, p).foot - p;
    const Vector2d towards = to_camera.normalized();
    const Vector2d aside(-towards.y(), towards.x());
    double last = 0.0;
    for (double d = step; d < to_camera.norm() && d - last < kGap; d += step) {
      for (double off = -kAside; off <= kAside && last < d; off += step) {
        if (probe_.at(p + d * towards + off * aside) == SemanticClass::kPillar) last = d;
      }
    }
    return p + last * towards;
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

  const LabelProbe& probe_;
  const BevViews& views_;
};

}  // namespace

double slotLogOdds(const SlotClues& clues) {
  double sum = kSlotIntercept;
  for (std::size_t i = 0; i < clues.size(); ++i) sum += kSlotWeights[i] * clues[i];
  return sum;
}

double slotDoubtWeight() {
  return kSlotDoubtWeight;
}

void measureSlotClues(const LabelProbe& probe, const BevViews& views,
                      std::vector<SlotCandidate>& candidates) {
  const SlotClueFinder finder(probe, views);
  std::vector<double> in_rows;
  std::vector<double> widths;
  for (const SlotCandidate& c : candidates) {
    in_rows.push_back(neighbours(c, candidates));
    if (in_rows.back() > 0.0 && c.shape != SlotShape::kParallel) widths.push_back(c.width());
  }
  const double usual = widths.empty() ? kUsualWidth : median(std::move(widths));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    candidates[i].clues = finder.find(candidates[i], in_rows[i], usual);
  }
}

}  // namespace parkade
