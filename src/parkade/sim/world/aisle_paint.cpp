// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "parkade/geometry/so3.hpp"
#include "parkade/sim/world/aisle_graph.hpp"
#include "parkade/sim/world/paint.hpp"
#include "parkade/sim/world/stroke_font.hpp"

namespace parkade::sim {
namespace {

struct Interval {
  double from = 0.0;
  double to = 0.0;
};

bool overlapsAny(const std::vector<Interval>& taken, double from, double to) {
  return std::any_of(taken.begin(), taken.end(),
                     [&](const Interval& i) { return from < i.to && to > i.from; });
}

/// Paints one aisle between two crossings. Positions s run along it from node `from`.
class StretchPainter {
 public:
  StretchPainter(const GarageStyle& style, Garage& garage, const AisleGraph::Edge& edge,
                 Random random)
      : style_(style), garage_(garage), edge_(edge), random_(random) {
    const Eigen::Vector2d a = garage.aisles.nodes[static_cast<std::size_t>(edge.from)];
    const Eigen::Vector2d b = garage.aisles.nodes[static_cast<std::size_t>(edge.to)];
    frame_ = {a, std::atan2(b.y() - a.y(), b.x() - a.x())};
    length_ = (b - a).norm();
    begin_ = 0.5 * edge.width;
    end_ = length_ - 0.5 * edge.width;
  }

  void paint() {
    if (end_ - begin_ < 4.0) return;
    addCrossing();
    addBump();
    for (const bool backward : {false, true}) {
      if (backward && edge_.one_way) break;
      addStopLine(backward);
      addTurnArrow(backward);
      addLimit(backward);
      addArrows(backward);
    }
    addCentreLine();
    addEdgeLines();
  }

 private:
  [[nodiscard]] double half() const { return 0.5 * edge_.width; }

  /// Directed frame; a position s from `from` becomes length - s when driven backward.
  [[nodiscard]] Frame2 lane(bool backward, double s) const {
    const double side = edge_.one_way ? 0.0 : backward ? 0.25 : -0.25;
    return {frame_ * Eigen::Vector2d(s, side * edge_.width),
            frame_.heading + (backward ? M_PI : 0.0)};
  }

  void addCrossing() {
    if (!random_.chance(style_.crossing_share)) return;
    constexpr double kDepth = 2.4;
    constexpr double kBar = 0.45;
    const bool at_end = random_.chance(0.5);
    const double from = at_end ? end_ - 0.5 - kDepth : begin_ + 0.5;
    std::vector<Polygon> bars;
    const double reach = half() - 0.3;
    const int count = static_cast<int>((2.0 * reach + kBar) / (2.0 * kBar));
    const double start = -0.5 * (2 * count - 1) * kBar;
    for (int i = 0; i < count; ++i) {
      const double y = start + 2 * i * kBar;
      bars.push_back(rectangle(frame_, from, y, from + kDepth, y + kBar));
    }
    addMarking(garage_, SemanticClass::kCrossing, std::move(bars), "",
               {frame_ * Eigen::Vector2d(from + 0.5 * kDepth, 0.0), frame_.heading},
               style_.arrow_colour);
    (at_end ? crossing_end_ : crossing_begin_) = kDepth + 0.5;
    for (std::vector<Interval>* taken : {&taken_[0], &taken_[1]}) {
      taken->push_back({from - 0.3, from + kDepth + 0.3});
    }
  }

  void addBump() {
    if (end_ - begin_ < 14.0 || !random_.chance(style_.bump_share)) return;
    const double s = random_.uniform(begin_ + 5.5, end_ - 5.5);
    const double width = edge_.width - 0.8;
    constexpr double kLength = 0.35;
    Garage::Bump bump;
    bump.center = frame_ * Eigen::Vector2d(s, 0.0);
    bump.heading = frame_.heading;
    bump.length = kLength;
    bump.width = width;
    bump.height = style_.bump_height;
    garage_.bumps.push_back(bump);
    addMarking(garage_, SemanticClass::kSpeedBump,
               {rectangle({bump.center, bump.heading}, -0.5 * kLength, -0.5 * width, 0.5 * kLength,
                          0.5 * width)},
               "", {bump.center, bump.heading}, style_.guide_colour);
    for (std::vector<Interval>* taken : {&taken_[0], &taken_[1]}) {
      taken->push_back({s - 0.7, s + 0.7});
    }
  }

  void addStopLine(bool backward) {
    const int node = backward ? edge_.from : edge_.to;
    const double crossing = backward ? crossing_begin_ : crossing_end_;
    const bool busy = neighboursOf(garage_.aisles, node).size() >= 3;
    if (crossing == 0.0 && !(busy && random_.chance(0.5))) return;
    constexpr double kThick = 0.30;
    const double back = crossing + 0.45;  // from the stretch's end
    const double s = backward ? begin_ + back : end_ - back - kThick;
    const double y0 = backward ? 0.12 : -half() + 0.35;
    const double y1 = backward || edge_.one_way ? half() - 0.35 : -0.12;
    addMarking(garage_, SemanticClass::kStopLine, {rectangle(frame_, s, y0, s + kThick, y1)}, "",
               lane(backward, s + 0.5 * kThick), style_.line_colour);
    taken_[backward ? 1 : 0].push_back({s - 0.2, s + kThick + 0.2});
  }

  void addArrowAt(bool backward, double s, const std::string& meaning) {
    const double reach = 0.5 * style_.arrow_length + 0.1;
    if (s - reach < begin_ || s + reach > end_) return;
    std::vector<Interval>& taken = taken_[backward ? 1 : 0];
    if (overlapsAny(taken, s - reach, s + reach)) return;
    const Frame2 place = lane(backward, s);
    std::vector<Polygon> polygons;
    for (const Polygon& p : arrowPolygons(meaning, style_.arrow_length)) {
      polygons.push_back(moved(place, p));
    }
    addMarking(garage_, SemanticClass::kArrow, std::move(polygons), meaning, place,
               style_.arrow_colour);
    taken.push_back({s - reach, s + reach});
  }

  void addTurnArrow(bool backward) {
    const int node = backward ? edge_.from : edge_.to;
    const int before = backward ? edge_.to : edge_.from;
    const std::string meaning = turnsAt(garage_.aisles, before, node);
    if (meaning.empty()) return;
    const double crossing = backward ? crossing_begin_ : crossing_end_;
    const double back = crossing + 1.3 + 0.5 * style_.arrow_length;
    addArrowAt(backward, backward ? begin_ + back : end_ - back, meaning);
  }

  void addArrows(bool backward) {
    const double first = random_.uniform(3.0, 7.0);
    for (double d = first; d < end_ - begin_ - 5.0; d += style_.arrow_spacing) {
      addArrowAt(backward, backward ? end_ - d : begin_ + d, "straight");
    }
  }

  void addLimit(bool backward) {
    if (end_ - begin_ < 12.0 || !random_.chance(0.3)) return;
    constexpr double kRadius = 0.9;
    const double back = random_.uniform(4.0, 6.0);
    const double s = backward ? end_ - back : begin_ + back;
    std::vector<Interval>& taken = taken_[backward ? 1 : 0];
    if (overlapsAny(taken, s - kRadius - 0.2, s + kRadius + 0.2)) return;
    const std::string text = std::to_string(static_cast<int>(std::lround(style_.limit_kmh)));
    const Frame2 place = lane(backward, s);
    Frame2 page = place;  // as its reader sees it: x to the right, y ahead
    page.heading -= M_PI_2;
    std::vector<Polygon> polygons;
    constexpr int kSides = 32;
    for (int i = 0; i < kSides; ++i) {
      const auto at = [&](int k, double r) {
        const double angle = 2.0 * M_PI * k / kSides;
        return Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle));
      };
      polygons.push_back(moved(page, {at(i, kRadius - 0.13), at(i, kRadius), at(i + 1, kRadius),
                                      at(i + 1, kRadius - 0.13)}));
    }
    constexpr double kTextHeight = 0.85;
    for (Polygon& p : textPolygons(text, kTextHeight, style_.text_weight)) {
      for (Eigen::Vector2d& q : p) q.y() -= 0.5 * kTextHeight;
      polygons.push_back(moved(page, p));
    }
    addMarking(garage_, SemanticClass::kSpeedLimitPaint, std::move(polygons), text, place,
               style_.arrow_colour);
    taken.push_back({s - kRadius - 0.2, s + kRadius + 0.2});
  }

  void addCentreLine() {
    if (!style_.centre_dashes || edge_.one_way) return;
    constexpr double kDash = 1.2;
    std::vector<Polygon> dashes;
    for (double s = begin_ + 0.8; s + kDash < end_ - 0.5; s += 3.0) {
      if (overlapsAny(taken_[0], s, s + kDash) && overlapsAny(taken_[1], s, s + kDash)) continue;
      dashes.push_back(
          rectangle(frame_, s, -0.5 * style_.line_width, s + kDash, 0.5 * style_.line_width));
    }
    if (dashes.empty()) return;
    addMarking(garage_, SemanticClass::kLaneLine, std::move(dashes), "centre",
               {frame_ * Eigen::Vector2d(0.5 * length_, 0.0), frame_.heading}, style_.guide_colour);
  }

  /// Along the sides, where no slot opens to the aisle.
  void addEdgeLines() {
    if (!style_.edge_lines) return;
    for (const double side : {1.0, -1.0}) {
      std::vector<Interval> open;
      for (const Slot& slot : garage_.slots) {
        const Eigen::Vector2d a = frame_.inverse(slot.corners[0]);
        const Eigen::Vector2d b = frame_.inverse(slot.corners[1]);
        const double distance = side * 0.5 * (a.y() + b.y()) - half();
        if (distance < -0.1 || distance > 1.0) continue;
        open.push_back({std::min(a.x(), b.x()) - 0.4, std::max(a.x(), b.x()) + 0.4});
      }
      open.push_back({end_, end_ + 1.0});
      std::sort(open.begin(), open.end(),
                [](const Interval& a, const Interval& b) { return a.from < b.from; });
      std::vector<Polygon> lines;
      const double y = side * (half() - 0.12);
      double from = begin_;
      for (const Interval& interval : open) {
        const double to = std::min(interval.from, end_);
        if (to - from > 1.0) {
          lines.push_back(rectangle(frame_, from, y - 0.5 * style_.line_width, to,
                                    y + 0.5 * style_.line_width));
        }
        from = std::max(from, interval.to);
      }
      if (lines.empty()) continue;
      addMarking(garage_, SemanticClass::kLaneLine, std::move(lines), "edge",
                 {frame_ * Eigen::Vector2d(0.5 * length_, y), frame_.heading}, style_.line_colour);
    }
  }

  const GarageStyle& style_;
  Garage& garage_;
  const AisleGraph::Edge& edge_;
  Random random_;
  Frame2 frame_;
  double length_ = 0.0;
  double begin_ = 0.0;
  double end_ = 0.0;
  double crossing_begin_ = 0.0;  ///< depth taken by a crossing at each end, m
  double crossing_end_ = 0.0;
  std::vector<Interval> taken_[2];  ///< per direction
};

}  // namespace

void paintAisles(const GarageStyle& style, Random random, Garage& garage) {
  const std::vector<AisleGraph::Edge> edges = garage.aisles.edges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    StretchPainter(style, garage, edges[i], random.fork("stretch", i)).paint();
  }
}

}  // namespace parkade::sim
