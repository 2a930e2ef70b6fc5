// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/drawing/draw_objects.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"

namespace parkade {
namespace {

constexpr int kShift = 4;  // of pixels, for lines finer than a pixel

class Canvas {
 public:
  Canvas(const cv::Mat& image, const BevGeometry& geometry, double scale)
      : geometry_(geometry), scale_(scale) {
    cv::resize(image, picture, {}, scale, scale, cv::INTER_NEAREST);
  }
  [[nodiscard]] cv::Point at(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d pixel =
        ((geometry_.toPixel(p) + Eigen::Vector2d(0.5, 0.5)) * scale_ - Eigen::Vector2d(0.5, 0.5)) *
        (1 << kShift);
    return {static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y()))};
  }
  void outline(const std::vector<Eigen::Vector2d>& corners, const cv::Scalar& colour, int width) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      cv::line(picture, at(corners[i]), at(corners[(i + 1) % corners.size()]), colour, width,
               cv::LINE_AA, kShift);
    }
  }
  void arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const cv::Scalar& colour,
             int width) {
    const Eigen::Vector2d back = from - to;
    const Eigen::Vector2d side(-back.y(), back.x());
    for (const Eigen::Vector2d& tail : {from, Eigen::Vector2d(to + 0.3 * back + 0.15 * side),
                                        Eigen::Vector2d(to + 0.3 * back - 0.15 * side)}) {
      cv::line(picture, at(tail), at(to), colour, width, cv::LINE_AA, kShift);
    }
  }
  void text(const Eigen::Vector2d& p, const std::string& letters, const cv::Scalar& colour) {
    const cv::Point pixel = at(p);
    cv::putText(picture, letters, {(pixel.x >> kShift) + 4, (pixel.y >> kShift) - 4},
                cv::FONT_HERSHEY_SIMPLEX, 0.33 * std::max(1.0, 0.7 * scale_), colour, 1,
                cv::LINE_AA);
  }
  void dot(const Eigen::Vector2d& p, const cv::Scalar& colour) {
    cv::circle(picture, at(p), (1 << kShift) * 2, colour, -1, cv::LINE_AA, kShift);
  }
  cv::Mat picture;

 private:
  BevGeometry geometry_;
  double scale_;
};

cv::Scalar colour(SemanticClass c) {
  const auto bgr = colourOf(c);
  return {static_cast<double>(bgr[0]), static_cast<double>(bgr[1]), static_cast<double>(bgr[2])};
}

}  // namespace

cv::Mat drawObjects(const cv::Mat& image, const BevGeometry& geometry,
                    const std::vector<ObjectObservation>& objects,
                    const std::vector<MovingObservation>& moving, double scale) {
  PARKADE_CHECK(image.type() == CV_8UC3, "type {}", image.type());
  Canvas canvas(image, geometry, scale);
  for (const ObjectObservation& object : objects) {
    const cv::Scalar c = colour(object.semantic_class);
    const Eigen::Vector2d p = object.position.head<2>();
    canvas.outline(object.outline, c, 1);
    canvas.dot(p, c);
    if (object.sigma_heading > 0.0) {
      const Eigen::Vector2d ahead(std::cos(object.heading), std::sin(object.heading));
      canvas.arrow(p - 0.5 * ahead, p + 0.5 * ahead, {255, 255, 255}, 1);
    }
    if (!object.text.empty()) canvas.text(p, object.text, {255, 255, 255});
  }
  for (const MovingObservation& agent : moving) {
    const cv::Scalar c = colour(agent.semantic_class);
    const int width = agent.moving ? 2 : 1;
    const Eigen::Vector2d ahead(std::cos(agent.heading), std::sin(agent.heading));
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    // The nearest corner, or the middle, lies on the contact.
    Eigen::Vector2d center = agent.contact;
    if (agent.semantic_class == SemanticClass::kVehicle) {
      const Eigen::Vector2d away = agent.contact - geometry.center;
      const double x = 0.5 * agent.size.x() * ahead.dot(away) / std::max(1e-6, away.norm());
      const double y = 0.5 * agent.size.y() * left.dot(away) / std::max(1e-6, away.norm());
      center += x * ahead + y * left;
    }
    const Eigen::Vector2d x = 0.5 * agent.size.x() * ahead;
    const Eigen::Vector2d y = 0.5 * agent.size.y() * left;
    canvas.outline({center - x - y, center + x - y, center + x + y, center - x + y}, c, width);
    canvas.dot(agent.contact, {255, 255, 255});
    if (agent.moving) {
      canvas.arrow(agent.contact, agent.contact + agent.velocity, {255, 255, 255}, 2);
    }
    if (agent.id != 0) canvas.text(agent.contact, std::to_string(agent.id), {255, 255, 255});
  }
  return canvas.picture;
}

std::vector<MovingObservation> untracked(const std::vector<AgentDetection>& agents) {
  std::vector<MovingObservation> moving;
  for (const AgentDetection& a : agents) {
    MovingObservation m;
    m.semantic_class = a.semantic_class;
    m.contact = a.contact;
    m.size = a.box.size;
    m.heading = a.box.heading;
    moving.push_back(m);
  }
  return moving;
}

}  // namespace parkade
