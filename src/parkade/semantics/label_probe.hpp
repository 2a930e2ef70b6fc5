// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "parkade/semantics/lines/line_chains.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Reads the labels of a bird's-eye picture at ground points.
class LabelProbe {
 public:
  explicit LabelProbe(const BevLabels& labels) : labels_(labels) {}

  /// kUnknown beyond the picture.
  [[nodiscard]] SemanticClass at(const Eigen::Vector2d& p) const {
    return static_cast<SemanticClass>(
        valueAt(labels_.labels, p).value_or(static_cast<std::uint8_t>(SemanticClass::kUnknown)));
  }
  [[nodiscard]] bool isPaint(const Eigen::Vector2d& p) const {
    return at(p) == SemanticClass::kSlotLine;
  }
  [[nodiscard]] bool isHidden(const Eigen::Vector2d& p) const { return hidesFloor(at(p)); }

  /// Log-odds, at most 0, of slot line against what is likeliest (BevLabels::slot_line); very low
  /// beyond the picture and where the network does not tell.
  [[nodiscard]] double slotEvidence(const Eigen::Vector2d& p) const {
    constexpr double kNone = -100.0;
    const std::optional<std::uint8_t> value = valueAt(labels_.slot_line, p);
    return value ? (*value - 255.0) / kEvidencePerLogOdds : kNone;
  }

  /// What lies along the line from a to b, as shares of its samples, one per pixel.
  struct Shares {
    double paint = 0.0;
    double floor = 0.0;   ///< anything else on the floor
    double hidden = 0.0;  ///< or beyond the picture
  };
  /// half_width (m): paint that near beside the line counts, too.
  [[nodiscard]] Shares along(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                             double half_width = 0.0) const {
    Shares shares;
    const double step = labels_.geometry.metres_per_px;
    const double length = (b - a).norm();
    const int count = static_cast<int>(length / step) + 1;
    const Eigen::Vector2d d = length > 0.0 ? Eigen::Vector2d((b - a) / length) : b - a;
    const Eigen::Vector2d n(-d.y(), d.x());
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector2d p = a + (count > 1 ? length * i / (count - 1) : 0.0) * d;
      bool paint = isPaint(p);
      for (double off = step; !paint && off <= half_width; off += step) {
        paint = isPaint(p + off * n) || isPaint(p - off * n);
      }
      if (paint) {
        shares.paint += 1.0;
      } else if (isHidden(p)) {
        shares.hidden += 1.0;
      } else {
        shares.floor += 1.0;
      }
    }
    shares.paint /= count;
    shares.floor /= count;
    shares.hidden /= count;
    return shares;
  }

  [[nodiscard]] const BevLabels& labels() const { return labels_; }

 private:
  // Of a picture (CV_8UC1) of the labels' size, or an empty one.
  [[nodiscard]] std::optional<std::uint8_t> valueAt(const cv::Mat& picture,
                                                    const Eigen::Vector2d& p) const {
    const Eigen::Vector2d pixel = labels_.geometry.toPixel(p);
    const int u = static_cast<int>(std::floor(pixel.x() + 0.5));
    const int v = static_cast<int>(std::floor(pixel.y() + 0.5));
    if (u < 0 || v < 0 || u >= picture.cols || v >= picture.rows) return std::nullopt;
    return picture.at<std::uint8_t>(v, u);
  }

  const BevLabels& labels_;
};

}  // namespace parkade
