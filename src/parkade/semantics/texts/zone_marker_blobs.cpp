// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_blobs.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace parkade {
namespace {

bool mayHide(std::uint8_t label) {
  return label == static_cast<std::uint8_t>(SemanticClass::kVehicle) ||
         label == static_cast<std::uint8_t>(SemanticClass::kPedestrian);
}

// Whether what may hide something ends with a pillar, or the picture, above this pixel of it.
bool endsWithPillar(const cv::Mat& labels, cv::Point p) {
  while (p.y >= 0 && mayHide(labels.at<std::uint8_t>(p))) --p.y;
  if (p.y < 0) return true;
  const auto label = labels.at<std::uint8_t>(p);
  return label == static_cast<std::uint8_t>(SemanticClass::kPillar) ||
         label == static_cast<std::uint8_t>(SemanticClass::kZoneMarker);
}

}  // namespace

std::vector<MarkerBlob> findMarkerBlobs(const cv::Mat& labels, const cv::Mat& mask,
                                        SemanticClass wanted, int min_pixels) {
  cv::Mat components;
  cv::Mat stats;
  cv::Mat centroids;
  const int count = cv::connectedComponentsWithStats(labels == static_cast<int>(wanted), components,
                                                     stats, centroids, 8, CV_32S);
  std::vector<MarkerBlob> blobs;
  for (int i = 1; i < count; ++i) {
    if (stats.at<int>(i, cv::CC_STAT_AREA) < min_pixels) continue;
    MarkerBlob blob;
    blob.box = {stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT)};
    const cv::Rect inside(0, 0, labels.cols, labels.rows);
    for (int v = blob.box.y; v < blob.box.br().y; ++v) {
      for (int u = blob.box.x; u < blob.box.br().x; ++u) {
        if (components.at<int>(v, u) != i) continue;
        blob.pixels.emplace_back(u, v);
        for (const cv::Point& step : {cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
          const cv::Point next = cv::Point(u, v) + step;
          bool covered = !inside.contains(next);
          if (!covered) {
            const bool own_car =
                !mask.empty() && mask.at<std::uint8_t>(next.y * mask.rows / labels.rows,
                                                       next.x * mask.cols / labels.cols) == 0;
            covered = own_car || (mayHide(labels.at<std::uint8_t>(next)) &&
                                  (step.x == 0 || endsWithPillar(labels, next)));
          }
          if (!covered) continue;
          ++blob.covered;
          blob.covered_aside += step.x != 0 ? 1 : 0;
        }
      }
    }
    blobs.push_back(std::move(blob));
  }
  std::stable_sort(blobs.begin(), blobs.end(), [](const MarkerBlob& a, const MarkerBlob& b) {
    return a.box.height > b.box.height;
  });
  return blobs;
}

}  // namespace parkade
