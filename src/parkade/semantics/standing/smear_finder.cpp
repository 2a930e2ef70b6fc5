// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/smear_finder.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/core/check.hpp"
#include "parkade/semantics/markings/marking_pieces.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {
namespace {

// Of the sight line up to a pixel.
struct Sight {
  float structure = 0.0F;   // m of it, as far as blocked: since it was first met
  float vehicle = 0.0F;     // m
  float wheel_stop = 0.0F;  // m
  float wall = 0.0F;        // m
  bool blocked = false;     // by structure, for good: nothing on the ground is seen behind
  bool behind_car = false;
  bool behind_wall = false;
};

bool isBuilt(SemanticClass c) {
  return isStructure(c) || c == SemanticClass::kZoneMarker;
}

// The pixel nearest to a point of the picture; nothing beyond it.
std::optional<cv::Point> nearestPixel(const BevGeometry& geometry, const Eigen::Vector2d& p) {
  const cv::Point pixel(static_cast<int>(std::lround(p.x())), static_cast<int>(std::lround(p.y())));
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= geometry.width_px || pixel.y >= geometry.height_px) {
    return std::nullopt;
  }
  return pixel;
}

// Goes on by a pixel of class c. least: m of something upright that block the sight, wall_least: m
// of wall that hide all the ground.
void goOn(Sight& sight, SemanticClass c, float length, float least, float wall_least) {
  if (c == SemanticClass::kVehicle) {
    sight.vehicle += length;
    sight.behind_car = sight.behind_car || (!sight.blocked && sight.vehicle >= least);
  } else {
    sight.vehicle = 0.0F;
  }
  if (isBuilt(c) || sight.blocked) {
    sight.structure += length;
    sight.blocked = sight.blocked || sight.structure >= least;
  } else {
    sight.structure = 0.0F;
  }
  sight.behind_wall = sight.behind_wall || sight.wall >= wall_least;
  sight.wall = c == SemanticClass::kWall ? sight.wall + length : 0.0F;
  sight.wheel_stop = c == SemanticClass::kWheelStop ? sight.wheel_stop + length : 0.0F;
}

double depthOf(SemanticClass structure, const SmearOptions& options) {
  return structure == SemanticClass::kWall ? options.wall_depth_m : options.pillar_depth_m;
}

std::uint8_t smearOf(const Sight& sight, SemanticClass c, const SmearOptions& options) {
  if (c == SemanticClass::kWheelStop) {
    const bool is_smear = sight.behind_wall || sight.wheel_stop > options.wheel_stop_depth_m;
    return is_smear ? SemanticFrame::kSmear : 0;
  }
  if (!isBuilt(c)) return sight.behind_wall ? SemanticFrame::kSmear : 0;
  const bool wall = c == SemanticClass::kWall;
  if (sight.behind_car || sight.structure > depthOf(c, options)) return SemanticFrame::kSmear;
  return !wall && sight.structure > options.edge_m ? SemanticFrame::kBehindEdge : 0;
}

}  // namespace

SmearFinder::SmearFinder(const BevGeometry& geometry, const BevViews& views,
                         const SmearOptions& options)
    : geometry_(geometry), views_(views), options_(options) {
  PARKADE_CHECK(views.view_of.cols == geometry.width_px && views.view_of.rows == geometry.height_px,
                "views of {} x {} px", views.view_of.cols, views.view_of.rows);
  for (std::size_t view = 0; view < views.views.size(); ++view) {
    for (int u = 0; u < geometry.width_px; ++u) {
      addRay(view, u, 0);
      addRay(view, u, geometry.height_px - 1);
    }
    for (int v = 1; v + 1 < geometry.height_px; ++v) {
      addRay(view, 0, v);
      addRay(view, geometry.width_px - 1, v);
    }
  }
}

void SmearFinder::addRay(std::size_t view, int u, int v) {
  const Eigen::Vector2d foot = geometry_.toPixel(views_.views[view].foot);
  const Eigen::Vector2d d = Eigen::Vector2d(u, v) - foot;
  const int count = static_cast<int>(std::ceil(d.cwiseAbs().maxCoeff()));
  if (count == 0) return;
  Ray ray;
  ray.begin = ray.end = steps_.size();
  ray.length = static_cast<float>(d.norm() / count * geometry_.metres_per_px);
  for (int k = 0; k <= count; ++k) {
    const Eigen::Vector2d p = foot + d * (static_cast<double>(k) / count);
    const std::optional<cv::Point> pixel = nearestPixel(geometry_, p);
    if (!pixel) continue;
    const std::size_t shown_by = views_.view_of.at<std::uint8_t>(*pixel);
    const bool own = shown_by == view;
    // What hides this camera's part may lie in another one's.
    if (shown_by >= views_.views.size()) continue;
    steps_.push_back({pixel->y * geometry_.width_px + pixel->x, own});
    if (own) ray.end = steps_.size();
  }
  steps_.resize(ray.end);
  if (ray.begin < ray.end) rays_.push_back(ray);
}

// Whether the labels show structure where a point stands, or just behind.
bool SmearFinder::standsOnStructure(const cv::Mat& labels, const Eigen::Vector2d& foot,
                                    const Eigen::Vector2d& outwards) const {
  constexpr double kDepth = 0.3;  // m
  constexpr int kAround = 2;      // px
  const int steps = static_cast<int>(kDepth / geometry_.metres_per_px);
  for (int k = 0; k <= steps; k += kAround) {
    const Eigen::Vector2d p = geometry_.toPixel(foot + k * geometry_.metres_per_px * outwards);
    const int u = static_cast<int>(std::lround(p.x()));
    const int v = static_cast<int>(std::lround(p.y()));
    for (int y = std::max(0, v - kAround); y <= std::min(labels.rows - 1, v + kAround); ++y) {
      for (int x = std::max(0, u - kAround); x <= std::min(labels.cols - 1, u + kAround); ++x) {
        if (isBuilt(static_cast<SemanticClass>(labels.at<std::uint8_t>(y, x)))) return true;
      }
    }
  }
  return false;
}

std::vector<float> SmearFinder::hiddenBehind(const cv::Mat& labels,
                                             const std::vector<RaisedPoint>& raised) const {
  constexpr double kLeastBelow = 0.02;  // m below the camera: else drawn beyond every picture
  std::vector<float> hidden(views_.view_of.total(), 0.0F);
  const double step = 0.7 * geometry_.metres_per_px;
  for (const RaisedPoint& point : raised) {
    const Eigen::Vector3d& p = point.p_level;
    const std::size_t index = views_.indexAt(geometry_, p.head<2>());
    if (index >= views_.views.size()) continue;
    const BevViews::View& view = views_.views[index];
    const double below = view.height - p.z();
    const Eigen::Vector2d d = p.head<2>() - view.foot;
    const double distance = d.norm();
    if (below < kLeastBelow || distance < step) continue;
    if (standsOnStructure(labels, p.head<2>(), d / distance)) continue;
    const auto length = static_cast<float>(distance * p.z() / below);
    const Eigen::Vector2d across = Eigen::Vector2d(-d.y(), d.x()) / distance;
    const double half = options_.point_half_width_m;
    for (double s = -half; s <= half; s += step) {
      // Two pixels deep, so that no ray slips through.
      for (const double deep : {0.0, geometry_.metres_per_px}) {
        const Eigen::Vector2d place = p.head<2>() + s * across + deep / distance * d;
        const std::optional<cv::Point> pixel = nearestPixel(geometry_, geometry_.toPixel(place));
        if (!pixel) continue;
        float& most = hidden[static_cast<std::size_t>(pixel->y * geometry_.width_px + pixel->x)];
        most = std::max(most, length);
      }
    }
  }
  return hidden;
}

cv::Mat SmearFinder::find(const BevLabels& labels, const std::vector<RaisedPoint>& raised) const {
  PARKADE_CHECK(labels.labels.cols == geometry_.width_px &&
                    labels.labels.rows == geometry_.height_px && labels.labels.isContinuous(),
                "labels of {} x {} px", labels.labels.cols, labels.labels.rows);
  cv::Mat smear(labels.labels.size(), CV_8UC1, cv::Scalar(0));
  const std::vector<float> hidden = hiddenBehind(labels.labels, raised);
  const auto least = static_cast<float>(options_.least_m);
  const auto wall_least = static_cast<float>(options_.wall_least_m);
  for (const Ray& ray : rays_) {
    Sight sight;
    float behind = 0.0F;  // m that key points hide from here on
    float since = 0.0F;   // m since they do
    for (std::size_t k = ray.begin; k < ray.end; ++k) {
      const Step& step = steps_[k];
      const auto c = static_cast<SemanticClass>(labels.labels.data[step.pixel]);
      goOn(sight, c, ray.length, least, wall_least);
      behind = std::max(behind - ray.length, hidden[static_cast<std::size_t>(step.pixel)]);
      since = behind > 0.0F ? since + ray.length : 0.0F;
      if (!step.own) continue;
      const bool is_hidden =
          behind > 0.0F && (!hidesGround(c) || (isBuilt(c) && since > depthOf(c, options_)));
      smear.data[step.pixel] = is_hidden ? SemanticFrame::kSmear : smearOf(sight, c, options_);
    }
  }
  return smear;
}

}  // namespace parkade
