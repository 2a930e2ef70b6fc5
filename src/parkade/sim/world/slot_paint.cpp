// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "parkade/sim/world/paint.hpp"
#include "parkade/sim/world/stroke_font.hpp"

namespace parkade::sim {
namespace {

constexpr double kCornerBar = 0.30;   // m, of T and L markings along the entrance
constexpr double kHatchPitch = 0.75;  // m between hatch stripes

/// A slot's own frame: origin in the middle of the entrance, y into the slot.
struct SlotFrame {
  explicit SlotFrame(const Slot& slot) {
    const Eigen::Vector2d front = slot.corners[1] - slot.corners[0];
    frame.origin = 0.5 * (slot.corners[0] + slot.corners[1]);
    frame.heading = std::atan2(front.y(), front.x());
    const Eigen::Vector2d rear = 0.5 * (slot.corners[2] + slot.corners[3]);
    axis = frame.inverse(rear);
    width = front.norm();
  }
  Frame2 frame;
  Eigen::Vector2d axis;  ///< from the entrance's middle to the rear's
  double width;
};

/// Lines that several slots share are painted once.
class LineBook {
 public:
  bool isNew(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const auto key = [](const Eigen::Vector2d& p) {
      return std::make_pair(std::llround(p.x() * 1000.0), std::llround(p.y() * 1000.0));
    };
    return seen_.insert(std::minmax(key(a), key(b))).second;
  }

 private:
  using Point = std::pair<long long, long long>;
  std::set<std::pair<Point, Point>> seen_;
};

void addLine(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width, LineBook& book,
             std::vector<Polygon>& out) {
  if (book.isNew(a, b)) out.push_back(strip(a, b, width, 0.5 * width));
}

std::vector<Polygon> slotLines(const Slot& slot, double width, LineBook& book) {
  std::vector<Polygon> lines;
  const auto& c = slot.corners;
  const Eigen::Vector2d along = (c[1] - c[0]).normalized();
  addLine(c[0], c[3], width, book, lines);
  addLine(c[1], c[2], width, book, lines);
  switch (slot.marking) {
    case SlotMarking::kClosed:
      addLine(c[0], c[1], width, book, lines);
      addLine(c[2], c[3], width, book, lines);
      break;
    case SlotMarking::kTShaped:
      for (const Eigen::Vector2d& corner : {c[0], c[1]}) {
        addLine(corner - kCornerBar * along, corner + kCornerBar * along, width, book, lines);
      }
      break;
    case SlotMarking::kLShaped:
      addLine(c[0], c[0] + kCornerBar * along, width, book, lines);
      addLine(c[1] - kCornerBar * along, c[1], width, book, lines);
      break;
    case SlotMarking::kOpen:
      break;
  }
  return lines;
}

void addNumber(const Slot& slot, const SlotFrame& place, const GarageStyle& style, Garage& garage) {
  if (style.number_height <= 0.0 || slot.number.empty()) return;
  const double width = textWidth(slot.number, style.number_height, style.text_weight);
  const double height = style.number_height * std::min(1.0, 0.7 * place.width / width);
  const Eigen::Vector2d base = Eigen::Vector2d(0.0, 0.18) + style.number_depth * place.axis;
  Frame2 text = place.frame;
  text.origin = place.frame * base;
  std::vector<Polygon> polygons;
  for (const Polygon& p : textPolygons(slot.number, height, style.text_weight)) {
    polygons.push_back(moved(text, p));
  }
  Frame2 where = text;
  where.heading += M_PI_2;
  addMarking(garage, SemanticClass::kPaintedNumber, std::move(polygons), slot.number, where,
             style.line_colour);
}

void addWheelStop(const Slot& slot, const SlotFrame& place, const GarageStyle& style,
                  Garage& garage) {
  if (slot.type == SlotType::kParallel || !style.wheel_stops) return;
  const double length = place.axis.norm();
  const double half = std::min(0.5 * style.wheel_stop_length, 0.42 * place.width);
  Frame2 stop = place.frame;
  stop.origin = place.frame * ((length - 0.75) / length * place.axis);
  // Across the slot's own axis, also where it is slanted.
  stop.heading += std::atan2(place.axis.y(), place.axis.x()) - M_PI_2;
  std::vector<Polygon> polygons;
  if (style.wheel_stop_pair) {
    polygons.push_back(rectangle(stop, -half, -0.075, -half + 0.55, 0.075));
    polygons.push_back(rectangle(stop, half - 0.55, -0.075, half, 0.075));
  } else {
    polygons.push_back(rectangle(stop, -half, -0.075, half, 0.075));
  }
  Frame2 where = stop;
  where.heading += M_PI_2;
  addMarking(garage, SemanticClass::kWheelStop, std::move(polygons), "", where, style.guide_colour);
}

/// A white wheelchair user on a blue field.
void addAccessibleSign(const SlotFrame& place, const GarageStyle& style, Garage& garage) {
  Frame2 at = place.frame;
  at.origin = place.frame * (0.5 * place.axis);
  Frame2 where = at;
  where.heading += M_PI_2;
  addMarking(garage, SemanticClass::kPaintedNumber, {rectangle(at, -0.75, -0.75, 0.75, 0.75)},
             "accessible_field", where, style.reserved_colour);
  const std::array<std::array<double, 4>, 5> strokes = {{{-0.05, 0.30, 0.0, -0.05},
                                                         {0.0, -0.05, 0.28, -0.05},
                                                         {0.28, -0.05, 0.42, -0.42},
                                                         {-0.02, 0.15, 0.24, 0.15},
                                                         {-0.05, 0.46, -0.04, 0.47}}};
  std::vector<Polygon> polygons;
  for (const auto& s : strokes) {
    polygons.push_back(moved(at, strip({s[0], s[1]}, {s[2], s[3]}, 0.1, 0.05)));
  }
  constexpr int kSides = 12;  // the wheel: an open ring
  for (int i = 1; i < kSides - 2; ++i) {
    const auto rim = [&](int k) -> Eigen::Vector2d {
      const double angle = 1.9 + 2.0 * M_PI * k / kSides;
      return Eigen::Vector2d(0.0, -0.22) + 0.33 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    };
    polygons.push_back(moved(at, strip(rim(i), rim(i + 1), 0.08, 0.02)));
  }
  addMarking(garage, SemanticClass::kPaintedNumber, std::move(polygons), "accessible", where,
             style.line_colour);
}

/// Stripes at 45 degrees with a border: no parking.
void addHatching(const Frame2& frame, double x0, double y0, double x1, double y1,
                 const GarageStyle& style, Garage& garage) {
  std::vector<Polygon> polygons;
  const double w = style.line_width;
  for (double s = x0 - (y1 - y0) + 0.4; s < x1; s += kHatchPitch) {
    const Polygon stripe = strip({s, y0}, {s + (y1 - y0), y1}, w, 0.5);
    const Polygon clipped = clipToRectangle(stripe, {}, x0, y0, x1, y1);
    if (clipped.size() >= 3 && signedArea(clipped) > 1e-3) {
      polygons.push_back(moved(frame, clipped));
    }
  }
  polygons.push_back(rectangle(frame, x0, y0, x1, y0 + w));
  polygons.push_back(rectangle(frame, x0, y1 - w, x1, y1));
  polygons.push_back(rectangle(frame, x0, y0, x0 + w, y1));
  polygons.push_back(rectangle(frame, x1 - w, y0, x1, y1));
  Frame2 where = frame;
  where.origin = frame * Eigen::Vector2d(0.5 * (x0 + x1), 0.5 * (y0 + y1));
  addMarking(garage, SemanticClass::kLaneLine, std::move(polygons), "no_parking", where,
             style.guide_colour);
}

}  // namespace

Polygon clipToRectangle(const Polygon& polygon, const Frame2& frame, double x0, double y0,
                        double x1, double y1) {
  // Sutherland and Hodgman: one side after the other, in the frame's axes.
  Polygon points;
  for (const Eigen::Vector2d& p : polygon) points.push_back(frame.inverse(p));
  const std::array<std::array<double, 3>, 4> sides = {
      {{1.0, 0.0, -x0}, {-1.0, 0.0, x1}, {0.0, 1.0, -y0}, {0.0, -1.0, y1}}};
  for (const auto& side : sides) {
    Polygon next;
    const auto value = [&](const Eigen::Vector2d& p) {
      return side[0] * p.x() + side[1] * p.y() + side[2];
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector2d& a = points[i];
      const Eigen::Vector2d& b = points[(i + 1) % points.size()];
      const double va = value(a);
      const double vb = value(b);
      if (va >= 0.0) next.push_back(a);
      if ((va > 0.0 && vb < 0.0) || (va < 0.0 && vb > 0.0)) {
        next.push_back(a + va / (va - vb) * (b - a));
      }
    }
    points = std::move(next);
  }
  return moved(frame, points);
}

Marking& addMarking(Garage& garage, SemanticClass semantic_class, std::vector<Polygon> polygons,
                    const std::string& meaning, const Frame2& place,
                    const Eigen::Vector3f& colour) {
  Marking marking;
  marking.id = static_cast<int>(garage.markings.size()) + 1;
  marking.semantic_class = semantic_class;
  marking.polygons = std::move(polygons);
  marking.meaning = meaning;
  marking.position = place.origin;
  marking.heading = place.heading;
  marking.colour = colour;
  garage.markings.push_back(std::move(marking));
  return garage.markings.back();
}

void paintSlots(const Layout& layout, const GarageStyle& style, Garage& garage) {
  LineBook book;
  for (const Slot& slot : garage.slots) {
    const SlotFrame place(slot);
    Frame2 where = place.frame;
    where.origin = place.frame * (0.5 * place.axis);
    where.heading += std::atan2(place.axis.y(), place.axis.x());
    const bool accessible =
        slot.type == SlotType::kPerpendicular && place.width > style.slot_width + 0.2;
    std::vector<Polygon> lines = slotLines(slot, style.line_width, book);
    if (!lines.empty()) {
      addMarking(garage, SemanticClass::kSlotLine, std::move(lines), "slot " + slot.number, where,
                 accessible ? style.reserved_colour : style.line_colour);
    }
    if (accessible) addAccessibleSign(place, style, garage);
    addNumber(slot, place, style, garage);
    addWheelStop(slot, place, style, garage);
  }
  const double gap = style.pillar_size + 0.1;
  for (const Row& row : layout.rows) {
    for (const Bay& bay : row.bays) {
      if (bay.kind != BayKind::kHatched) continue;
      addHatching(row.front, bay.start + 0.5 * gap, 0.05, bay.start + bay.length - 0.5 * gap,
                  std::min(style.slot_length, row.depth - 0.1), style, garage);
    }
  }
}

}  // namespace parkade::sim
