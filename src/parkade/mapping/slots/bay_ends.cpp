// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/bay_ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/map_check.hpp"
#include "parkade/mapping/slots/bay_stands.hpp"
#include "parkade/mapping/slots/outlined_place.hpp"
#include "parkade/mapping/slots/row_pattern.hpp"
#include "parkade/mapping/slots/slot_axes.hpp"

namespace parkade::slot_rows {
namespace {

using Eigen::Vector2d;
using Corners = std::array<Vector2d, 4>;

Vector2d leftOf(const Vector2d& v) {
  return {-v.y(), v.x()};
}

// Of the rows, either way.
std::vector<Vector2d> directionsOf(const std::vector<Row>& rows) {
  constexpr double kSame = 0.9986;  // cosine of 3 degrees
  std::vector<Vector2d> directions;
  for (const Row& row : rows) {
    for (const Vector2d& u : {row.u, Vector2d(-row.u)}) {
      if (std::none_of(directions.begin(), directions.end(),
                       [&](const Vector2d& other) { return u.dot(other) > kSame; })) {
        directions.push_back(u);
      }
    }
  }
  return directions;
}

struct BayEnd {
  MapSlot slot;
  double merit = 0.0;  // of several at one place the greatest
};

class BayEndFinder {
 public:
  BayEndFinder(const std::vector<MapSlot>& slots, const LayeredGrid& grid,
               const SlotLikelihood& likelihood, const RowCompletionOptions& options)
      : slots_(slots), grid_(grid), likelihood_(likelihood), options_(options) {}

  // Beside the column at p, in a row of direction u; none where it is not likely.
  [[nodiscard]] std::optional<BayEnd> find(const Vector2d& p, const Vector2d& u,
                                           const Stand& stand) const {
    const Corners usual = place(p, u, stand, Vector2d::Zero());
    if (isTaken(usual, kSurely) || !hasSomePaint(usual, stand)) return std::nullopt;
    std::optional<Corners> best;
    double most = 0.0;
    for (const double along : {0.0, -0.1, 0.1, -0.2, 0.2}) {
      for (const double deep : {0.0, -0.1, 0.1, -0.2, 0.2, -0.3, 0.3}) {
        const Corners corners = place(p, u, stand, {along, deep});
        const double score = fit(corners);
        if (score <= most) continue;
        most = score;
        best = corners;
      }
    }
    if (!best) return std::nullopt;
    // Columns stand in the middle of slots along the aisle, which look alike from both sides.
    if (stand.shape == SlotShape::kParallel) best = enteredFromFloor(*best, grid_);
    if (!hasRoom(*best)) return std::nullopt;
    return weigh(*best, stand);
  }

 private:
  static constexpr double kOverlap = 0.15;
  static constexpr double kSurely = 0.4;  // too much of an overlap wherever it is shifted to
  static constexpr double kPast = 0.15;   // m, half a line and its error
  static constexpr double kBeyond = 0.3;  // painted, where a line is taken to go on
  // One of two sides does, by chance one line in a hundred.
  static constexpr double kStandsOut = 3.9;

  static Corners place(const Vector2d& p, const Vector2d& u, const Stand& stand,
                       const Vector2d& shift) {
    const Vector2d n = leftOf(u);
    const Vector2d at = stand.corner + shift;
    const Vector2d corner = p + at.x() * u + at.y() * n;
    const Vector2d other = corner + (stand.is_right ? stand.front : -stand.front) * u;
    const Vector2d side = stand.side.x() * u + stand.side.y() * n;
    const Vector2d& left = stand.is_right ? corner : other;
    const Vector2d& right = stand.is_right ? other : corner;
    return {left, right, right + side, left + side};
  }

  // Whether the side beside the column can stand out at all: most columns can be left at once.
  [[nodiscard]] bool hasSomePaint(const Corners& c, const Stand& stand) const {
    constexpr double kSome = 0.2;  // shifted along the line by 0.3 m it may be more
    const Vector2d u = (c[1] - c[0]).normalized();
    for (const double aside : {-0.2, 0.0, 0.2}) {
      const Vector2d& front = stand.is_right ? c[0] : c[1];
      const Vector2d& rear = stand.is_right ? c[3] : c[2];
      if (lookAlong(grid_, front + aside * u, rear + aside * u).painted > kSome) return true;
    }
    return false;
  }

  [[nodiscard]] SlotEvidence::Line ahead(const Vector2d& front, const Vector2d& inward) const {
    constexpr double kAhead = 1.2;  // m
    return lookAlong(grid_, front - kPast * inward, front - kAhead * inward);
  }

  // Metres of paint that stand out, less what goes on in front of the entrance.
  [[nodiscard]] double fit(const Corners& c) const {
    constexpr double kTooLong = 2.0;
    const Vector2d inward = (c[3] - c[0]).normalized();
    const Vector2d u = (c[1] - c[0]).normalized();
    double sum = lookAlong(grid_, c[0] + kPast * u, c[1] - kPast * u).paint() +
                 lookAlong(grid_, c[3] + kPast * u, c[2] - kPast * u).paint();
    for (const auto& [front, rear] : {std::pair{c[0], c[3]}, {c[1], c[2]}}) {
      sum += lookAlong(grid_, front + kPast * inward, rear).paint() -
             kTooLong * ahead(front, inward).paint();
    }
    return sum;
  }

  [[nodiscard]] bool isTaken(const Corners& c, double share) const {
    constexpr double kFar = 12.0;  // m
    return std::any_of(slots_.begin(), slots_.end(), [&](const MapSlot& slot) {
      return (slot.corners[0] - c[0]).norm() < kFar && overlapShare(slot.corners, c) > share;
    });
  }

  // No known slot lies there, or where one would drive in.
  [[nodiscard]] bool hasRoom(const Corners& c) const {
    constexpr double kAisle = 3.0;  // m
    constexpr double kSome = 0.05;
    const Vector2d u = c[1] - c[0];
    Vector2d out = leftOf(u).normalized();
    if (out.dot(c[3] - c[0]) > 0.0) out = -out;
    const Vector2d left = c[0] + 0.2 * u + kPast * out;
    const Vector2d right = c[1] - 0.2 * u + kPast * out;
    return !isTaken(c, kOverlap) &&
           !isTaken({left, right, right + kAisle * out, left + kAisle * out}, kSome);
  }

  // Plainly, and not beyond the entrance.
  [[nodiscard]] bool beginsAt(const SlotEvidence::Line& line, const Vector2d& front,
                              const Vector2d& inward) const {
    constexpr double kContrast = 0.3;
    return line.contrast() > kContrast && ahead(front, inward).painted < kBeyond;
  }

  // Longer than a slot along the aisle is deep.
  [[nodiscard]] bool standsOut(const SlotEvidence::Line& line, const Vector2d& front,
                               const Vector2d& inward) const {
    constexpr double kLeast = 2.5;  // m
    return line.seen_m > kLeast && beginsAt(line, front, inward);
  }

  // As deep as a slot along the aisle, and no line that goes on: neither in front of the entrance
  // nor behind the rear, where sides of slots into the row do, and the edges of an aisle.
  [[nodiscard]] bool isShortSide(const SlotEvidence::Line& line, const Vector2d& front,
                                 const Vector2d& rear) const {
    constexpr double kLeast = 0.6;  // m of paint
    constexpr double kBehind = 1.3;
    constexpr double kSeen = 0.7;  // m of what lies behind
    const Vector2d inward = (rear - front).normalized();
    const SlotEvidence::Line behind =
        lookAlong(grid_, rear + 2.0 * kPast * inward, rear + kBehind * inward);
    return line.paint() > kLeast && behind.seen_m > kSeen && behind.painted < kBeyond &&
           beginsAt(line, front, inward);
  }

  // One side of a slot along the aisle stands out as no other line does and the other shows, or it
  // is none: cars stand beside single lines as well.
  [[nodiscard]] std::optional<double> sidesAlongAisle(const SlotEvidence& e,
                                                      const Corners& c) const {
    const bool knows_left = isLineOfKnown(c[0], c[3]);
    const bool knows_right = isLineOfKnown(c[1], c[2]);
    const bool left = isShortSide(e.left, c[0], c[3]) && !knows_left;
    const bool right = isShortSide(e.right, c[1], c[2]) && !knows_right;
    if (left && right) return 2.0 * kStandsOut;
    if (!left && !right) return std::nullopt;
    if (left ? knows_right : knows_left) return kStandsOut;
    const double other = likelihood_.side(left ? e.right : e.left);
    if (other <= 0.0) return std::nullopt;
    return kStandsOut + other;
  }

  // The side beside the column stands out as no slot's along the aisle can, or it is none.
  [[nodiscard]] std::optional<double> sidesIntoRow(const SlotEvidence& e, const Corners& c,
                                                   bool is_right) const {
    const Vector2d inward = (c[3] - c[0]).normalized();
    const Vector2d& front = c[is_right ? 0 : 1];
    const Vector2d& other = c[is_right ? 1 : 0];
    if (isSideOfKnown(front) || !standsOut(is_right ? e.left : e.right, front, inward))
      return std::nullopt;
    if (isSideOfKnown(other)) return kStandsOut;
    return kStandsOut + otherSide(is_right ? e.right : e.left, other, inward);
  }

  // Where one side is plain to see the other is as well, if the floor is: of the slots that were
  // told it is missing in 3 of 100 (docs/math/slots.md), and they were told by their sides.
  [[nodiscard]] double otherSide(const SlotEvidence::Line& line, const Vector2d& front,
                                 const Vector2d& inward) const {
    constexpr double kSeen = 1.0;       // m
    constexpr double kMissing = -2.25;  // log(0.1 / 0.95)
    if (standsOut(line, front, inward)) return kStandsOut;
    const double log_odds = likelihood_.side(line);
    return log_odds < 0.0 && line.seen_m > kSeen ? kMissing : log_odds;
  }

  // What is the side of a known slot says nothing of its neighbour.
  [[nodiscard]] bool isSideOfKnown(const Vector2d& front) const {
    constexpr double kSame = 0.5;  // m
    return std::any_of(slots_.begin(), slots_.end(), [&](const MapSlot& slot) {
      return std::min((slot.corners[0] - front).norm(), (slot.corners[1] - front).norm()) < kSame;
    });
  }

  // Nor does one that runs along any line of it, as an entrance of the next row does.
  [[nodiscard]] bool isLineOfKnown(const Vector2d& front, const Vector2d& rear) const {
    return isSideOfKnown(front) ||
           std::any_of(slots_.begin(), slots_.end(),
                       [&](const MapSlot& slot) { return liesOnLineOf(slot, front, rear); });
  }

  [[nodiscard]] std::optional<BayEnd> weigh(const Corners& corners, const Stand& stand) const {
    const SlotEvidence e = gatherEvidence(grid_, corners);
    if (isDenied(e)) return std::nullopt;
    const std::optional<double> sides = stand.shape == SlotShape::kParallel
                                            ? sidesAlongAisle(e, corners)
                                            : sidesIntoRow(e, corners, stand.is_right);
    if (!sides) return std::nullopt;
    constexpr double kPrior = -3.0;  // most columns have known slots beside them, or none
    const double log_odds = kPrior + *sides + likelihood_.entrance(e.entrance) +
                            SlotLikelihood::vehicle(e) + likelihood_.number(e) +
                            likelihood_.stop(e);
    if (log_odds < options_.min_log_odds) return std::nullopt;
    BayEnd end;
    end.merit = log_odds + fit(corners);
    end.slot = makeSlot(corners, stand, e);
    return end;
  }

  [[nodiscard]] MapSlot makeSlot(const Corners& corners, const Stand& stand,
                                 const SlotEvidence& evidence) const {
    const MapSlot& near =
        *std::min_element(slots_.begin(), slots_.end(), [&](const MapSlot& a, const MapSlot& b) {
          return (a.corners[0] - corners[0]).norm() < (b.corners[0] - corners[0]).norm();
        });
    constexpr double kSigma = 0.1;  // m
    Pattern pattern;
    pattern.shape = stand.shape;
    pattern.side = corners[3] - corners[0];
    MapSlot slot = unseenSlot(pattern, corners[0], corners[1], near,
                              std::max(kSigma, options_.corner_sigma_m));
    setFree(evidence, slot);
    return slot;
  }

  const std::vector<MapSlot>& slots_;
  const LayeredGrid& grid_;
  const SlotLikelihood& likelihood_;
  const RowCompletionOptions& options_;
};

// The best of those at one place.
std::vector<MapSlot> withoutOverlaps(std::vector<BayEnd> ends) {
  std::stable_sort(ends.begin(), ends.end(),
                   [](const BayEnd& a, const BayEnd& b) { return a.merit > b.merit; });
  constexpr double kOverlap = 0.15;
  std::vector<MapSlot> found;
  for (const BayEnd& end : ends) {
    if (std::none_of(found.begin(), found.end(), [&](const MapSlot& other) {
          return overlapShare(other.corners, end.slot.corners) > kOverlap;
        })) {
      found.push_back(end.slot);
    }
  }
  return found;
}

}  // namespace

std::vector<MapSlot> findBayEnds(const std::vector<MapSlot>& slots,
                                 const std::vector<Vector2d>& pillars, const LayeredGrid& grid,
                                 const SlotLikelihood& likelihood,
                                 const RowCompletionOptions& options) {
  const std::vector<Row> rows = findRows(slots);
  const std::vector<Stand> stands = learnStands(rows, slots, pillars);
  const std::vector<Vector2d> directions = directionsOf(rows);
  std::vector<Vector2d> along_axes = directions;
  if (const std::optional<double> axis = findAxis(slots)) {
    constexpr double kOff = 2.0 * M_PI / 180.0;
    std::erase_if(along_axes,
                  [&](const Vector2d& u) { return std::abs(turnFromAxes(u, *axis)) > kOff; });
  }
  std::vector<MapSlot> known = slots;
  // Those along the aisle first: their sides, half as long, are taken for others' otherwise.
  for (const bool is_parallel : {true, false}) {
    const BayEndFinder finder(known, grid, likelihood, options);
    std::vector<BayEnd> ends;
    for (const Vector2d& u : is_parallel ? along_axes : directions) {
      for (const Vector2d& p : pillars) {
        for (const Stand& stand : stands) {
          if ((stand.shape == SlotShape::kParallel) != is_parallel) continue;
          if (const auto end = finder.find(p, u, stand)) ends.push_back(*end);
        }
      }
    }
    const std::vector<MapSlot> found = withoutOverlaps(std::move(ends));
    known.insert(known.end(), found.begin(), found.end());
  }
  return {known.begin() + static_cast<std::ptrdiff_t>(slots.size()), known.end()};
}

}  // namespace parkade::slot_rows
