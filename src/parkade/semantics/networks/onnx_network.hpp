// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/dnn.hpp>
#include <string>

#include "parkade/core/result.hpp"

namespace parkade {

/// A network from an ONNX file, for the processor. Fails where there is no such file (and names
/// `named_by`, the file that asked for it) or OpenCV cannot read it.
Result<cv::dnn::Net> readOnnx(const std::string& path, const std::string& named_by);

/// Runs it on 1 x 3 x height x width numbers; fails where it does not take that size. path: for the
/// message.
Result<cv::Mat> runOnnx(cv::dnn::Net& net, const cv::Mat& input, const std::string& path);

/// "1 x 36 x 1 x 48".
std::string shapeOf(const cv::Mat& numbers);

}  // namespace parkade
