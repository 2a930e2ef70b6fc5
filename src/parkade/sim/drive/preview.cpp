// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/preview.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace parkade::sim {
namespace {

const cv::Scalar kOutside(70, 70, 70);
const cv::Scalar kFloor(225, 225, 225);
const cv::Scalar kRoom(150, 150, 150);
const cv::Scalar kOccupied(205, 190, 170);
const cv::Scalar kLine(120, 120, 120);
const cv::Scalar kPaint(150, 170, 90);
const cv::Scalar kPillar(60, 60, 60);
const cv::Scalar kForwards(200, 80, 20);
const cv::Scalar kReverse(40, 40, 220);
const cv::Scalar kStop(0, 140, 255);

class Plan {
 public:
  Plan(const Garage& garage, double px_per_metre) : scale_(px_per_metre) {
    constexpr double kMargin = 2.0;  // m
    low_ = garage.min - Eigen::Vector2d::Constant(kMargin);
    high_ = garage.max + Eigen::Vector2d::Constant(kMargin);
    const Eigen::Vector2d size = (high_ - low_) * scale_;
    image = cv::Mat(static_cast<int>(size.y()), static_cast<int>(size.x()), CV_8UC3, kOutside);
  }

  [[nodiscard]] cv::Point at(const Eigen::Vector2d& p) const {
    return {static_cast<int>(std::lround((p.x() - low_.x()) * scale_)),
            static_cast<int>(std::lround((high_.y() - p.y()) * scale_))};
  }
  template <class Points>
  [[nodiscard]] std::vector<cv::Point> points(const Points& polygon) const {
    std::vector<cv::Point> result;
    for (const Eigen::Vector2d& p : polygon) result.push_back(at(p));
    return result;
  }
  template <class Points>
  void fill(const Points& polygon, const cv::Scalar& colour) {
    cv::fillPoly(image, std::vector<std::vector<cv::Point>>{points(polygon)}, colour, cv::LINE_AA);
  }
  template <class Points>
  void outline(const Points& polygon, const cv::Scalar& colour) {
    cv::polylines(image, points(polygon), true, colour, 1, cv::LINE_AA);
  }
  void box(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const cv::Scalar& colour) {
    cv::rectangle(image, at(low), at(high), colour, cv::FILLED);
  }

  cv::Mat image;

 private:
  double scale_;
  Eigen::Vector2d low_, high_;
};

void drawGarage(const Garage& garage, Plan& plan) {
  plan.fill(garage.outline, kFloor);
  for (const Room& room : garage.rooms) plan.box(room.min, room.max, kRoom);
  for (const Slot& slot : garage.slots) {
    if (slot.occupied) plan.fill(slot.corners, kOccupied);
    plan.outline(slot.corners, kLine);
  }
  for (const Marking& marking : garage.markings) {
    if (marking.semantic_class == SemanticClass::kSlotLine) continue;
    for (const auto& polygon : marking.polygons) plan.fill(polygon, kPaint);
  }
  for (const Pillar& pillar : garage.pillars) {
    plan.box(pillar.center - 0.5 * pillar.size, pillar.center + 0.5 * pillar.size, kPillar);
  }
}

void drawCar(const PathPoint& axle, const VehicleShape& car, const cv::Scalar& colour, Plan& plan) {
  const Eigen::Vector2d forward(std::cos(axle.heading), std::sin(axle.heading));
  const Eigen::Vector2d left = 0.5 * car.width * Eigen::Vector2d(-forward.y(), forward.x());
  const Eigen::Vector2d front = axle.position + (car.wheelbase + car.front_overhang) * forward;
  const Eigen::Vector2d rear = axle.position - car.rear_overhang * forward;
  const std::vector<Eigen::Vector2d> outline{rear - left, front - left, front + left, rear + left};
  plan.outline(outline, colour);
  cv::line(plan.image, plan.at(front - left), plan.at(front + left), colour, 3, cv::LINE_AA);
}

}  // namespace

cv::Mat drawPlan(const Simulation& simulation, double px_per_metre) {
  Plan plan(simulation.garage(), px_per_metre);
  drawGarage(simulation.garage(), plan);
  const Route& route = simulation.route();
  const VehicleShape car = simulation.trueRig().vehicle.value_or(VehicleShape{});
  constexpr double kStep = 0.2;    // m
  constexpr double kGhost = 12.0;  // m between outlines of the car
  PathPoint last = route.path.at(0.0);
  for (double s = kStep; s < route.path.length(); s += kStep) {
    const PathPoint point = route.path.at(s);
    cv::line(plan.image, plan.at(last.position), plan.at(point.position),
             point.direction > 0 ? kForwards : kReverse, 2, cv::LINE_AA);
    if (std::fmod(s, kGhost) < kStep) drawCar(point, car, kForwards, plan);
    last = point;
  }
  for (const Stop& stop : route.stops) {
    cv::circle(plan.image, plan.at(route.path.at(stop.s).position), 5, kStop, cv::FILLED,
               cv::LINE_AA);
  }
  drawCar(route.path.at(route.path.length()), car, kReverse, plan);
  cv::circle(plan.image, plan.at(route.path.at(0.0).position), 6, kForwards, cv::FILLED,
             cv::LINE_AA);
  return plan.image;
}

}  // namespace parkade::sim
