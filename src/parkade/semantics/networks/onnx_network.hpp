// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>

#include "parkade/core/result.hpp"

namespace parkade {

/// A network from an ONNX file, for the processor: compiled by oneDNN where it is made of what
/// readNetworkGraph knows (three times as fast), run by OpenCV otherwise. Not thread-safe: it keeps
/// buffers.
class OnnxNetwork {
 public:
  /// Fails where there is no such file (and names `named_by`, the file that asked for it) or OpenCV
  /// cannot read it.
  static Result<OnnxNetwork> read(const std::string& path, const std::string& named_by);

  OnnxNetwork(OnnxNetwork&&) noexcept;
  OnnxNetwork& operator=(OnnxNetwork&&) noexcept;
  ~OnnxNetwork();

  [[nodiscard]] bool isCompiled() const;

  /// input: 1 x 3 x height x width numbers (CV_32F). What it gives is overwritten by the next run
  /// with an input of that size. The first input of each size takes longer. Fails where it does not
  /// take that size.
  Result<cv::Mat> run(const cv::Mat& input);

 private:
  struct Impl;
  explicit OnnxNetwork(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// "1 x 36 x 1 x 48".
std::string shapeOf(const cv::Mat& numbers);

}  // namespace parkade
