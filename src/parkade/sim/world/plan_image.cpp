// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/plan_image.hpp"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/stroke_font.hpp"

namespace parkade::sim {
namespace {

constexpr double kMargin = 1.0;  // m
constexpr int kShift = 4;        // fractional bits of OpenCV's drawing coordinates

class Canvas {
 public:
  Canvas(const Garage& garage, double px_per_metre)
      : origin_(garage.min - Eigen::Vector2d::Constant(kMargin)), scale_(px_per_metre) {
    const Eigen::Vector2d size = garage.max - garage.min + Eigen::Vector2d::Constant(2.0 * kMargin);
    image_ =
        cv::Mat(static_cast<int>(std::ceil(size.y() * scale_)),
                static_cast<int>(std::ceil(size.x() * scale_)), CV_8UC3, cv::Scalar(120, 120, 120));
  }

  void fill(const Polygon& polygon, const cv::Scalar& colour) {
    const std::vector<cv::Point> points = pixels(polygon);
    cv::fillConvexPoly(image_, points, colour, cv::LINE_AA, kShift);
  }

  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const cv::Scalar& colour,
            int thickness) {
    cv::line(image_, pixel(a), pixel(b), colour, thickness, cv::LINE_AA, kShift);
  }

  void text(const std::string& text, const Frame2& at, double height, const cv::Scalar& colour) {
    for (Polygon& polygon : textPolygons(text, height, 0.16)) {
      for (Eigen::Vector2d& p : polygon) p.y() -= 0.5 * height;
      fill(moved(at, polygon), colour);
    }
  }

  void disc(const Eigen::Vector2d& center, double radius, const cv::Scalar& colour) {
    cv::circle(image_, pixel(center), static_cast<int>(std::lround(radius * scale_ * 16)), colour,
               cv::FILLED, cv::LINE_AA, kShift);
  }

  [[nodiscard]] cv::Mat image() const { return image_; }

 private:
  [[nodiscard]] cv::Point pixel(const Eigen::Vector2d& p) const {
    const double x = (p.x() - origin_.x()) * scale_;
    const double y = image_.rows - (p.y() - origin_.y()) * scale_;
    return {static_cast<int>(std::lround(x * (1 << kShift))),
            static_cast<int>(std::lround(y * (1 << kShift)))};
  }

  [[nodiscard]] std::vector<cv::Point> pixels(const Polygon& polygon) const {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& p : polygon) points.push_back(pixel(p));
    return points;
  }

  Eigen::Vector2d origin_;
  double scale_;
  cv::Mat image_;
};

Polygon boxAt(const Frame2& frame, double half_x, double half_y) {
  return rectangle(frame, -half_x, -half_y, half_x, half_y);
}

void drawCar(const Slot& slot, Canvas& canvas) {
  const Eigen::Vector2d front = 0.5 * (slot.corners[0] + slot.corners[1]);
  const Eigen::Vector2d rear = 0.5 * (slot.corners[2] + slot.corners[3]);
  Eigen::Vector2d axis = rear - front;
  if (slot.type == SlotType::kParallel) axis = slot.corners[1] - slot.corners[0];
  const Frame2 car{0.5 * (front + rear), std::atan2(axis.y(), axis.x())};
  canvas.fill(boxAt(car, 2.25, 0.9), {130, 100, 70});
  canvas.fill(boxAt(car, 1.2, 0.75), {90, 65, 45});
}

}  // namespace

cv::Scalar classColour(SemanticClass semantic_class) {
  static const std::array<cv::Scalar, kNumSemanticClasses> colours = {{{0, 0, 0},
                                                                       {70, 70, 70},
                                                                       {245, 245, 245},
                                                                       {70, 190, 245},
                                                                       {255, 220, 120},
                                                                       {120, 120, 255},
                                                                       {200, 120, 255},
                                                                       {255, 255, 160},
                                                                       {0, 165, 255},
                                                                       {190, 230, 190},
                                                                       {30, 120, 190},
                                                                       {60, 170, 60},
                                                                       {150, 110, 90},
                                                                       {40, 40, 60},
                                                                       {180, 60, 40},
                                                                       {60, 60, 230},
                                                                       {60, 230, 120},
                                                                       {230, 200, 0},
                                                                       {0, 0, 200}}};
  return colours[static_cast<std::size_t>(semantic_class)];
}

cv::Mat drawPlan(const Garage& garage, double px_per_metre) {
  PARKADE_CHECK(px_per_metre > 0.0, "px_per_metre is {}", px_per_metre);
  Canvas canvas(garage, px_per_metre);
  canvas.fill(garage.outline, classColour(SemanticClass::kFloor));
  for (const Marking& marking : garage.markings) {
    for (const Polygon& polygon : marking.polygons) {
      canvas.fill(polygon, classColour(marking.semantic_class));
    }
  }
  for (const Slot& slot : garage.slots) {
    if (slot.occupied) drawCar(slot, canvas);
    const Eigen::Vector2d middle =
        0.25 * (slot.corners[0] + slot.corners[1] + slot.corners[2] + slot.corners[3]);
    canvas.text(slot.number, {middle, 0.0}, 0.8, {255, 255, 255});
  }
  for (const Room& room : garage.rooms) {
    canvas.fill(rectangle({}, room.min.x(), room.min.y(), room.max.x(), room.max.y()),
                classColour(SemanticClass::kWall));
  }
  for (const Pillar& pillar : garage.pillars) {
    if (pillar.round) {
      canvas.disc(pillar.center, 0.5 * pillar.size.x(), classColour(SemanticClass::kPillar));
    } else {
      canvas.fill(boxAt({pillar.center, 0.0}, 0.5 * pillar.size.x(), 0.5 * pillar.size.y()),
                  classColour(SemanticClass::kPillar));
    }
    canvas.text(pillar.zone_text, {pillar.center + Eigen::Vector2d(0.0, 0.75), 0.0}, 0.6,
                classColour(SemanticClass::kZoneMarker));
  }
  for (const Sign& sign : garage.signs) {
    if (sign.semantic_class == SemanticClass::kZoneMarker) continue;
    const Eigen::Vector2d p = sign.T_world_sign.translation().head<2>();
    const Eigen::Vector2d x = sign.T_world_sign.rotation().matrix().col(0).head<2>();
    canvas.fill(strip(p - 0.5 * sign.width * x, p + 0.5 * sign.width * x, 0.15),
                classColour(sign.semantic_class));
  }
  for (const AisleGraph::Edge& edge : garage.aisles.edges) {
    canvas.line(garage.aisles.nodes[static_cast<std::size_t>(edge.from)],
                garage.aisles.nodes[static_cast<std::size_t>(edge.to)], {110, 90, 90}, 1);
  }
  const cv::Scalar wall = classColour(SemanticClass::kWall);
  for (std::size_t i = 0; i < garage.outline.size(); ++i) {
    canvas.fill(
        strip(garage.outline[i], garage.outline[(i + 1) % garage.outline.size()], 0.3, 0.15), wall);
  }
  for (const Entrance& entrance : garage.entrances) {
    const Frame2 at{entrance.center, entrance.heading};
    canvas.fill(boxAt(at, 0.3, 0.5 * entrance.width), {255, 255, 255});
  }
  return canvas.image();
}

}  // namespace parkade::sim
