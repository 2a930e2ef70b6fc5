// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/preview.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/sim/world/plan_image.hpp"

namespace parkade::sim {
namespace {

const cv::Scalar kForwards(255, 160, 60);
const cv::Scalar kReverse(40, 40, 220);
const cv::Scalar kStop(0, 140, 255);

// A plan to draw on, in the places of drawPlan(Garage).
class Plan {
 public:
  Plan(const Garage& garage, double px_per_metre)
      : image(drawPlan(garage, px_per_metre)), scale_(px_per_metre) {
    constexpr double kMargin = 1.0;  // m
    low_ = {garage.min.x() - kMargin, garage.max.y() + kMargin};
  }

  [[nodiscard]] cv::Point at(const Eigen::Vector2d& p) const {
    return {static_cast<int>(std::lround((p.x() - low_.x()) * scale_)),
            static_cast<int>(std::lround((low_.y() - p.y()) * scale_))};
  }
  void outline(const std::vector<Eigen::Vector2d>& polygon, const cv::Scalar& colour) {
    std::vector<cv::Point> points;
    for (const Eigen::Vector2d& p : polygon) points.push_back(at(p));
    cv::polylines(image, points, true, colour, 1, cv::LINE_AA);
  }

  cv::Mat image;

 private:
  double scale_;
  Eigen::Vector2d low_;  // of the picture's first pixel
};

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

cv::Mat drawRoute(const Simulation& simulation, double px_per_metre) {
  Plan plan(simulation.garage(), px_per_metre);
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
