// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_marks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/semantics/slots/line_ends.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kMeet = 0.45;    // m: lines that end this near to each other meet
constexpr double kMeetFar = 0.8;  // m: the same in paint, at lines that pass and at middles of bars
constexpr double kLeastMet = 0.25;   // m of side line to see, where another line meets it
constexpr double kLeastOpen = 0.35;  // the same without
constexpr double kLongestBar = 0.9;  // m
constexpr double kSteepest = 0.42;   // sine of the least angle between lines that meet
constexpr double kBeyond = 0.9;      // m in front of an entrance without its side going on

struct Stroke {
  Vector2d begin;
  Vector2d end;
  Vector2d along;
  double length = 0.0;
  double width = 0.0;
  bool is_bar = false;  // of a T: short, and met between its ends
  bool is_met = false;  // some side ends at it

  [[nodiscard]] Vector2d normal() const { return {-along.y(), along.x()}; }
};

class MarkFinder {
 public:
  MarkFinder(const cv::Mat& grey, const LabelProbe& probe, const std::vector<LineSegment>& segments)
      : probe_(probe), ends_(grey, probe), pixel_(probe.labels().geometry.metres_per_px) {
    for (const LineSegment& segment : segments) {
      if (segment.semantic_class != SemanticClass::kSlotLine) continue;
      Stroke stroke;
      stroke.begin = segment.begin;
      stroke.end = segment.end;
      stroke.length = (segment.end - segment.begin).norm();
      stroke.along = (segment.end - segment.begin) / std::max(stroke.length, 1e-6);
      stroke.width = segment.width;
      strokes_.push_back(stroke);
    }
  }

  std::vector<SlotMark> find() {
    for (std::size_t i = 0; i < strokes_.size(); ++i) {
      for (std::size_t j = 0; j < strokes_.size(); ++j) {
        if (i != j) meet(i, j);
      }
    }
    for (std::size_t i = 0; i < strokes_.size(); ++i) {
      if (strokes_[i].is_bar) continue;
      openEnd(i, 1.0);
      openEnd(i, -1.0);
    }
    for (std::size_t i = 0; i < strokes_.size(); ++i) {
      loneBar(i);
      frontEnd(i, 1.0);
      frontEnd(i, -1.0);
    }
    return std::move(marks_);
  }

 private:
  // Where line j meets side line i.
  void meet(std::size_t i, std::size_t j) {
    const Stroke& side = strokes_[i];
    Stroke& other = strokes_[j];
    const double sine = side.along.x() * other.along.y() - side.along.y() * other.along.x();
    if (std::abs(sine) < kSteepest) return;
    const Vector2d between = other.begin - side.begin;
    const double s = (between.x() * other.along.y() - between.y() * other.along.x()) / sine;
    const double t = (between.x() * side.along.y() - between.y() * side.along.x()) / sine;
    if (s < -kMeetFar || s > side.length + kMeetFar || t < -kMeetFar ||
        t > other.length + kMeetFar) {
      return;
    }
    SlotMark mark;
    mark.p = side.begin + s * side.along;
    constexpr double kWithin = 0.15;
    const bool short_one = other.length < kLongestBar;
    // Lines that only come near to each other have floor between them; but a side that points at a
    // line that reaches there, or at a bar's middle, has lost its own end.
    if (!reaches(other, t, mark.p)) return;
    const bool at_middle = short_one && std::abs(t - 0.5 * other.length) < kWithin;
    if (short_one && !at_middle && !reaches(side, s, mark.p)) return;
    if (short_one && t > kWithin && t < other.length - kWithin) other.is_bar = true;
    mark.across = other.along;
    mark.across_length = other.length;
    mark.side = static_cast<int>(i);
    mark.width = side.width;
    // Its axis is known best at the middle of what is seen of it, and better the longer it is.
    const double length = std::max(other.length, 0.2);
    const double own = std::max(0.15, 0.3 * std::sqrt(0.6 / length)) * pixel_;
    const double off = (t - 0.5 * other.length) / length;
    mark.sigma_along = own * std::sqrt(1.0 + 12.0 * off * off) / std::abs(sine);
    mark.sigma_aside = 0.3 * pixel_;
    const bool ahead = add(mark, side.along, side.length - s, kLeastMet);
    const bool behind = add(mark, -side.along, s, kLeastMet);
    if (ahead || behind) other.is_met = true;
  }

  // Whether the paint of a line goes on to p, which lies s m along it.
  [[nodiscard]] bool reaches(const Stroke& stroke, double s, const Vector2d& p) const {
    const double inside = std::clamp(s, 0.0, stroke.length);
    const double gap = std::abs(s - inside);
    if (gap < 0.1) return true;
    const Vector2d tip = stroke.begin + inside * stroke.along;
    const LabelProbe::Shares between = probe_.along(tip, p, 0.04);
    if (gap > kMeet) return between.paint > 0.8;
    return between.floor < 0.5 || wornShare(tip, p) > 0.5;
  }

  // Share of a worn piece of line that is paint by its label, or is held for it nearly as much:
  // short ones pass for lane lines.
  [[nodiscard]] double wornShare(const Vector2d& a, const Vector2d& b) const {
    constexpr double kNearly = -2.0;  // log-odds
    constexpr int kSamples = 11;
    int worn = 0;
    for (int k = 0; k < kSamples; ++k) {
      const Vector2d p = a + k / (kSamples - 1.0) * (b - a);
      const bool lane = probe_.at(p) == SemanticClass::kLaneLine;
      if (lane || probe_.isPaint(p) || probe_.slotEvidence(p) > kNearly) ++worn;
    }
    return static_cast<double>(worn) / kSamples;
  }

  // The corner at a line's end.
  struct Corner {
    Vector2d p;
    double sigma;  // m, along the line
  };
  [[nodiscard]] std::optional<Corner> cornerAt(const Stroke& line, double sign) const {
    constexpr double kBack = 0.15;  // m from the end, from where paint is followed on
    const Vector2d outward = sign * line.along;
    const Vector2d tip = sign > 0.0 ? line.end : line.begin;
    const double back = std::min(kBack, 0.5 * line.length);
    const auto end = ends_.from(tip - back * outward, outward, line.width);
    if (!end) return std::nullopt;
    // Lines end half their width beyond the corner.
    return Corner{end->p - 0.5 * line.width * outward, std::hypot(end->sigma_px * pixel_, 0.01)};
  }

  void openEnd(std::size_t i, double sign) {
    const Stroke& side = strokes_[i];
    const Vector2d outward = sign * side.along;
    const auto corner = cornerAt(side, sign);
    if (!corner) return;
    SlotMark mark;
    mark.p = corner->p;
    mark.side = static_cast<int>(i);
    mark.width = side.width;
    mark.sigma_along = corner->sigma;
    mark.sigma_aside = 0.3 * pixel_;
    for (SlotMark& met : marks_) {
      if (met.side != mark.side) continue;
      const double beyond = (met.p - mark.p).dot(outward);
      // Another line meets it farther out: its own end is worn.
      if (met.inward.dot(outward) < 0.0 && beyond >= kMeet && beyond < kMeetFar) return;
      if ((met.p - mark.p).norm() >= kMeet) continue;
      // Where only a short bar meets the line, its end tells better where that is.
      const bool ends = met.inward.dot(outward) < 0.0 && met.sigma_along > mark.sigma_along;
      if (ends && (met.p - mark.p).norm() < 3.0 * met.sigma_along) {
        met.p = mark.p;
        met.sigma_along = mark.sigma_along;
      }
      return;
    }
    add(mark, -outward, side.length, kLeastOpen);
  }

  // A bar of a T whose line is worn or hidden: slots may lie on either hand of it.
  void loneBar(std::size_t i) {
    constexpr double kShortestBar = 0.4;  // m
    const Stroke& bar = strokes_[i];
    if (bar.is_met || bar.length < kShortestBar || bar.length > kLongestBar) return;
    SlotMark mark;
    mark.p = 0.5 * (bar.begin + bar.end);
    mark.across = bar.along;
    mark.across_length = bar.length;
    mark.side = static_cast<int>(i);
    mark.width = bar.width;
    mark.sigma_along = 0.3 * pixel_;
    mark.sigma_aside = 2.0 * pixel_;  // where it is seen to end
    mark.is_bar = true;
    for (const double sign : {-1.0, 1.0}) add(mark, sign * bar.normal(), 0.0, 0.0);
  }

  // The end of an entrance line that sides meet elsewhere: a corner whose side is worn or hidden.
  void frontEnd(std::size_t i, double sign) {
    constexpr double kShortest = 1.5;  // m
    constexpr double kApart = 0.5;     // m from another corner
    const Stroke& front = strokes_[i];
    if (!front.is_met || front.length < kShortest) return;
    const auto corner = cornerAt(front, sign);
    if (!corner) return;
    SlotMark mark;
    mark.p = corner->p;
    mark.across = front.along;
    mark.across_length = front.length;
    mark.side = static_cast<int>(strokes_.size() + 2 * i) + (sign > 0.0 ? 1 : 0);
    mark.width = front.width;
    mark.sigma_along = 0.3 * pixel_;
    mark.sigma_aside = corner->sigma;
    mark.is_front_end = true;
    const std::vector<SlotMark> met = marksOn(front);
    const auto is_near = [&](const SlotMark& other) { return (other.p - mark.p).norm() < kApart; };
    if (std::any_of(met.begin(), met.end(), is_near)) return;
    for (const SlotMark& other : met) {
      if (maySideBe(mark.p, other.inward)) add(mark, other.inward, 0.0, 0.0);
    }
  }

  // Whether a side from p on is hidden, or held for one on average, within some pixels.
  [[nodiscard]] bool maySideBe(const Vector2d& p, const Vector2d& inward) const {
    constexpr double kFrom = 0.12;  // m
    constexpr double kTo = 1.0;
    constexpr double kLeastSeen = 0.25;
    constexpr double kNearly = -4.0;  // log-odds
    const Vector2d aside = pixel_ * Vector2d(-inward.y(), inward.x());
    for (int k = -3; k <= 3; ++k) {
      double sum = 0.0;
      int seen = 0;
      int samples = 0;
      for (double d = kFrom; d <= kTo; d += pixel_, ++samples) {
        const Vector2d q = p + d * inward + k * aside;
        if (probe_.isHidden(q)) continue;
        sum += probe_.slotEvidence(q);
        ++seen;
      }
      if (seen < kLeastSeen * samples || sum > kNearly * seen) return true;
    }
    return false;
  }

  // Where sides meet a line.
  [[nodiscard]] std::vector<SlotMark> marksOn(const Stroke& front) const {
    constexpr double kOff = 0.3;  // m
    std::vector<SlotMark> on;
    for (const SlotMark& mark : marks_) {
      if (mark.is_front_end || mark.across != front.along) continue;
      if (std::abs((mark.p - front.begin).dot(front.normal())) < kOff) on.push_back(mark);
    }
    return on;
  }

  // Whether there is such a mark now.
  bool add(SlotMark mark, const Vector2d& inward, double visible, double least) {
    if (visible < least) return false;
    const double margin = std::max(0.12, mark.width);
    if (probe_.along(mark.p - margin * inward, mark.p - kBeyond * inward).paint > 0.3) return false;
    mark.inward = inward;
    mark.visible = visible;
    for (SlotMark& other : marks_) {
      if (other.side != mark.side || (other.p - mark.p).norm() > 0.15) continue;
      if (other.inward.dot(mark.inward) < 0.0) continue;
      // Two pieces of one line meet here: the better known one tells.
      if (mark.sigma_along < other.sigma_along) other = mark;
      return true;
    }
    marks_.push_back(mark);
    return true;
  }

  const LabelProbe& probe_;
  LineEndFinder ends_;
  double pixel_;
  std::vector<Stroke> strokes_;
  std::vector<SlotMark> marks_;
};

}  // namespace

std::vector<SlotMark> findSlotMarks(const cv::Mat& grey, const LabelProbe& probe,
                                    const std::vector<LineSegment>& segments) {
  return MarkFinder(grey, probe, segments).find();
}

}  // namespace parkade
