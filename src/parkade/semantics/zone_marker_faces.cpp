// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/zone_marker_faces.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"
#include "parkade/semantics/zone_marker_outline.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {
namespace {

constexpr auto kMarker = static_cast<std::uint8_t>(SemanticClass::kZoneMarker);

double square(double value) {
  return value * value;
}

/// The picture of a level camera that looks at a marker: columns and heights over the depth.
class LevelView {
 public:
  LevelView(const Camera& camera, const SO3& R_level_cam, double azimuth)
      : camera_(camera), R_level_cam_(R_level_cam) {
    axes_.row(0) << std::sin(azimuth), -std::cos(azimuth), 0.0;  // right
    axes_.row(1) << 0.0, 0.0, 1.0;                               // up
    axes_.row(2) << std::cos(azimuth), std::sin(azimuth), 0.0;   // ahead
  }

  // False where the pixel's ray does not go ahead.
  bool look(const Eigen::Vector2d& pixel, Eigen::Vector2d& at) const {
    Eigen::Vector3d ray;
    if (!camera_.unproject(pixel, ray)) return false;
    const Eigen::Vector3d p = axes_ * (R_level_cam_ * ray);
    if (p.z() < 0.1) return false;
    at = p.head<2>() / p.z();
    return true;
  }
  // A point (right, up, depth), of any length, to the camera's picture.
  bool project(const Eigen::Vector3d& p, Eigen::Vector2d& pixel) const {
    return camera_.project(R_level_cam_.inverse() * (axes_.transpose() * p), pixel);
  }
  [[nodiscard]] Eigen::Vector3d levelRay(double x, double v) const {
    return (axes_.transpose() * Eigen::Vector3d(x, v, 1.0)).normalized();
  }

 private:
  const Camera& camera_;
  SO3 R_level_cam_;
  Eigen::Matrix3d axes_;
};

/// One connected patch of marker labels and what stands around it.
struct Blob {
  std::vector<cv::Point> pixels;
  cv::Rect box;
  int covered = 0;  ///< pixels beside something that may hide a part
};

bool mayHide(std::uint8_t label) {
  return label == static_cast<std::uint8_t>(SemanticClass::kVehicle) ||
         label == static_cast<std::uint8_t>(SemanticClass::kPedestrian);
}

std::vector<Blob> findBlobs(const cv::Mat& labels, const cv::Mat& mask, int min_pixels) {
  cv::Mat components;
  cv::Mat stats;
  cv::Mat centroids;
  const int count =
      cv::connectedComponentsWithStats(labels == kMarker, components, stats, centroids, 8, CV_32S);
  std::vector<Blob> blobs;
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < min_pixels) continue;
    Blob blob;
    blob.box = {stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT)};
    const cv::Rect inside(0, 0, labels.cols, labels.rows);
    for (int v = blob.box.y; v < blob.box.br().y; ++v) {
      for (int u = blob.box.x; u < blob.box.br().x; ++u) {
        if (components.at<int>(v, u) != i) continue;
        blob.pixels.emplace_back(u, v);
        for (const cv::Point& step : {cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
          const cv::Point next = cv::Point(u, v) + step;
          if (!inside.contains(next)) {
            ++blob.covered;
            continue;
          }
          const bool own_car =
              !mask.empty() && mask.at<std::uint8_t>(next.y * mask.rows / labels.rows,
                                                     next.x * mask.cols / labels.cols) == 0;
          blob.covered += own_car || mayHide(labels.at<std::uint8_t>(next)) ? 1 : 0;
        }
      }
    }
    blobs.push_back(std::move(blob));
  }
  std::stable_sort(blobs.begin(), blobs.end(),
                   [](const Blob& a, const Blob& b) { return a.box.height > b.box.height; });
  return blobs;
}

/// The outline's columns, one pixel of the label picture wide.
struct Outline {
  std::vector<MarkerColumn> columns;
  double x_left = 0.0;
  double x_right = 0.0;
};

Outline outlineOf(const std::vector<Eigen::Vector2d>& points, double pixel) {
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
  Outline outline;
  double tallest = 0.0;
  for (std::size_t k = 0; k < bins; ++k) {
    columns[k].bottom -= 0.5 * pixel;
    columns[k].top += 0.5 * pixel;
    if (counts[k] > 0) tallest = std::max(tallest, columns[k].top - columns[k].bottom);
  }
  // Slanted sides leave low columns at the ends.
  constexpr double kLeast = 0.5;
  for (std::size_t k = 0; k < bins; ++k) {
    if (counts[k] == 0 || columns[k].top - columns[k].bottom < kLeast * tallest) continue;
    outline.columns.push_back(columns[k]);
  }
  outline.x_left = outline.columns.front().x - 0.5 * pixel;
  outline.x_right = outline.columns.back().x + 0.5 * pixel;
  return outline;
}

// Brings a face to one brightness and contrast whatever its light, by what lies inside `face`.
void normalise(cv::Mat& patch, const cv::Rect& face) {
  constexpr double kMiddle = 128.0;
  constexpr double kSpread = 40.0;
  constexpr double kLeastSpread = 1.5;  // below it there is nothing but rounding
  cv::Scalar mean;
  cv::Scalar spread;
  cv::meanStdDev(patch(face), mean, spread);
  const double sigma = std::sqrt((square(spread[0]) + square(spread[1]) + square(spread[2])) / 3.0);
  const double gain = kSpread / std::max(kLeastSpread, sigma);
  for (int v = 0; v < patch.rows; ++v) {
    auto* row = patch.ptr<cv::Vec3f>(v);
    for (int u = 0; u < patch.cols; ++u) {
      for (int c = 0; c < 3; ++c) {
        row[u][c] = static_cast<float>(kMiddle + gain * (row[u][c] - mean[c]));
      }
    }
  }
  cv::Mat bytes;
  patch.convertTo(bytes, CV_8UC3);
  patch = bytes;
}

// The face seen from straight ahead, with what surrounds it.
ZoneMarkerFace straighten(const cv::Mat& image, const LevelView& view, const FittedFace& face,
                          double middle) {
  const Eigen::Vector3d left(face.x_left * face.depth_left, middle, face.depth_left);
  const Eigen::Vector3d right(face.x_right * face.depth_right, middle, face.depth_right);
  const Eigen::Vector3d along = (right - left).normalized();
  const Eigen::Vector3d center = 0.5 * (left + right);
  ZoneMarkerFace result;
  result.slant = face.slant();
  Eigen::Vector2d below;
  Eigen::Vector2d above;
  if (!view.project(center - 0.5 * Eigen::Vector3d::UnitY(), below) ||
      !view.project(center + 0.5 * Eigen::Vector3d::UnitY(), above)) {
    return result;
  }
  result.height_px = (above - below).norm();
  const Eigen::Vector3d half_up = 0.5 * Eigen::Vector3d::UnitY();
  const std::array<Eigen::Vector3d, 4> ends = {left + half_up, right + half_up, right - half_up,
                                               left - half_up};
  for (std::size_t k = 0; k < 4; ++k) {
    if (!view.project(ends[k], result.corners[k])) return result;
  }
  constexpr double kRows = 34.0;  // of the face
  constexpr double kColumns = 80.0;
  const double scale = std::min(kRows, kColumns / std::max(1e-3, face.width()));
  // Near faces are sampled more finely than the patch, then averaged.
  const int fine = std::clamp(static_cast<int>(std::ceil(result.height_px / scale)), 1, 4);
  const cv::Size size(fine * kZonePatchWidth, fine * kZonePatchHeight);
  cv::Mat map(size, CV_32FC2);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      const double right_of = ((u + 0.5) / fine - 0.5 * kZonePatchWidth) / scale;
      const double over = (0.5 * kZonePatchHeight - (v + 0.5) / fine) / scale;
      const Eigen::Vector3d p = center + right_of * along + over * Eigen::Vector3d::UnitY();
      Eigen::Vector2d pixel(-10.0, -10.0);
      if (p.z() < 0.1 * center.z() || !view.project(p, pixel)) pixel << -10.0, -10.0;
      map.at<cv::Vec2f>(v, u) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
    }
  }
  cv::Mat sampled;
  cv::remap(image, sampled, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  sampled.convertTo(sampled, CV_32F);
  if (fine > 1) {
    cv::resize(sampled, sampled, {kZonePatchWidth, kZonePatchHeight}, 0, 0, cv::INTER_AREA);
  }
  if (sampled.channels() == 1) cv::cvtColor(sampled, sampled, cv::COLOR_GRAY2BGR);
  const int half_width = std::clamp(static_cast<int>(0.5 * scale * face.width()), 4, 48);
  const int half_height = std::clamp(static_cast<int>(0.5 * scale), 4, 20);
  normalise(sampled, {kZonePatchWidth / 2 - half_width, kZonePatchHeight / 2 - half_height,
                      2 * half_width, 2 * half_height});
  result.patch = sampled;
  return result;
}

}  // namespace

std::vector<ZoneMarkerSight> findZoneMarkers(const cv::Mat& labels, const cv::Mat& image,
                                             const cv::Mat& mask, const Camera& camera,
                                             const SO3& R_level_cam,
                                             const ZoneMarkerFaceOptions& options) {
  PARKADE_CHECK(labels.type() == CV_8UC1, "labels of type {}", labels.type());
  PARKADE_CHECK(image.cols == camera.width() && image.rows == camera.height(),
                "picture of {} x {} px, the camera has {} x {}", image.cols, image.rows,
                camera.width(), camera.height());
  const Eigen::Vector2d step(static_cast<double>(image.cols) / labels.cols,
                             static_cast<double>(image.rows) / labels.rows);
  const auto toImage = [&](double u, double v) {
    return Eigen::Vector2d((u + 0.5) * step.x() - 0.5, (v + 0.5) * step.y() - 0.5);
  };
  std::vector<ZoneMarkerSight> sights;
  int faces = 0;
  for (const Blob& blob : findBlobs(labels, mask, options.min_label_px)) {
    const cv::Rect& box = blob.box;
    Eigen::Vector3d middle;
    Eigen::Vector3d beside;
    const Eigen::Vector2d at(box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1));
    if (!camera.unproject(toImage(at.x(), at.y()), middle) ||
        !camera.unproject(toImage(at.x() + 1.0, at.y()), beside)) {
      continue;
    }
    const double pixel = middle.cross(beside).norm();  // rad
    const Eigen::Vector3d level = R_level_cam * middle;
    const LevelView view(camera, R_level_cam, std::atan2(level.y(), level.x()));
    std::vector<Eigen::Vector2d> points;
    for (const cv::Point& p : blob.pixels) {
      Eigen::Vector2d xv;
      if (view.look(toImage(p.x, p.y), xv)) points.push_back(xv);
    }
    if (points.empty()) continue;
    const Outline outline = outlineOf(points, pixel);
    const FittedMarker marker =
        fitMarker(outline.columns, outline.x_left, outline.x_right, 0.5 * pixel);
    const double x = 0.5 * (outline.x_left + outline.x_right);
    ZoneMarkerSight sight;
    sight.box = box;
    sight.ray_level = view.levelRay(x, marker.middle * marker.height_at_middle);
    sight.sigma = pixel;
    // Over the horizontal distance instead of the depth.
    sight.height_ratio = marker.height_at_middle / std::hypot(1.0, x);
    sight.height_sigma = 0.5 * pixel;
    sight.cut = blob.covered > 0.08 * 2.0 * (box.width + box.height);
    for (const FittedFace& face : marker.faces) {
      if (sight.cut || faces >= options.max_faces) break;
      if (face.slant() > options.max_slant_deg * M_PI / 180.0) continue;
      ZoneMarkerFace straight = straighten(image, view, face, marker.middle);
      if (straight.height_px < options.min_height_px || straight.patch.empty()) continue;
      sight.faces.push_back(std::move(straight));
      ++faces;
    }
    sights.push_back(std::move(sight));
  }
  return sights;
}

}  // namespace parkade
