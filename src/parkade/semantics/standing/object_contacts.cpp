// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/object_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"
#include "parkade/semantics/markings/marking_pieces.hpp"

namespace parkade {
namespace {

// Ground must be seen this far before an edge, px, and also beside: the sides of a smear run along
// the sight lines, and are no edges at the floor.
constexpr double kSightReach = 3.0;
constexpr int kBorder = 5;  // px

bool sameThing(SemanticClass label, SemanticClass wanted) {
  return label == wanted ||
         (label == SemanticClass::kZoneMarker && wanted == SemanticClass::kPillar);
}

// Whether something else that hides the ground, or the end of the picture, is beside a pixel.
bool endsAt(const cv::Mat& labels, int x, int y, SemanticClass semantic_class) {
  constexpr int kBeside = 3;  // px
  constexpr int kSteps[4][2] = {{-kBeside, 0}, {kBeside, 0}, {0, -kBeside}, {0, kBeside}};
  for (const auto& step : kSteps) {
    const int nx = x + step[0];
    const int ny = y + step[1];
    if (nx < 1 || ny < 1 || nx >= labels.cols - 1 || ny >= labels.rows - 1) return true;
    const auto label = static_cast<SemanticClass>(labels.at<std::uint8_t>(ny, nx));
    if (hidesGround(label) && !sameThing(label, semantic_class)) return true;
  }
  return false;
}

// Whether the sight line to a pixel runs through what stands upright: its smear may have holes, but
// the floor behind it is not seen.
bool behindSomething(const cv::Mat& labels, const Eigen::Vector2d& pixel,
                     const Eigen::Vector2d& foot) {
  constexpr double kStep = 3.0;  // px
  constexpr int kEnough = 3;
  const double range = (pixel - foot).norm();
  const Eigen::Vector2d step = kStep / range * (foot - pixel);
  Eigen::Vector2d at = pixel + 2.0 * step;
  int hits = 0;
  for (double left = range - 2.0 * kStep; left > kStep; left -= kStep, at += step) {
    const auto u = static_cast<int>(at.x() + 0.5);
    const auto v = static_cast<int>(at.y() + 0.5);
    if (u < 0 || v < 0 || u >= labels.cols || v >= labels.rows) continue;
    const auto label = static_cast<SemanticClass>(labels.at<std::uint8_t>(v, u));
    if (label == SemanticClass::kUnknown || !hidesGround(label)) continue;
    if (++hits >= kEnough) return true;
  }
  return false;
}

}  // namespace

ContactFinder::ContactFinder(const BevGeometry& geometry, const BevViews& views)
    : geometry_(geometry), views_(views) {
  PARKADE_CHECK(views.view_of.cols == geometry.width_px && views.view_of.rows == geometry.height_px,
                "views of {} x {} px", views.view_of.cols, views.view_of.rows);
  before_ = cv::Mat(geometry.height_px, geometry.width_px, CV_32SC3, cv::Scalar::all(0));
  for (int v = kBorder; v < before_.rows - kBorder; ++v) {
    for (int u = kBorder; u < before_.cols - kBorder; ++u) {
      const auto index = views.view_of.at<std::uint8_t>(v, u);
      if (index >= views.views.size()) continue;
      const Eigen::Vector2d d = geometry.toPixel(views.views[index].foot) - Eigen::Vector2d(u, v);
      if (d.norm() < kSightReach + 1.0) continue;
      const Eigen::Vector2d step = kSightReach * d.normalized();
      const Eigen::Vector2d side = Eigen::Vector2d(-d.y(), d.x()).normalized();
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d at = step + (k - 1) * side;
        before_.at<cv::Vec3i>(v, u)[k] = static_cast<int>(std::lround(at.y())) * before_.cols +
                                         static_cast<int>(std::lround(at.x()));
      }
    }
  }
}

std::vector<ContactEdge> ContactFinder::find(const BevLabels& bev, SemanticClass semantic_class,
                                             double gap, int min_confidence, int min_pixels) const {
  const int rows = bev.labels.rows;
  const int cols = bev.labels.cols;
  PARKADE_CHECK(rows == before_.rows && cols == before_.cols && bev.labels.isContinuous(),
                "labels of {} x {} px", cols, rows);
  cv::Mat contact(rows, cols, CV_8UC1, cv::Scalar(0));
  bool any = false;
  for (int v = kBorder; v < rows - kBorder; ++v) {
    const std::uint8_t* label = bev.labels.ptr<std::uint8_t>(v);
    const std::uint8_t* sure = bev.confidence.ptr<std::uint8_t>(v);
    const auto* before = before_.ptr<cv::Vec3i>(v);
    std::uint8_t* out = contact.ptr<std::uint8_t>(v);
    for (int u = kBorder; u < cols - kBorder; ++u) {
      if (!sameThing(static_cast<SemanticClass>(label[u]), semantic_class)) continue;
      if (sure[u] < min_confidence || before[u][1] == 0) continue;
      bool ground = true;
      for (int k = 0; k < 3 && ground; ++k) {
        ground = !hidesGround(static_cast<SemanticClass>(label[u + before[u][k]]));
      }
      if (!ground) continue;
      const BevViews::View& view = views_.views[views_.view_of.at<std::uint8_t>(v, u)];
      if (behindSomething(bev.labels, {u, v}, geometry_.toPixel(view.foot))) continue;
      out[u] = 255;
      any = true;
    }
  }
  std::vector<ContactEdge> edges;
  if (!any) return edges;
  cv::Rect box = cv::boundingRect(contact);
  cv::Mat grown;
  if (gap > 0.0) {
    const int reach =
        std::max(1, static_cast<int>(std::lround(0.5 * gap / geometry_.metres_per_px)));
    cv::dilate(contact(box), grown, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8UC1));
  } else {
    grown = bev.labels == static_cast<int>(semantic_class);
    box = cv::Rect(0, 0, cols, rows);
  }
  cv::Mat edge_of;
  const int count = cv::connectedComponents(grown, edge_of, 8, CV_32S);
  std::vector<ContactEdge> all(static_cast<std::size_t>(count));
  std::vector<int> hidden(all.size(), 0);
  std::vector<std::vector<int>> votes(all.size(), std::vector<int>(views_.views.size(), 0));
  for (int v = 0; v < box.height; ++v) {
    const int y = v + box.y;
    for (int u = 0; u < box.width; ++u) {
      const int x = u + box.x;
      if (contact.at<std::uint8_t>(y, x) == 0) continue;
      const auto index = static_cast<std::size_t>(edge_of.at<int>(v, u));
      ContactEdge& edge = all[index];
      ++votes[index][views_.view_of.at<std::uint8_t>(y, x)];
      edge.points.push_back(geometry_.toGround(Eigen::Vector2d(x, y)));
      edge.confidence += bev.confidence.at<std::uint8_t>(y, x) / 255.0;
      if (endsAt(bev.labels, x, y, semantic_class)) ++hidden[index];
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    ContactEdge& edge = all[i];
    if (static_cast<int>(edge.points.size()) < min_pixels) continue;
    edge.semantic_class = semantic_class;
    edge.view =
        static_cast<int>(std::max_element(votes[i].begin(), votes[i].end()) - votes[i].begin());
    edge.confidence /= static_cast<double>(edge.points.size());
    edge.cut = hidden[i] >= 2;
    edges.push_back(std::move(edge));
  }
  return edges;
}

}  // namespace parkade
