// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slot_extraction.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "parkade/core/check.hpp"
#include "parkade/semantics/label_probe.hpp"
#include "parkade/semantics/slot_marks.hpp"
#include "parkade/semantics/slot_occupancy.hpp"
#include "parkade/semantics/tilt_error.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kParallelSides = 0.9945;  // cosine of 6 degrees
constexpr double kSquare = 0.1392;         // cosine of 82 degrees: what is nearer to 90 is square
constexpr double kMostSlant = 0.82;        // cosine of 35 degrees
constexpr double kAlongFront = 0.9848;     // cosine of 10 degrees

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Two marks that may be the entrance of a slot, left and right as who drives in sees them.
struct Candidate {
  const SlotMark* left = nullptr;
  const SlotMark* right = nullptr;
  Vector2d inward = Vector2d::UnitX();
  SlotShape shape = SlotShape::kPerpendicular;
  SlotMarking marking = SlotMarking::kOpen;
  double depth = 0.0;  // m along inward; 0: not seen
  double score = 0.0;  // log-odds
  std::array<Vector2d, 4> corners = {Vector2d::Zero(), Vector2d::Zero(), Vector2d::Zero(),
                                     Vector2d::Zero()};

  void complete(double usual) {
    const double d = depth > 0.0 ? depth : usual;
    corners = {left->p, right->p, right->p + d * inward, left->p + d * inward};
  }
};

// Whether p lies in a convex quadrilateral of either orientation.
bool contains(const std::array<Vector2d, 4>& quad, const Vector2d& p) {
  int positive = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (cross(quad[(i + 1) % 4] - quad[i], p - quad[i]) > 0.0) ++positive;
  }
  return positive == 0 || positive == 4;
}

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

class SlotFinder {
 public:
  SlotFinder(const LabelProbe& probe, const BevViews& views, const FloorSigma& sigma,
             const SlotOptions& options, std::vector<SlotMark> marks)
      : probe_(probe), views_(views), sigma_(sigma), options_(options), marks_(std::move(marks)) {}

  std::vector<SlotObservation> find() {
    for (const SlotMark& left : marks_) {
      for (const SlotMark& right : marks_) {
        if (std::optional<Candidate> candidate = pair(left, right)) {
          candidates_.push_back(*candidate);
        }
      }
    }
    completeDepths();
    for (Candidate& candidate : candidates_) candidate.score = score(candidate);
    std::vector<SlotObservation> slots;
    for (const Candidate* chosen : choose()) slots.push_back(observe(*chosen));
    return slots;
  }

 private:
  [[nodiscard]] std::optional<Candidate> pair(const SlotMark& left, const SlotMark& right) const {
    if (left.side == right.side || left.inward.dot(right.inward) < kParallelSides) {
      return std::nullopt;
    }
    Candidate c;
    c.left = &left;
    c.right = &right;
    c.inward = (left.visible * left.inward + right.visible * right.inward).normalized();
    const Vector2d front = right.p - left.p;
    const double length = front.norm();
    // Left of who drives in is left of inward.
    const double width = cross(c.inward, -front);
    if (width <= 0.0) return std::nullopt;
    const double cosine = std::abs(front.dot(c.inward)) / length;
    if (cosine > kMostSlant) return std::nullopt;
    for (const SlotMark* mark : {&left, &right}) {
      if (mark->across.isZero()) continue;
      if (std::abs(mark->across.dot(front)) < kAlongFront * length) return std::nullopt;
    }
    c.shape = cosine > kSquare ? SlotShape::kSlanted : SlotShape::kPerpendicular;
    if (width < options_.min_width_m || width > options_.max_width_m) {
      if (c.shape == SlotShape::kSlanted || length < options_.min_parallel_length_m ||
          length > options_.max_parallel_length_m) {
        return std::nullopt;
      }
      c.shape = SlotShape::kParallel;
    }
    if (hasMarkBetween(c) || !linesTurnIn(c)) return std::nullopt;
    if (!measureDepth(c)) return std::nullopt;
    tellMarking(c);
    return c;
  }

  // Where a line meets a side at the entrance, it runs (or its bar points) towards the other side.
  [[nodiscard]] bool linesTurnIn(const Candidate& c) const {
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
    return turnsIn(*c.left, 1.0) && turnsIn(*c.right, -1.0);
  }

  // Another side between the two: these are not neighbours.
  [[nodiscard]] bool hasMarkBetween(const Candidate& c) const {
    const Vector2d front = c.right->p - c.left->p;
    const double length = front.norm();
    constexpr double kOff = 0.4;
    return std::any_of(marks_.begin(), marks_.end(), [&](const SlotMark& mark) {
      if (mark.inward.dot(c.inward) < kParallelSides) return false;
      const double s = (mark.p - c.left->p).dot(front) / length;
      return s > kOff && s < length - kOff &&
             std::abs(cross(front, mark.p - c.left->p)) < kOff * length;
    });
  }

  // From rear corners, or from where side lines end. False where they contradict a slot.
  [[nodiscard]] bool measureDepth(Candidate& c) const {
    const bool parallel = c.shape == SlotShape::kParallel;
    const double least = parallel ? options_.min_parallel_depth_m : options_.min_depth_m;
    const double most = parallel ? options_.max_parallel_depth_m : options_.max_depth_m;
    std::array<double, 2> ends{};
    int seen = 0;
    bool shorter = false;
    for (int k = 0; k < 2; ++k) {
      const SlotMark& front = k == 0 ? *c.left : *c.right;
      double best = 0.0;
      for (const SlotMark& mark : marks_) {
        if (mark.side != front.side || mark.inward.dot(front.inward) > 0.0) continue;
        const double depth = (mark.p - front.p).dot(c.inward);
        if (depth >= least && depth <= most && (best == 0.0 || depth < best)) best = depth;
        if (depth > 0.0 && depth < least && endsFor(front, depth, least)) shorter = true;
      }
      ends[static_cast<std::size_t>(k)] = best;
      if (best > 0.0) ++seen;
    }
    if (seen == 2) {
      constexpr double kSame = 0.25;
      if (std::abs(ends[0] - ends[1]) < kSame) c.depth = 0.5 * (ends[0] + ends[1]);
    }
    if (parallel && std::min(c.left->visible, c.right->visible) > most + 0.3) return false;
    return !shorter || c.depth > 0.0;
  }

  // Whether a side line goes on nowhere between a place on it and a slot's least depth: a line that
  // short belongs to no such slot. Worn ones go on.
  [[nodiscard]] bool endsFor(const SlotMark& front, double depth, double least) const {
    constexpr double kStart = 0.3;  // m
    if (least - depth < kStart) return false;
    const LabelProbe::Shares rest = probe_.along(front.p + (depth + kStart) * front.inward,
                                                 front.p + least * front.inward, 0.08);
    return rest.floor > 0.9;
  }

  void tellMarking(Candidate& c) const {
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
      for (const Candidate& c : candidates_) {
        if (c.shape == shape && c.depth > 0.0) depths.push_back(c.depth);
      }
      double usual =
          shape == SlotShape::kParallel ? options_.usual_parallel_depth_m : options_.usual_depth_m;
      if (!depths.empty()) {
        std::nth_element(depths.begin(),
                         depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2),
                         depths.end());
        usual = depths[depths.size() / 2];
      }
      for (Candidate& c : candidates_) {
        if (c.shape != shape) continue;
        // Sides may be seen further than that.
        const bool parallel = shape == SlotShape::kParallel;
        const double most = parallel ? options_.max_parallel_depth_m : options_.max_depth_m;
        const double seen = std::min(std::max(c.left->visible, c.right->visible), most);
        c.complete(std::max(usual, seen));
      }
    }
  }

  [[nodiscard]] double score(const Candidate& c) const {
    const Vector2d u = (c.right->p - c.left->p).normalized();
    const double length = (c.right->p - c.left->p).norm();
    Vector2d ahead(-u.y(), u.x());
    if (ahead.dot(c.inward) > 0.0) ahead = -ahead;
    // Room to drive in front: floor, arrows, lane lines; no slot lines, no wall.
    LabelProbe::Shares road;
    double rows = 0.0;
    for (double d = 0.4; d < 2.6; d += 0.2) {
      const LabelProbe::Shares one =
          probe_.along(c.left->p + d * ahead + 0.25 * u, c.right->p + d * ahead - 0.25 * u);
      road.floor += one.floor;
      road.paint += one.paint;
      rows += 1.0;
    }
    road.floor /= rows;
    road.paint /= rows;
    // Nothing painted across the slot.
    double crossing = 0.0;
    for (const double a : {0.3, 0.5, 0.7}) {
      const Vector2d p = (1.0 - a) * c.corners[0] + a * c.corners[1];
      const Vector2d q = (1.0 - a) * c.corners[3] + a * c.corners[2];
      crossing = std::max(crossing, probe_.along(p + 0.1 * (q - p), p + 0.8 * (q - p)).paint);
    }
    for (const double b : {0.2, 0.35, 0.5, 0.65}) {
      const Vector2d p = (1.0 - b) * c.corners[0] + b * c.corners[3];
      const Vector2d q = (1.0 - b) * c.corners[1] + b * c.corners[2];
      crossing = std::max(crossing, probe_.along(p + 0.1 * (q - p), p + 0.9 * (q - p)).paint);
    }
    const double seen_sides = std::min(2.0, 0.5 * (c.left->visible + c.right->visible));
    const Vector2d middle = 0.5 * (c.left->p + c.right->p);
    const Vector2d to_car = probe_.labels().geometry.center - middle;
    const double facing = to_car.dot(ahead) / std::max(1.0, to_car.norm());
    const LabelProbe::Shares entrance = probe_.along(c.left->p + 0.3 * u, c.right->p - 0.3 * u);
    double s = -1.0 + seen_sides + 2.0 * road.floor - 12.0 * road.paint - 10.0 * crossing;
    s += 1.5 * std::clamp(2.0 * facing, -1.0, 1.0);
    s -= 2.0 * entrance.hidden;
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
    if (c.depth > 0.0) s += 0.5;
    // Long and narrow ones are entered from the long side.
    if (c.shape == SlotShape::kPerpendicular && c.depth > 2.45 * length) s -= 1.5;
    if (c.shape == SlotShape::kSlanted && c.marking != SlotMarking::kClosed && neighbours(c) == 0.0)
      s -= 1.5;
    if (c.shape == SlotShape::kParallel && length < 2.45 * depthOf(c)) s -= 2.0;
    return s + neighbours(c);
  }

  [[nodiscard]] static double depthOf(const Candidate& c) {
    return (c.corners[3] - c.corners[0]).norm();
  }

  // Slots come in rows: others that share a mark and look the same way.
  [[nodiscard]] double neighbours(const Candidate& c) const {
    double bonus = 0.0;
    for (const Candidate& other : candidates_) {
      if (other.inward.dot(c.inward) < kParallelSides || other.shape != c.shape) continue;
      if (other.right == c.left || other.left == c.right) bonus += 0.5;
    }
    return std::min(bonus, 1.0);
  }

  [[nodiscard]] std::vector<const Candidate*> choose() const {
    std::vector<const Candidate*> order;
    const double least = std::log(options_.min_confidence / (1.0 - options_.min_confidence));
    for (const Candidate& c : candidates_) {
      if (c.score >= least) order.push_back(&c);
    }
    std::stable_sort(order.begin(), order.end(),
                     [](const Candidate* a, const Candidate* b) { return a->score > b->score; });
    std::vector<const Candidate*> chosen;
    for (const Candidate* c : order) {
      constexpr double kOverlap = 0.25;
      const bool taken = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate* other) {
        return shareInside(c->corners, other->corners) > kOverlap ||
               shareInside(other->corners, c->corners) > kOverlap;
      });
      if (!taken) chosen.push_back(c);
    }
    return chosen;
  }

  [[nodiscard]] Eigen::Matrix4d covarianceOf(const Candidate& c) const {
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
    Eigen::Matrix<double, 4, 3> J;
    for (int k = 0; k < 2; ++k) {
      const SlotMark& mark = k == 0 ? *c.left : *c.right;
      const BevViews::View& view = views_.viewAt(probe_.labels().geometry, mark.p);
      const Vector2d ray = mark.p - view.foot;
      J.block<2, 2>(2 * k, 0) = sigma_.attitude * groundTiltJacobian(ray, view.height);
      J.block<2, 1>(2 * k, 2) = sigma_.height / view.height * ray;
      const Vector2d n(-mark.inward.y(), mark.inward.x());
      covariance.block<2, 2>(2 * k, 2 * k) =
          mark.sigma_along * mark.sigma_along * mark.inward * mark.inward.transpose() +
          mark.sigma_aside * mark.sigma_aside * n * n.transpose();
    }
    return covariance + J * J.transpose();
  }

  [[nodiscard]] SlotObservation observe(const Candidate& c) const {
    SlotObservation slot;
    slot.corners = c.corners;
    slot.entrance_covariance = covarianceOf(c);
    slot.rear_seen = c.depth > 0.0;
    slot.shape = c.shape;
    slot.marking = c.marking;
    slot.confidence = 1.0 / (1.0 + std::exp(-c.score));
    slot.probability_free = probabilityFree(probe_, views_, c.corners);
    return slot;
  }

  const LabelProbe& probe_;
  const BevViews& views_;
  const FloorSigma& sigma_;
  const SlotOptions& options_;
  std::vector<SlotMark> marks_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::vector<SlotObservation> extractSlots(const BevImage& bev, const BevLabels& labels,
                                          const std::vector<LineSegment>& segments,
                                          const BevViews& views, const FloorSigma& sigma,
                                          const SlotOptions& options) {
  PARKADE_CHECK(bev.image.size() == labels.labels.size(),
                "a picture of {} x {} pixels, labels of {} x {}", bev.image.cols, bev.image.rows,
                labels.labels.cols, labels.labels.rows);
  cv::Mat grey = bev.image;
  if (bev.image.channels() == 3) cv::cvtColor(bev.image, grey, cv::COLOR_BGR2GRAY);
  const LabelProbe probe(labels);
  return SlotFinder(probe, views, sigma, options, findSlotMarks(grey, probe, segments)).find();
}

}  // namespace parkade
