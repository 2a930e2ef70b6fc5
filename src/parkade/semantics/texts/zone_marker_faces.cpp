// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_faces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/core/check.hpp"
#include "parkade/semantics/texts/zone_marker_blobs.hpp"
#include "parkade/semantics/texts/zone_marker_outline.hpp"
#include "parkade/semantics/texts/zone_marker_patch.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {
namespace {

/// What is looked for, and how its faces are taken.
struct Search {
  SemanticClass semantic_class = SemanticClass::kZoneMarker;
  bool corners = true;  ///< it may stand on two faces of a pillar
  double share = 1.0;   ///< of the height, about the middle, that bears its text
};

/// The outline's columns, one pixel of the label picture wide.
struct FaceOutline {
  std::vector<MarkerColumn> columns;
  double x_left = 0.0;
  double x_right = 0.0;
};

// The marker's sides seldom follow the columns: those at its ends may hold a part of a side only.
void dropPartialEnds(std::vector<MarkerColumn>& columns, double step) {
  constexpr double kShare = 0.88;
  const auto partial = [&](const MarkerColumn& end, const MarkerColumn& next) {
    const double height = end.top - end.bottom;
    const double beside = next.top - next.bottom;
    return height < kShare * beside && height < beside - step;
  };
  for (int side = 0; side < 2; ++side) {
    for (int k = 0; k < 2 && columns.size() > 3; ++k) {
      if (!partial(columns.front(), columns[1])) break;
      columns.erase(columns.begin());
    }
    std::reverse(columns.begin(), columns.end());
  }
}

// size: of a label pixel in the level view.
FaceOutline outlineOf(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& size) {
  const double pixel = size.x();
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  const double begin = low->x() - 0.5 * pixel;
  const auto bins = static_cast<std::size_t>(std::floor((high->x() - begin) / pixel)) + 1;
  std::vector<MarkerColumn> columns(bins);
  std::vector<int> counts(bins, 0);
  for (const Eigen::Vector2d& p : points) {
    const auto k = static_cast<std::size_t>((p.x() - begin) / pixel);
    MarkerColumn& c = columns[k];
    if (counts[k]++ == 0) c = {begin + (static_cast<double>(k) + 0.5) * pixel, p.y(), p.y()};
    c.bottom = std::min(c.bottom, p.y());
    c.top = std::max(c.top, p.y());
  }
  FaceOutline outline;
  double tallest = 0.0;
  for (std::size_t k = 0; k < bins; ++k) {
    columns[k].bottom -= 0.5 * size.y();
    columns[k].top += 0.5 * size.y();
    if (counts[k] > 0) tallest = std::max(tallest, columns[k].top - columns[k].bottom);
  }
  constexpr double kLeast = 0.3;
  for (std::size_t k = 0; k < bins; ++k) {
    if (counts[k] == 0 || columns[k].top - columns[k].bottom < kLeast * tallest) continue;
    outline.columns.push_back(columns[k]);
  }
  dropPartialEnds(outline.columns, 1.5 * size.y());
  outline.x_left = outline.columns.front().x - 0.5 * pixel;
  outline.x_right = outline.columns.back().x + 0.5 * pixel;
  return outline;
}

// Pixels of the camera's picture from those of the label picture.
struct LabelScale {
  Eigen::Vector2d step = Eigen::Vector2d::Ones();
  [[nodiscard]] Eigen::Vector2d toImage(double u, double v) const {
    return {(u + 0.5) * step.x() - 0.5, (v + 0.5) * step.y() - 0.5};
  }
};

/// A sight and the view and outline that it was measured in.
struct MeasuredSight {
  ZoneMarkerSight sight;
  LevelCamera view;
  FittedMarker marker;
};

std::optional<MeasuredSight> measure(const MarkerBlob& blob, const LabelScale& labels,
                                     const Camera& camera, const SO3& R_level_cam, bool corners) {
  const cv::Rect& box = blob.box;
  const Eigen::Vector2d at(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
  Eigen::Vector3d middle;
  if (!camera.unproject(labels.toImage(at.x(), at.y()), middle)) return std::nullopt;
  const Eigen::Vector3d level = R_level_cam * middle;
  const LevelCamera view(camera, R_level_cam, std::atan2(level.y(), level.x()));
  Eigen::Vector2d here;
  Eigen::Vector2d beside;
  Eigen::Vector2d below;
  if (!view.look(labels.toImage(at.x(), at.y()), here) ||
      !view.look(labels.toImage(at.x() + 1.0, at.y()), beside) ||
      !view.look(labels.toImage(at.x(), at.y() + 1.0), below)) {
    return std::nullopt;
  }
  const Eigen::Vector2d pixel((beside - here).norm(), (below - here).norm());
  std::vector<Eigen::Vector2d> points;
  for (const cv::Point& p : blob.pixels) {
    Eigen::Vector2d xv;
    if (view.look(labels.toImage(p.x, p.y), xv)) points.push_back(xv);
  }
  if (points.empty()) return std::nullopt;
  const FaceOutline outline = outlineOf(points, pixel);
  const FittedMarker marker =
      fitMarker(outline.columns, outline.x_left, outline.x_right, 0.5 * pixel.y(), corners);
  const double x = 0.5 * (outline.x_left + outline.x_right);
  ZoneMarkerSight sight;
  sight.box = box;
  sight.ray_level = view.levelRay(x, marker.middle * marker.height_at_middle);
  sight.sigma = pixel.maxCoeff();
  // Over the horizontal distance instead of the depth.
  sight.height_ratio = marker.height_at_middle / std::hypot(1.0, x);
  sight.height_sigma = 0.5 * pixel.y();
  constexpr double kCovered = 0.08;  // of the outline
  const double around = 2.0 * (box.width + box.height);
  sight.cut = blob.covered > kCovered * around;
  if (sight.cut) {
    // Its middle lies somewhere in what is hidden, and it is higher than it looks.
    sight.sigma = std::hypot(sight.sigma, 0.5 * marker.height_at_middle);
    sight.height_sigma = sight.height_ratio;
  }
  sight.legible = blob.covered_aside <= kCovered * around;
  return MeasuredSight{sight, view, marker};
}

/// The middle of a face, a share of its height and as much of its width less.
FittedFace middleOf(const FittedFace& face, double share) {
  const double middle = 0.5 * (face.x_left + face.x_right);
  const double half = 0.5 * share * (face.x_right - face.x_left);
  const auto depth = [&](double x) {
    const double s = (x - face.x_left) / (face.x_right - face.x_left);
    // 1 / depth is linear; the unit is the new height.
    return 1.0 / ((1.0 - s) / face.depth_left + s / face.depth_right) / share;
  };
  return {middle - half, middle + half, depth(middle - half), depth(middle + half)};
}

std::vector<ZoneMarkerSight> find(const cv::Mat& labels, const cv::Mat& image, const cv::Mat& mask,
                                  const Camera& camera, const SO3& R_level_cam,
                                  const Search& search, const ZoneMarkerFaceOptions& options,
                                  const WantedSight& wanted) {
  PARKADE_CHECK(labels.type() == CV_8UC1, "labels of type {}", labels.type());
  PARKADE_CHECK(image.cols == camera.width() && image.rows == camera.height(),
                "picture of {} x {} px, the camera has {} x {}", image.cols, image.rows,
                camera.width(), camera.height());
  const LabelScale scale{{static_cast<double>(image.cols) / labels.cols,
                          static_cast<double>(image.rows) / labels.rows}};
  std::vector<ZoneMarkerSight> sights;
  int faces = 0;
  for (const MarkerBlob& blob :
       findMarkerBlobs(labels, mask, search.semantic_class, options.min_label_px)) {
    std::optional<MeasuredSight> found = measure(blob, scale, camera, R_level_cam, search.corners);
    if (!found) continue;
    found->sight.semantic_class = search.semantic_class;
    const auto straightened = [&](const std::vector<FittedFace>& fitted) {
      std::vector<ZoneMarkerFace> out;
      for (const FittedFace& face : fitted) {
        // A pillar's text may stand there twice, a sign's does not.
        const bool pillar = search.semantic_class == SemanticClass::kZoneMarker;
        if (!pillar && !found->sight.legible) break;
        if (face.slant() > options.max_slant_deg * M_PI / 180.0) continue;
        ZoneMarkerFace straight = straighten(image, found->view, middleOf(face, search.share),
                                             found->marker.middle / search.share);
        if (straight.height_px < options.min_height_px || straight.patch.empty()) continue;
        out.push_back(std::move(straight));
      }
      return out;
    };
    if (faces < options.max_faces && (wanted == nullptr || wanted(found->sight))) {
      found->sight.faces = straightened(found->marker.faces);
      found->sight.other_faces = straightened(found->marker.other_faces);
      faces += static_cast<int>(found->sight.faces.size());
    }
    sights.push_back(std::move(found->sight));
  }
  return sights;
}

}  // namespace

std::vector<ZoneMarkerSight> findZoneMarkers(const cv::Mat& labels, const cv::Mat& image,
                                             const cv::Mat& mask, const Camera& camera,
                                             const SO3& R_level_cam,
                                             const ZoneMarkerFaceOptions& options,
                                             const WantedSight& wanted) {
  return find(labels, image, mask, camera, R_level_cam, {}, options, wanted);
}

std::vector<ZoneMarkerSight> findSigns(const cv::Mat& labels, const cv::Mat& image,
                                       const cv::Mat& mask, const Camera& camera,
                                       const SO3& R_level_cam, SemanticClass sign,
                                       const ZoneMarkerFaceOptions& options) {
  constexpr double kInsideRing = 0.85;  // of a round plate's mean height over its columns
  const bool limit = sign == SemanticClass::kSpeedLimitSign;
  return find(labels, image, mask, camera, R_level_cam, {sign, false, limit ? kInsideRing : 1.0},
              options, nullptr);
}

}  // namespace parkade
