// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/smear_finder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"
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

bool isStructure(SemanticClass c) {
  return c == SemanticClass::kWall || c == SemanticClass::kPillar ||
         c == SemanticClass::kZoneMarker;
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
  if (isStructure(c) || sight.blocked) {
    sight.structure += length;
    sight.blocked = sight.blocked || sight.structure >= least;
  } else {
    sight.structure = 0.0F;
  }
  sight.behind_wall = sight.behind_wall || sight.wall >= wall_least;
  sight.wall = c == SemanticClass::kWall ? sight.wall + length : 0.0F;
  sight.wheel_stop = c == SemanticClass::kWheelStop ? sight.wheel_stop + length : 0.0F;
}

std::uint8_t smearOf(const Sight& sight, SemanticClass c, const SmearOptions& options) {
  if (c == SemanticClass::kWheelStop) {
    const bool is_smear = sight.behind_wall || sight.wheel_stop > options.wheel_stop_depth_m;
    return is_smear ? SemanticFrame::kSmear : 0;
  }
  if (!isStructure(c)) return sight.behind_wall ? SemanticFrame::kSmear : 0;
  const bool wall = c == SemanticClass::kWall;
  const double depth = wall ? options.wall_depth_m : options.pillar_depth_m;
  if (sight.behind_car || sight.structure > depth) return SemanticFrame::kSmear;
  return !wall && sight.structure > options.edge_m ? SemanticFrame::kBehindEdge : 0;
}

}  // namespace

SmearFinder::SmearFinder(const BevGeometry& geometry, const BevViews& views,
                         const SmearOptions& options)
    : geometry_(geometry), options_(options) {
  PARKADE_CHECK(views.view_of.cols == geometry.width_px && views.view_of.rows == geometry.height_px,
                "views of {} x {} px", views.view_of.cols, views.view_of.rows);
  std::vector<std::pair<float, Step>> outwards;  // by distance from the camera, px
  for (int v = 0; v < geometry.height_px; ++v) {
    for (int u = 0; u < geometry.width_px; ++u) {
      const auto index = views.view_of.at<std::uint8_t>(v, u);
      if (index >= views.views.size()) continue;
      const Eigen::Vector2d d = geometry.toPixel(views.views[index].foot) - Eigen::Vector2d(u, v);
      Step step;
      step.pixel = v * geometry.width_px + u;
      // The longer component goes one pixel, so that no pixel is its own neighbour.
      const double longer = std::max(std::abs(d.x()), std::abs(d.y()));
      if (longer >= 1.0) {
        const int bu = u + static_cast<int>(std::lround(d.x() / longer));
        const int bv = v + static_cast<int>(std::lround(d.y() / longer));
        if (bu >= 0 && bv >= 0 && bu < geometry.width_px && bv < geometry.height_px) {
          step.before = bv * geometry.width_px + bu;
          step.length = static_cast<float>(d.norm() / longer * geometry.metres_per_px);
        }
      }
      outwards.emplace_back(static_cast<float>(d.norm()), step);
    }
  }
  std::stable_sort(outwards.begin(), outwards.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  outwards_.reserve(outwards.size());
  for (const auto& [distance, step] : outwards) outwards_.push_back(step);
}

cv::Mat SmearFinder::find(const BevLabels& labels) const {
  PARKADE_CHECK(labels.labels.cols == geometry_.width_px &&
                    labels.labels.rows == geometry_.height_px && labels.labels.isContinuous(),
                "labels of {} x {} px", labels.labels.cols, labels.labels.rows);
  std::vector<Sight> sights(labels.labels.total());
  cv::Mat smear(labels.labels.size(), CV_8UC1, cv::Scalar(0));
  const auto least = static_cast<float>(options_.least_m);
  const auto wall_least = static_cast<float>(options_.wall_least_m);
  // Where cameras' parts of the picture meet, a pixel may come before the one in front of it, which
  // is another camera's: the second time that one is known.
  for (int pass = 0; pass < 2; ++pass) {
    for (const Step& step : outwards_) {
      Sight sight;
      if (step.before >= 0) sight = sights[static_cast<std::size_t>(step.before)];
      const auto c = static_cast<SemanticClass>(labels.labels.data[step.pixel]);
      goOn(sight, c, step.length, least, wall_least);
      sights[static_cast<std::size_t>(step.pixel)] = sight;
      smear.data[step.pixel] = smearOf(sight, c, options_);
    }
  }
  return smear;
}

}  // namespace parkade
