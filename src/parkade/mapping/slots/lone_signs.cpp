// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/lone_signs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "parkade/core/median.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/slots/outlined_place.hpp"
#include "parkade/mapping/slots/reserved_slots.hpp"
#include "parkade/mapping/slots/row_pattern.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;
using Corners = std::array<Vector2d, 4>;

double depthOf(const std::vector<MapSlot>& told) {
  constexpr double kNorm = 5.0;  // m
  std::vector<double> depths;
  for (const MapSlot& slot : told) {
    if (slot.shape == SlotShape::kPerpendicular)
      depths.push_back((slot.corners[3] - slot.corners[0]).norm());
  }
  return depths.empty() ? kNorm : median(std::move(depths));
}

class LoneSignFinder {
 public:
  LoneSignFinder(const std::vector<MapSlot>& told, const LayeredGrid& grid,
                 const SlotLikelihood& likelihood, const RowCompletionOptions& options)
      : told_(told),
        grid_(grid),
        likelihood_(likelihood),
        options_(options),
        front_(wideFrontOf(told)),
        depth_(depthOf(told)) {}

  // Of both ways it may lie the one that shows more paint. u: along one of the axes.
  [[nodiscard]] std::optional<Filling> find(const Vector2d& sign, const Vector2d& u) const {
    const auto is_known = [&](const MapSlot& slot) { return contains(slot.corners, sign); };
    if (std::any_of(told_.begin(), told_.end(), is_known)) return std::nullopt;
    const Outline along = fit(sign, u);
    const Outline across = fit(sign, Vector2d(-u.y(), u.x()));
    return weigh(sign, along.score > across.score ? along : across);
  }

 private:
  // Of a slot whose entrance runs along u: its sides and ends, m from the sign.
  struct Pair {
    double low = 0.0;
    double high = 0.0;
    double paint = 0.0;  // m
    double score = -1e9;
  };
  struct Outline {
    Vector2d u = Vector2d::UnitX();
    Pair sides;
    Pair ends;
    double score = 0.0;
  };
  // What two lines that face each other may measure, and how far a metre off counts.
  struct Measure {
    double usual = 0.0;
    double least = 0.0;
    double most = 0.0;
    double off = 0.0;  // of the sign from the middle
  };

  // The two lines across v, half_length to either side of the sign, that show most paint.
  [[nodiscard]] Pair fitPair(const Vector2d& sign, const Vector2d& v, double half_length,
                             const Measure& measure) const {
    constexpr double kStep = 0.05;     // m
    constexpr double kPerMetre = 1.0;  // m of paint that outweigh a metre off
    const Vector2d along = half_length * Vector2d(-v.y(), v.x());
    const auto paintAt = [&](double s) {
      const Vector2d p = sign + s * v;
      return lookAlong(grid_, p - along, p + along).paint();
    };
    const double nearest = 0.5 * measure.least - measure.off;
    const int count = static_cast<int>((0.5 * measure.most + measure.off - nearest) / kStep) + 1;
    std::vector<double> before;
    std::vector<double> after;
    for (int i = 0; i < count; ++i) {
      before.push_back(paintAt(-(nearest + i * kStep)));
      after.push_back(paintAt(nearest + i * kStep));
    }
    Pair best;
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < count; ++k) {
        const double low = nearest + i * kStep;
        const double high = nearest + k * kStep;
        const double off = 0.5 * std::abs(high - low);
        if (low + high < measure.least || low + high > measure.most || off > measure.off) continue;
        const double paint = before[i] + after[k];
        const double score = paint - kPerMetre * (std::abs(low + high - measure.usual) + off);
        if (score > best.score) best = {-low, high, paint, score};
      }
    }
    return best;
  }

  [[nodiscard]] Outline fit(const Vector2d& sign, const Vector2d& u) const {
    constexpr double kOffSides = 0.2;  // m
    constexpr double kOffEnds = 0.5;   // parts of a sign may be out of sight
    constexpr double kDeeper = 0.4;    // than others
    const Vector2d n(-u.y(), u.x());
    Outline outline;
    outline.u = u;
    outline.sides =
        fitPair(sign, u, 0.4 * depth_, {front_, kLeastWideFront, kMostWideFront, kOffSides});
    outline.ends =
        fitPair(sign, n, 0.4 * front_, {depth_, depth_ - kDeeper, depth_ + kDeeper, kOffEnds});
    outline.score = outline.sides.score + outline.ends.score;
    return outline;
  }

  // Counter-clockwise, one of the ends first.
  [[nodiscard]] static Corners cornersOf(const Vector2d& sign, const Outline& o) {
    const Vector2d n(-o.u.y(), o.u.x());
    const auto at = [&](double s, double d) { return Vector2d(sign + s * o.u + d * n); };
    return {at(o.sides.low, o.ends.low), at(o.sides.high, o.ends.low),
            at(o.sides.high, o.ends.high), at(o.sides.low, o.ends.high)};
  }

  [[nodiscard]] std::optional<Filling> weigh(const Vector2d& sign, const Outline& outline) const {
    constexpr double kPrior = -2.0;      // no row speaks for it
    constexpr double kSign = 3.0;        // hardly anything else is painted like that
    constexpr double kLeastPaint = 3.0;  // m, less does not tell where it is
    if (outline.sides.paint + outline.ends.paint < kLeastPaint) return std::nullopt;
    const Place place = outlinedPlace(cornersOf(sign, outline), SlotShape::kPerpendicular, told_,
                                      grid_, options_.corner_sigma_m);
    const SlotEvidence& e = place.evidence;
    const double left = likelihood_.side(e.left);
    const double right = likelihood_.side(e.right);
    if (isDenied(e) || left < 0.0 || right < 0.0) return std::nullopt;
    return oneSlot(place.slot,
                   kPrior + kSign + left + right + std::max(0.0, likelihood_.entrance(e.entrance)),
                   options_.min_log_odds);
  }

  const std::vector<MapSlot>& told_;
  const LayeredGrid& grid_;
  const SlotLikelihood& likelihood_;
  const RowCompletionOptions& options_;
  double front_;  // m, of wide slots here
  double depth_;
};

}  // namespace

std::vector<Filling> findLoneSignSlots(const std::vector<Vector2d>& signs,
                                       const std::vector<MapSlot>& told, const LayeredGrid& grid,
                                       const SlotLikelihood& likelihood,
                                       const RowCompletionOptions& options) {
  std::vector<Filling> fillings;
  const std::optional<double> axis = findAxis(told);
  if (!axis) return fillings;
  const Vector2d u(std::cos(*axis), std::sin(*axis));
  const LoneSignFinder finder(told, grid, likelihood, options);
  for (const Vector2d& sign : signs) {
    if (const auto filling = finder.find(sign, u)) fillings.push_back(*filling);
  }
  return fillings;
}

}  // namespace parkade::slot_rows
