// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/label_sight.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/mapping/frame_evidence.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

bool inside(const std::vector<Vector2d>& outline, const Vector2d& p) {
  std::size_t left = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d edge = outline[(i + 1) % outline.size()] - outline[i];
    const Vector2d to = p - outline[i];
    if (edge.x() * to.y() - edge.y() * to.x() >= 0.0) ++left;
  }
  return left == 0 || left == outline.size();
}

bool isOwn(SemanticClass label, SemanticClass c) {
  return label == c || (label == SemanticClass::kZoneMarker && c == SemanticClass::kPillar);
}

bool isMarking(SemanticClass label) {
  const LayerRole role = roleOf(label);
  return role == LayerRole::kLine || role == LayerRole::kRoadMarker;
}

}  // namespace

AreaShares LabelSight::of(const std::vector<Vector2d>& outline,
                          SemanticClass semantic_class) const {
  AreaShares shares;
  shares.unseen = 1.0;
  if (outline.size() < 3) return shares;
  Vector2d low = outline.front();
  Vector2d high = low;
  for (const Vector2d& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // Two pixels apart tells shares well enough, and large areas at most 24 samples a side.
  const double step =
      std::max(2.0 * labels_.geometry.metres_per_px, (high - low).maxCoeff() / 24.0);
  const bool paint = isMarking(semantic_class);
  int all = 0;
  int own = 0;
  int rival = 0;
  int floor = 0;
  int covered = 0;
  for (double y = low.y() + 0.5 * step; y < high.y(); y += step) {
    for (double x = low.x() + 0.5 * step; x < high.x(); x += step) {
      const Vector2d p(x, y);
      if (!inside(outline, p)) continue;
      ++all;
      const Vector2d pixel = labels_.geometry.toPixel(p);
      const int u = static_cast<int>(std::floor(pixel.x() + 0.5));
      const int v = static_cast<int>(std::floor(pixel.y() + 0.5));
      if (u < 0 || v < 0 || u >= labels_.labels.cols || v >= labels_.labels.rows || !reaches(p)) {
        continue;
      }
      const auto label = static_cast<SemanticClass>(labels_.labels.at<std::uint8_t>(v, u));
      if (label == SemanticClass::kUnknown) continue;
      if (isOwn(label, semantic_class)) {
        ++own;
      } else if (paint && isMarking(label)) {
        ++rival;
      } else if (isMarking(label) || roleOf(label) == LayerRole::kGround) {
        ++floor;
      } else {
        ++covered;
      }
    }
  }
  if (all == 0) return shares;
  const double each = 1.0 / all;
  shares.own = own * each;
  shares.rival = rival * each;
  shares.floor = floor * each;
  shares.covered = covered * each;
  shares.unseen = 1.0 - shares.own - shares.rival - shares.floor - shares.covered;
  return shares;
}

}  // namespace parkade
