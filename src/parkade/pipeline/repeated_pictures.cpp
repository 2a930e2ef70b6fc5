// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/repeated_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <string_view>

#include "parkade/core/log.hpp"

namespace parkade {
namespace {

std::size_t hashOfRows(const cv::Mat& image) {
  constexpr int kEvery = 16;
  const std::size_t bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
  std::size_t hash = static_cast<std::size_t>(image.rows);
  for (int v = kEvery / 2; v < image.rows; v += kEvery) {
    const std::string_view row(reinterpret_cast<const char*>(image.ptr(v)), bytes);
    hash = 31 * hash + std::hash<std::string_view>{}(row);
  }
  return hash;
}

}  // namespace

RepeatedPictures::RepeatedPictures(const Rig& rig) {
  for (const RigCamera& camera : rig.cameras) last_.push_back({camera.name});
}

int RepeatedPictures::drop(FrameSet& frames, bool moves) {
  int dropped = 0;
  for (std::size_t c = 0; c < std::min(last_.size(), frames.images.size()); ++c) {
    if (frames.images[c].empty()) continue;
    Last& last = last_[c];
    const std::size_t rows = hashOfRows(frames.images[c]);
    if (rows != last.rows) {
      last.rows = rows;
      last.said = false;
      continue;
    }
    if (!moves) continue;
    if (!last.said) {
      logWarning("{} gives the same picture again from {} ns on, while the car moves: left out",
                 last.camera, frames.t_ns);
      last.said = true;
    }
    frames.images[c] = cv::Mat();
    if (c < frames.gray.size()) frames.gray[c] = cv::Mat();
    if (c < frames.image_t_ns.size()) frames.image_t_ns[c] = 0;
    ++dropped;
  }
  return dropped;
}

bool saysMotion(const std::vector<WheelSample>& wheels) {
  constexpr double kTurning = 0.15;  // m/s
  return std::any_of(wheels.begin(), wheels.end(), [](const WheelSample& sample) {
    return std::abs(sample.rear_left_mps) > kTurning || std::abs(sample.rear_right_mps) > kTurning;
  });
}

bool saysMotion(const MotionPrior& prior) {
  constexpr double kMoved = 0.02;   // m
  constexpr double kTurned = 5e-3;  // rad
  if (!prior.valid) return false;
  const SE3& T = prior.T_previous_current;
  return (prior.translation_valid && T.translation().norm() > kMoved) ||
         T.rotation().log().norm() > kTurned;
}

}  // namespace parkade
