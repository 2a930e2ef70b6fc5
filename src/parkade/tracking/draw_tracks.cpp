// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/draw_tracks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace parkade {
namespace {

constexpr int kShift = 3;  // bits of sub-pixels in OpenCV's drawing
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kOldAge = 40.0;

cv::Point toFixed(const Eigen::Vector2d& p) {
  return {static_cast<int>(std::lround(p.x() * (1 << kShift))),
          static_cast<int>(std::lround(p.y() * (1 << kShift)))};
}

cv::Scalar colourOfAge(int age) {
  const double s = std::clamp((age - 1) / (kOldAge - 1.0), 0.0, 1.0);
  const double red = std::clamp(2.0 * s, 0.0, 1.0);
  const double blue = std::clamp(1.0 - 2.0 * s, 0.0, 1.0);
  return {255.0 * blue, 255.0 * (1.0 - std::abs(2.0 * s - 1.0)), 255.0 * red};
}

cv::Scalar colourOfLoss(TrackLoss why) {
  switch (why) {
    case TrackLoss::kMotion:
      return {255, 0, 255};
    case TrackLoss::kEpipolar:
      return {255, 255, 0};
    case TrackLoss::kMask:
      return {128, 128, 128};
    default:
      return {200, 200, 255};
  }
}

void writeText(cv::Mat& picture, const std::string& text, cv::Point place, double size) {
  cv::putText(picture, text, place, kFont, size, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(picture, text, place, kFont, size, {255, 255, 255}, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat drawTracks(const FrameSet& frames, const TrackSet& tracks, const TrackSet& previous,
                   const TrackingReport& report, const MotionPrior& prior, const Rig& rig,
                   const std::string& caption) {
  const std::size_t count = rig.cameras.size();
  std::map<std::pair<int, std::uint64_t>, Eigen::Vector2d> before;
  for (const TrackObservation& o : previous.observations) before[{o.camera, o.id}] = o.pixel;
  std::map<std::uint64_t, int> sharing;
  for (const TrackObservation& o : tracks.observations) ++sharing[o.id];

  std::vector<cv::Mat> pictures(count);
  for (std::size_t c = 0; c < count; ++c) {
    const Camera& camera = rig.cameras[c].camera;
    const cv::Mat& image = frames.images[c];
    cv::Mat& picture = pictures[c];
    if (image.empty()) {
      picture = cv::Mat(camera.height(), camera.width(), CV_8UC3, cv::Scalar(40, 0, 0));
    } else if (image.channels() == 1) {
      cv::cvtColor(image, picture, cv::COLOR_GRAY2BGR);
    } else {
      picture = image.clone();
    }
  }
  std::vector<int> number(count, 0);
  for (const TrackObservation& o : tracks.observations) {
    cv::Mat& picture = pictures[static_cast<std::size_t>(o.camera)];
    const cv::Scalar colour = colourOfAge(o.age);
    ++number[static_cast<std::size_t>(o.camera)];
    if (const auto it = before.find({o.camera, o.id}); it != before.end()) {
      cv::line(picture, toFixed(it->second), toFixed(o.pixel), colour, 1, cv::LINE_AA, kShift);
    }
    cv::circle(picture, toFixed(o.pixel), 2 << kShift, colour, cv::FILLED, cv::LINE_AA, kShift);
    if (sharing[o.id] > 1) {
      cv::circle(picture, toFixed(o.pixel), 6 << kShift, colour, 1, cv::LINE_AA, kShift);
    }
    if (const auto p = prior.p_previous.find(o.id); p != prior.p_previous.end()) {
      const SE3& T_vehicle_cam = rig.cameras[static_cast<std::size_t>(o.camera)].T_vehicle_cam;
      const double depth =
          (T_vehicle_cam.inverse() * (prior.T_previous_current.inverse() * p->second)).norm();
      cv::putText(picture, fmt::format("{:.1f}", depth),
                  cv::Point(static_cast<int>(o.pixel.x()) + 5, static_cast<int>(o.pixel.y()) - 3),
                  kFont, 0.3, colour, 1, cv::LINE_AA);
    }
  }
  for (const TrackingReport::Lost& lost : report.lost) {
    if (!lost.pixel.allFinite() || lost.pixel.cwiseAbs().maxCoeff() > 1e5) continue;
    const cv::Point p(static_cast<int>(lost.pixel.x()), static_cast<int>(lost.pixel.y()));
    cv::drawMarker(pictures[static_cast<std::size_t>(lost.camera)], p, colourOfLoss(lost.why),
                   cv::MARKER_TILTED_CROSS, 7, 1);
  }
  // Tiles: as square as can be, every tile of the first camera's width.
  const int columns = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const int rows = (static_cast<int>(count) + columns - 1) / columns;
  int width = 0;
  int height = 0;
  for (const cv::Mat& picture : pictures) {
    width = std::max(width, picture.cols);
    height = std::max(height, picture.rows);
  }
  cv::Mat sheet(rows * height, columns * width, CV_8UC3, cv::Scalar(0, 0, 0));
  for (std::size_t c = 0; c < count; ++c) {
    writeText(
        pictures[c],
        fmt::format("{}{}: {} tracks, motion {:.2f} px", rig.cameras[c].name,
                    tracks.camera_ok[c] != 0 ? "" : " (blind)", number[c], report.motion_rms_px[c]),
        {8, pictures[c].rows - 10}, 0.45);
    const int column = static_cast<int>(c) % columns;
    const int row = static_cast<int>(c) / columns;
    pictures[c].copyTo(
        sheet(cv::Rect(column * width, row * height, pictures[c].cols, pictures[c].rows)));
  }
  writeText(sheet, caption, {8, 18}, 0.5);
  return sheet;
}

}  // namespace parkade
