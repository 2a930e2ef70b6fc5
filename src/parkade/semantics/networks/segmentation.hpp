// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "parkade/core/result.hpp"
#include "parkade/semantics/networks/class_map.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Parkade's own networks, by the names of their files.
inline constexpr const char* kBevNetwork = "bev_segmentation";
inline constexpr const char* kViewNetwork = "view_segmentation";

/// The class of every pixel of a camera's picture, at the size that the network labels.
struct ViewLabels {
  cv::Mat labels;      ///< CV_8UC1: SemanticClass
  cv::Mat confidence;  ///< CV_8UC1: probability of that class, 255 = 1
};

/// A segmentation network from an ONNX file (OnnxNetwork). Not thread-safe: it keeps buffers.
class SegmentationNetwork {
 public:
  /// Reads a class map and its network, and tries it on an empty picture. Fails with the file and
  /// what is wrong: no such file, no ONNX, an input of another size, another number of classes.
  static Result<SegmentationNetwork> load(const std::string& class_map_path);

  /// The user's network where a class map is named, else Parkade's own of that name (kBevNetwork or
  /// kViewNetwork). Fails also where the user's is for the other kind of pictures.
  static Result<SegmentationNetwork> loadOrOwn(const std::string& class_map_path,
                                               const std::string& own_name);

  SegmentationNetwork(SegmentationNetwork&&) noexcept;
  SegmentationNetwork& operator=(SegmentationNetwork&&) noexcept;
  ~SegmentationNetwork();

  [[nodiscard]] const ClassMap& classMap() const;

  /// Whether it takes bird's-eye pictures of this geometry; fails where it is for camera views, or
  /// for one size only and the picture has another.
  [[nodiscard]] Status takes(const BevGeometry& geometry) const;

  /// Labels a bird's-eye picture (BGR or grey); where it is not valid: kUnknown, confidence 0.
  /// Strokes that the network cuts into several classes are united (uniteStrokes). The picture is
  /// brought to the network's metres per pixel and the labels back. Fails where it does not take
  /// the picture (takes()).
  Result<BevLabels> segment(const BevImage& bev);

  /// Labels a camera's picture (BGR or grey), shrunk or stretched to the network's size.
  Result<ViewLabels> segmentView(const cv::Mat& image);

 private:
  struct Impl;
  explicit SegmentationNetwork(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
