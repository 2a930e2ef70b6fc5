// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/marking_arrows.hpp"

#include <opencv2/imgproc.hpp>

namespace parkade {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

// Shares of an arrow's length from the tail to the tip of a straight one.
struct ArrowStyle {
  double shaft;        // width
  double head_length;  // of the straight head
  double head_half;    // half of a head's width
  double arm;          // from the shaft's middle to the base of a side's head
  double arm_head;     // length of a side's head
  double turn;         // height of the arms of an arrow that only turns
  double fork;         // height of the arms of an arrow that also goes straight on
};

// Slender ones as on factory and garage floors, stout ones as on roads.
constexpr ArrowStyle kStyles[] = {{0.065, 0.36, 0.115, 0.13, 0.29, 0.80, 0.48},
                                  {0.100, 0.32, 0.170, 0.16, 0.26, 0.78, 0.45},
                                  {0.065, 0.25, 0.090, 0.13, 0.22, 0.82, 0.55}};

Outline box(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

void addArm(const ArrowStyle& style, double x, double side, std::vector<Outline>& out) {
  const double half = 0.5 * style.shaft;
  out.push_back(box(x - half, 0.0, x + half, side * style.arm));
  out.push_back({{x - style.head_half, side * style.arm},
                 {x + style.head_half, side * style.arm},
                 {x, side * (style.arm + style.arm_head)}});
}

MarkingShape arrow(const ArrowStyle& style, bool straight, bool left, bool right, double between) {
  std::string meaning;
  const auto add = [&meaning](bool there, const char* name) {
    if (there) meaning += (meaning.empty() ? "" : "_") + std::string(name);
  };
  add(straight, "straight");
  add(left, "left");
  add(right, "right");
  const double half = 0.5 * style.shaft;
  const double arms = straight ? style.fork : style.turn;
  std::vector<Outline> outlines;
  if (straight) {
    const double neck = 1.0 - style.head_length;
    outlines.push_back(box(0.0, -half, neck, half));
    outlines.push_back({{neck, -style.head_half}, {1.0, 0.0}, {neck, style.head_half}});
  } else {
    outlines.push_back(box(0.0, -half, arms + half, half));
  }
  if (left) addArm(style, arms, 1.0, outlines);
  if (right) addArm(style, straight && left ? arms - between : arms, -1.0, outlines);
  return {meaning, outlines};
}

MarkingShape arms(const ArrowStyle& style) {
  std::vector<Outline> outlines;
  addArm(style, 0.0, 1.0, outlines);
  addArm(style, 0.0, -1.0, outlines);
  for (Outline& outline : outlines) {
    for (Eigen::Vector2d& p : outline) p = {p.y(), -p.x()};
  }
  return {"", outlines};
}

MarkingShape text(const std::string& letters, double weight) {
  constexpr double kScale = 6.0;  // Hershey capitals are 21 px high at scale 1
  constexpr double kHeight = 21.0 * kScale;
  const int thickness = static_cast<int>(weight * kHeight);
  int below = 0;
  const cv::Size size =
      cv::getTextSize(letters, cv::FONT_HERSHEY_SIMPLEX, kScale, thickness, &below);
  cv::Mat picture(size.height + 3 * thickness + below, size.width + 4 * thickness, CV_8UC1,
                  cv::Scalar(0));
  cv::putText(picture, letters, {2 * thickness, size.height + thickness}, cv::FONT_HERSHEY_SIMPLEX,
              kScale, cv::Scalar(255), thickness, cv::LINE_8);
  return {letters, picture};
}

}  // namespace

std::vector<MarkingShape> arrowShapes() {
  std::vector<MarkingShape> shapes;
  for (const ArrowStyle& style : kStyles) {
    for (int bits = 1; bits < 8; ++bits) {
      const bool straight = (bits & 1) != 0;
      const bool left = (bits & 2) != 0;
      const bool right = (bits & 4) != 0;
      shapes.push_back(arrow(style, straight, left, right, 0.0));
      if (bits == 7) shapes.push_back(arrow(style, straight, left, right, 0.12));
    }
  }
  for (const double width : {0.06, 0.11, 0.18}) {
    shapes.push_back({"", {box(0.0, -0.5 * width, 1.0, 0.5 * width)}});
  }
  // Both arms of an arrow whose shaft is worn or hidden.
  for (const ArrowStyle& style : kStyles) shapes.push_back(arms(style));
  return shapes;
}

std::vector<MarkingShape> limitShapes() {
  std::vector<MarkingShape> shapes;
  for (const char* number : {"5", "8", "10", "15", "20", "30", "40"}) {
    for (const double weight : {0.12, 0.2}) shapes.push_back(text(number, weight));
  }
  return shapes;
}

std::vector<MarkingShape> digitShapes() {
  std::vector<MarkingShape> shapes;
  for (int digit = 0; digit < 10; ++digit) {
    for (const double weight : {0.12, 0.2}) shapes.push_back(text(std::to_string(digit), weight));
  }
  return shapes;
}

}  // namespace parkade
