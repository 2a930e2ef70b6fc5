// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "parkade/cli/semantic_samples.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade::cli {

/// A zone text on a face of a pillar, or a sign's, as one camera should see it.
struct TrueZoneText {
  std::string text;
  double distance = 0.0;  ///< m, from the camera to the text's middle
  double slant = 0.0;     ///< rad, between the face's normal and the line of sight
  double in_sight = 0.0;  ///< share of its area that is in the picture and not hidden
  double height_px = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  ///< px
  std::vector<Eigen::Vector2d> places;  ///< px, spread evenly over it, from left to right
};

/// The texts of zone markers, or of signs of a class, that face a camera of a sample within `reach`
/// metres, hidden ones too. Of a speed-limit sign, the middle that bears its number; of a guide
/// sign the back too, without text. labels: the camera's true labels.
std::vector<TrueZoneText> trueZoneTexts(const SemanticSampler& sampler,
                                        const SemanticSample& sample, int camera,
                                        const cv::Mat& labels, double reach,
                                        SemanticClass sign = SemanticClass::kZoneMarker);

/// The text whose middle lies in a quadrilateral of the picture (corners in order), the nearest to
/// its middle; null where there is none.
const TrueZoneText* textWithin(const std::vector<TrueZoneText>& texts,
                               const std::array<Eigen::Vector2d, 4>& corners);

/// Whether what was read on a face is the text there (textWithin(); null: none, so that nothing can
/// be right). Nothing where that is further away than `reach`, which is not judged.
inline std::optional<bool> isRight(const std::string& reading, const TrueZoneText* text,
                                   double reach) {
  if (text == nullptr) return false;
  if (text->distance > reach) return std::nullopt;
  return reading == text->text;
}

/// Share of a text's area that lies in a quadrilateral (corners in order); of the part of it from
/// `from` to `to` of its width.
double shareWithin(const TrueZoneText& text, const std::array<Eigen::Vector2d, 4>& corners,
                   double from = 0.0, double to = 1.0);

/// Labels of the size that the view network gives, taken from full ones.
cv::Mat atNetworkSize(const cv::Mat& labels);

}  // namespace parkade::cli
