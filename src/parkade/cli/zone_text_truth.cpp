// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/zone_text_truth.hpp"

#include <algorithm>
#include <cmath>

namespace parkade::cli {
namespace {

constexpr int kAcross = 9;
constexpr int kUp = 5;
constexpr double kPlaces = kAcross * kUp;
const Eigen::Vector2d kNowhere = Eigen::Vector2d::Constant(-1e6);

// Share of a sign's area that the labels show as its class; and where it is in the picture.
double shareInSight(const sim::Sign& sign, const SE3& T_cam_world, const Camera& camera,
                    const cv::Mat& labels, std::vector<Eigen::Vector2d>& places) {
  const double share = sign.semantic_class == SemanticClass::kSpeedLimitSign ? 0.6 : 1.0;
  int seen = 0;
  for (int i = 0; i < kAcross; ++i) {
    for (int j = 0; j < kUp; ++j) {
      const Eigen::Vector3d p_sign(((i + 0.5) / kAcross - 0.5) * share * sign.width,
                                   ((j + 0.5) / kUp - 0.5) * share * sign.height, 0.0);
      Eigen::Vector2d pixel;
      if (!camera.project(T_cam_world * (sign.T_world_sign * p_sign), pixel)) {
        places.push_back(kNowhere);
        continue;
      }
      places.push_back(pixel);
      if (!camera.inImage(pixel, 1.0)) continue;
      const auto label = labels.at<std::uint8_t>(static_cast<int>(std::lround(pixel.y())),
                                                 static_cast<int>(std::lround(pixel.x())));
      seen += label == static_cast<std::uint8_t>(sign.semantic_class) ? 1 : 0;
    }
  }
  return seen / kPlaces;
}

bool isInside(const Eigen::Vector2d& pixel, const std::array<Eigen::Vector2d, 4>& corners) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector2d along = corners[(k + 1) % 4] - corners[k];
    const Eigen::Vector2d to = pixel - corners[k];
    if (along.x() * to.y() - along.y() * to.x() < 0.0) return false;
  }
  return true;
}

}  // namespace

std::vector<TrueZoneText> trueZoneTexts(const SemanticSampler& sampler,
                                        const SemanticSample& sample, int camera,
                                        const cv::Mat& labels, double reach,
                                        SemanticClass sign_class) {
  const RigCamera& eye = sampler.simulation().trueRig().cameras[static_cast<std::size_t>(camera)];
  const SE3 T_cam_world = (sample.T_world_vehicle * eye.T_vehicle_cam).inverse();
  std::vector<TrueZoneText> texts;
  for (const sim::Sign& sign : sampler.simulation().garage().signs) {
    if (sign.semantic_class != sign_class) continue;
    const Eigen::Vector3d middle = T_cam_world * sign.T_world_sign.translation();
    const Eigen::Vector3d normal =
        T_cam_world.rotation() * (sign.T_world_sign.rotation() * Eigen::Vector3d::UnitZ());
    TrueZoneText text;
    text.text = sign.text;
    text.distance = middle.norm();
    double facing = -normal.dot(middle) / text.distance;
    if (facing <= 0.0 && sign_class == SemanticClass::kGuideSign) {
      text.text.clear();  // a board's back
      facing = -facing;
    }
    if (text.distance > reach || facing <= 0.0) continue;
    text.slant = std::acos(std::min(1.0, facing));
    Eigen::Vector2d top;
    const Eigen::Vector3d half_up =
        T_cam_world.rotation() * Eigen::Vector3d(0.0, 0.0, 0.5 * sign.height);
    if (!eye.camera.project(middle, text.middle) || !eye.camera.project(middle + half_up, top)) {
      continue;
    }
    text.height_px = 2.0 * (top - text.middle).norm();
    text.in_sight = shareInSight(sign, T_cam_world, eye.camera, labels, text.places);
    texts.push_back(text);
  }
  return texts;
}

const TrueZoneText* textWithin(const std::vector<TrueZoneText>& texts,
                               const std::array<Eigen::Vector2d, 4>& corners) {
  const Eigen::Vector2d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  const TrueZoneText* best = nullptr;
  double nearest = 1e9;
  for (const TrueZoneText& text : texts) {
    const double distance = (text.middle - middle).norm();
    // Hidden texts behind a nearer marker share its place in the picture.
    if (!isInside(text.middle, corners) || distance >= nearest || text.in_sight <= 0.0) continue;
    nearest = distance;
    best = &text;
  }
  return best;
}

double shareWithin(const TrueZoneText& text, const std::array<Eigen::Vector2d, 4>& corners,
                   double from, double to) {
  int all = 0;
  int within = 0;
  for (int i = 0; i < kAcross; ++i) {
    const double at = (i + 0.5) / kAcross;
    if (at < from || at > to) continue;
    for (int j = 0; j < kUp; ++j) {
      ++all;
      within += isInside(text.places[static_cast<std::size_t>(i * kUp + j)], corners) ? 1 : 0;
    }
  }
  return all > 0 ? static_cast<double>(within) / all : 0.0;
}

cv::Mat atNetworkSize(const cv::Mat& labels) {
  const cv::Size size(320, 192);
  cv::Mat out(size, CV_8UC1);
  for (int v = 0; v < size.height; ++v) {
    const int y = static_cast<int>((v + 0.5) * labels.rows / size.height);
    for (int u = 0; u < size.width; ++u) {
      const int x = static_cast<int>((u + 0.5) * labels.cols / size.width);
      out.at<std::uint8_t>(v, u) = labels.at<std::uint8_t>(y, x);
    }
  }
  return out;
}

}  // namespace parkade::cli
