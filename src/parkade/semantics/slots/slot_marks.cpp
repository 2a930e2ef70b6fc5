// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_marks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kMeet = 0.45;    // m: lines that end this near to each other meet
constexpr double kMeetFar = 0.8;  // m: the same in paint, at lines that pass and at middles of bars
constexpr double kLeastMet = 0.25;   // m of side line to see, where another line meets it
constexpr double kLeastOpen = 0.35;  // the same without
constexpr double kLongestBar = 0.9;  // m
constexpr double kSteepest = 0.42;   // sine of the least angle between lines that meet
constexpr double kFaint = -1.5;      // log-odds of a worn end of a line
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

double greyAt(const cv::Mat& grey, const Vector2d& p) {
  const int u = std::clamp(static_cast<int>(std::floor(p.x())), 0, grey.cols - 2);
  const int v = std::clamp(static_cast<int>(std::floor(p.y())), 0, grey.rows - 2);
  const double a = std::clamp(p.x() - u, 0.0, 1.0);
  const double b = std::clamp(p.y() - v, 0.0, 1.0);
  const auto at = [&](int y, int x) { return static_cast<double>(grey.at<std::uint8_t>(y, x)); };
  return (1.0 - b) * ((1.0 - a) * at(v, u) + a * at(v, u + 1)) +
         b * ((1.0 - a) * at(v + 1, u) + a * at(v + 1, u + 1));
}

// Finds where the paint of a line ends.
class EndFinder {
 public:
  EndFinder(const cv::Mat& grey, const LabelProbe& probe) : grey_(grey), probe_(probe) {}

  struct End {
    Vector2d p;  // where the paint ends, on the line's axis
    double sigma_px;
  };
  // From a point on the line outwards; none where the end is hidden or beyond the picture.
  [[nodiscard]] std::optional<End> from(const Vector2d& start, const Vector2d& outward,
                                        double width) const {
    const BevGeometry& g = probe_.labels().geometry;
    const double step = 0.5 * g.metres_per_px;
    constexpr double kReach = 1.2;  // m
    constexpr double kClear = 0.2;  // m of floor that ends a line
    double last = 0.0;
    double s = 0.0;
    for (; s < kReach && s - last < kClear; s += step) {
      const Vector2d p = start + s * outward;
      if (probe_.isPaint(p) || isFaintPaint(p)) {
        last = s;
      } else if (probe_.isHidden(p)) {
        return std::nullopt;
      }
    }
    if (s >= kReach) return std::nullopt;
    const Vector2d at = start + (last + step) * outward;
    if (const auto shift = edge(at, outward, width)) return End{at + *shift * outward, 0.4};
    return End{at, 0.8};
  }

 private:
  // Worn ends of lines: floor by its label, and a slot's line nearly as likely.
  [[nodiscard]] bool isFaintPaint(const Vector2d& p) const {
    if (probe_.at(p) != SemanticClass::kFloor) return false;
    return probe_.slotEvidence(p) > kFaint;
  }

  // m along outward from where labels end to where the picture's edge is.
  [[nodiscard]] std::optional<double> edge(const Vector2d& at, const Vector2d& outward,
                                           double width) const {
    constexpr int kHalf = 12;  // samples each way, half a pixel apart
    const BevGeometry& g = probe_.labels().geometry;
    const double step = 0.5 * g.metres_per_px;
    const Vector2d aside(-outward.y(), outward.x());
    std::array<double, 2 * kHalf + 1> values{};
    for (int i = -kHalf; i <= kHalf; ++i) {
      for (const double k : {-0.25, 0.0, 0.25}) {
        values[static_cast<std::size_t>(i + kHalf)] +=
            greyAt(grey_, g.toPixel(at + i * step * outward + k * width * aside)) / 3.0;
      }
    }
    const auto mean = [&](int from, int to) {
      double sum = 0.0;
      for (int i = from; i <= to; ++i) sum += values[static_cast<std::size_t>(i + kHalf)];
      return sum / (to - from + 1);
    };
    // Close to the end: paint that meets the line may be all there is of it.
    const double paint = mean(-5, -3);
    const double floor = mean(5, 10);
    constexpr double kContrast = 8.0;
    if (std::abs(paint - floor) < kContrast) return std::nullopt;
    const double sign = paint > floor ? 1.0 : -1.0;
    const double level = 0.5 * (paint + floor);
    for (int i = -4; i < 5; ++i) {
      const double here = sign * (values[static_cast<std::size_t>(i + kHalf)] - level);
      const double next = sign * (values[static_cast<std::size_t>(i + 1 + kHalf)] - level);
      if (here >= 0.0 && next < 0.0) return (i + here / (here - next)) * step;
    }
    return std::nullopt;
  }

  const cv::Mat& grey_;
  const LabelProbe& probe_;
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
    for (std::size_t i = 0; i < strokes_.size(); ++i) loneBar(i);
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
    // line that passes, or at a bar's middle, has lost its own end.
    const bool passes = !short_one && t > 0.0 && t < other.length;
    const bool at_middle = short_one && std::abs(t - 0.5 * other.length) < kWithin;
    if (!passes && !at_middle && !reaches(side, s, mark.p)) return;
    if (!reaches(other, t, mark.p)) return;
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
    const LabelProbe::Shares between = probe_.along(stroke.begin + inside * stroke.along, p, 0.04);
    return gap <= kMeet ? between.floor < 0.5 : between.paint > 0.8;
  }

  void openEnd(std::size_t i, double sign) {
    const Stroke& side = strokes_[i];
    const Vector2d outward = sign * side.along;
    const Vector2d tip = sign > 0.0 ? side.end : side.begin;
    const double back = std::min(0.15, 0.5 * side.length);
    const auto end = ends_.from(tip - back * outward, outward, side.width);
    if (!end) return;
    SlotMark mark;
    // Lines end half their width beyond the corner.
    mark.p = end->p - 0.5 * side.width * outward;
    mark.side = static_cast<int>(i);
    mark.width = side.width;
    mark.sigma_along = std::hypot(end->sigma_px * pixel_, 0.01);
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
  EndFinder ends_;
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
