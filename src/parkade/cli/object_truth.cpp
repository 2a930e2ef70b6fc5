// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/object_truth.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/cli/marking_box.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/frame_evidence.hpp"
#include "parkade/semantics/markings/marking_pieces.hpp"
#include "parkade/sim/world/parked_cars.hpp"

namespace parkade::cli {
namespace {

constexpr double kPictureReach = 12.0;  // m: farther objects lie outside any picture
constexpr double kRange = 10.0;         // m: objects up to here count

using Polygons = std::vector<std::vector<Eigen::Vector2d>>;

class TruthCollector {
 public:
  TruthCollector(const SemanticSampler& sampler, const SemanticSample& sample,
                 const BevViews& views)
      : sampler_(sampler),
        sample_(sample),
        views_(views),
        T_level_world_(SE2::fromSE3(sample.T_world_vehicle).inverse()) {}

  std::vector<TrueObject> collect() {
    for (const sim::Marking& marking : sampler_.simulation().garage().markings) addMarking(marking);
    for (const sim::Pillar& pillar : sampler_.simulation().garage().pillars) {
      GroundBox box;
      box.center = pillar.center;
      box.size = pillar.round ? Eigen::Vector2d::Constant(pillar.size.x()) : pillar.size;
      addUpright(SemanticClass::kPillar, box);
    }
    for (const sim::StaticObject& object : sampler_.scene().objects) {
      if (object.instance >= sim::kParkedInstance) addParked(object);
    }
    for (const sim::MovingObject& object : sampler_.scene().moving) {
      const SE2 pose = SE2::fromSE3(object.pose(sample_.t));
      GroundBox box;
      box.center = pose.translation();
      box.heading = pose.angle();
      box.size = object.box_size.head<2>();
      addUpright(object.label, box);
    }
    return std::move(objects_);
  }

 private:
  [[nodiscard]] const BevGeometry& geometry() const { return sample_.bev.geometry; }
  [[nodiscard]] bool isNear(const Eigen::Vector2d& p_world) const {
    return (T_level_world_ * p_world - geometry().center).norm() < kPictureReach;
  }

  void addMarking(const sim::Marking& marking) {
    if (roleOf(marking.semantic_class) != LayerRole::kRoadMarker || !isNear(marking.position))
      return;
    if (marking.semantic_class != SemanticClass::kWheelStop) {
      addPaint(marking, marking.polygons);
      return;
    }
    for (const auto& polygon : marking.polygons) addPaint(marking, {polygon});
  }

  void addPaint(const sim::Marking& marking, const Polygons& polygons) {
    TrueObject object;
    object.semantic_class = marking.semantic_class;
    object.position = T_level_world_ * middleOf(marking, polygons);
    object.heading = wrapAngle(marking.heading + T_level_world_.angle());
    object.text = marking.meaning;
    object.in_sight = object.position.norm() < kRange && inSight(polygons, object.semantic_class);
    objects_.push_back(object);
  }

  // Drawn on the floor as the picture has it, but for the error of its attitude.
  [[nodiscard]] bool inSight(const Polygons& polygons, SemanticClass c) const {
    constexpr int kMargin = 4;  // px
    cv::Mat mask(sample_.bev_labels.size(), CV_8UC1, cv::Scalar(0));
    int area = 0;
    for (const auto& polygon : polygons) {
      std::vector<Eigen::Vector2d> corners;
      for (const Eigen::Vector2d& p : polygon) {
        corners.emplace_back(geometry().toPixel(T_level_world_ * p));
        if (corners.back().minCoeff() < kMargin + 1 ||
            corners.back().x() > mask.cols - 2 - kMargin ||
            corners.back().y() > mask.rows - 2 - kMargin) {
          return false;
        }
      }
      area += fill(corners, kMargin, mask);
    }
    int hidden = 0;
    int painted = 0;
    for (int v = 0; v < mask.rows; ++v) {
      for (int u = 0; u < mask.cols; ++u) {
        if (mask.at<std::uint8_t>(v, u) == 0) continue;
        const auto label = static_cast<SemanticClass>(sample_.bev_labels.at<std::uint8_t>(v, u));
        hidden += hidesGround(label) ? 1 : 0;
        painted += label == c ? 1 : 0;
      }
    }
    // Paint that is nearly worn away is not there to be found.
    constexpr double kLeft = 0.6;
    return hidden == 0 && painted > kLeft * area;
  }

  // Marks the pixels of a convex polygon and those around them; returns how many are its own.
  static int fill(const std::vector<Eigen::Vector2d>& corners, int margin, cv::Mat& mask) {
    Eigen::Vector2d low = corners.front();
    Eigen::Vector2d high = corners.front();
    for (const Eigen::Vector2d& p : corners) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    int count = 0;
    for (int v = static_cast<int>(low.y()); v <= static_cast<int>(high.y()) + 1; ++v) {
      for (int u = static_cast<int>(low.x()); u <= static_cast<int>(high.x()) + 1; ++u) {
        double least = 0.0;
        double most = 0.0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
          const Eigen::Vector2d e = corners[(i + 1) % corners.size()] - corners[i];
          const Eigen::Vector2d d = Eigen::Vector2d(u, v) - corners[i];
          const double side = e.x() * d.y() - e.y() * d.x();
          least = std::min(least, side);
          most = std::max(most, side);
        }
        if (least < 0.0 && most > 0.0) continue;
        ++count;
        for (int y = v - margin; y <= v + margin; ++y) {
          for (int x = u - margin; x <= u + margin; ++x) {
            if (x >= 0 && y >= 0 && x < mask.cols && y < mask.rows) mask.at<std::uint8_t>(y, x) = 1;
          }
        }
      }
    }
    return count;
  }

  void addParked(const sim::StaticObject& object) {
    if (!isNear(object.T_world_mesh.translation().head<2>())) return;
    // The body up to the bumpers: mirrors and roofs do not meet the floor.
    constexpr float kBumper = 0.6F;
    const sim::Mesh& mesh = sampler_.scene().meshes[static_cast<std::size_t>(object.mesh)];
    Eigen::Vector2f low = Eigen::Vector2f::Constant(1e9F);
    Eigen::Vector2f high = -low;
    for (const Eigen::Vector3f& v : mesh.vertices) {
      if (v.z() > kBumper) continue;
      low = low.cwiseMin(v.head<2>());
      high = high.cwiseMax(v.head<2>());
    }
    const SE2 pose = SE2::fromSE3(object.T_world_mesh);
    GroundBox box;
    box.center = pose * Eigen::Vector2d((0.5F * (low + high)).cast<double>());
    box.heading = pose.angle();
    box.size = (high - low).cast<double>();
    addUpright(SemanticClass::kVehicle, box);
  }

  void addUpright(SemanticClass c, GroundBox box) {
    if (!isNear(box.center)) return;
    box.center = T_level_world_ * box.center;
    box.heading = wrapAngle(box.heading + T_level_world_.angle());
    TrueObject object;
    object.semantic_class = c;
    object.box = box;
    object.position = c == SemanticClass::kVehicle ? box.nearestTo(geometry().center) : box.center;
    object.heading = box.heading;
    const Eigen::Vector2d meets =
        c == SemanticClass::kPedestrian ? box.center : box.nearestTo(geometry().center);
    object.in_sight = object.position.norm() < kRange && seen(c, meets);
    objects_.push_back(object);
  }

  [[nodiscard]] SemanticClass labelAt(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d pixel = geometry().toPixel(p);
    const int u = static_cast<int>(std::lround(pixel.x()));
    const int v = static_cast<int>(std::lround(pixel.y()));
    if (u < 0 || v < 0 || u >= sample_.bev_labels.cols || v >= sample_.bev_labels.rows) {
      return SemanticClass::kUnknown;
    }
    const auto c = static_cast<SemanticClass>(sample_.bev_labels.at<std::uint8_t>(v, u));
    return c == SemanticClass::kZoneMarker ? SemanticClass::kPillar : c;
  }

  // Whether the ground up to where it stands is seen, and itself beyond.
  [[nodiscard]] bool seen(SemanticClass c, const Eigen::Vector2d& meets) const {
    constexpr double kBorder = 0.5;  // m
    const Eigen::Vector2d pixel = geometry().toPixel(meets) * geometry().metres_per_px;
    const double right = geometry().width_px * geometry().metres_per_px;
    const double below = geometry().height_px * geometry().metres_per_px;
    if (pixel.minCoeff() < kBorder || pixel.x() > right - kBorder || pixel.y() > below - kBorder) {
      return false;
    }
    const Eigen::Vector2d foot = views_.viewAt(geometry(), meets).foot;
    const Eigen::Vector2d ray = (meets - foot).normalized();
    const double range = (meets - foot).norm();
    constexpr double kBefore = 0.4;
    constexpr double kStep = 0.05;
    for (double d = 0.0; d < range - kBefore; d += kStep) {
      const SemanticClass label = labelAt(foot + d * ray);
      if (label != SemanticClass::kUnknown && hidesGround(label)) return false;
    }
    if (hidesGround(labelAt(foot + (range - kBefore) * ray))) return false;
    int its = 0;
    for (double d = range - kBefore; d < 1.4 * range + 0.3; d += kStep) {
      if (labelAt(foot + d * ray) == c) ++its;
    }
    return its >= 3;
  }

  const SemanticSampler& sampler_;
  const SemanticSample& sample_;
  const BevViews& views_;
  SE2 T_level_world_;
  std::vector<TrueObject> objects_;
};

}  // namespace

std::vector<TrueObject> trueObjects(const SemanticSampler& sampler, const SemanticSample& sample,
                                    const BevViews& views) {
  return TruthCollector(sampler, sample, views).collect();
}

}  // namespace parkade::cli
