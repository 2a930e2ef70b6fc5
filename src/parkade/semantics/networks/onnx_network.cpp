// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/onnx_network.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <opencv2/core/utils/logger.hpp>

namespace parkade {
namespace {

// OpenCV prints what it throws as well; the library prints nothing.
class QuietOpenCv {
 public:
  QuietOpenCv() : before_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~QuietOpenCv() { cv::utils::logging::setLogLevel(before_); }
  QuietOpenCv(const QuietOpenCv&) = delete;
  QuietOpenCv& operator=(const QuietOpenCv&) = delete;

 private:
  cv::utils::logging::LogLevel before_;
};

// The first line of OpenCV's message, without its own version and source file.
std::string shortMessage(const cv::Exception& error) {
  const std::string text = error.err.empty() ? error.what() : error.err;
  return text.substr(0, text.find('\n'));
}

}  // namespace

Result<cv::dnn::Net> readOnnx(const std::string& path, const std::string& named_by) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    return Error{fmt::format("{}: network: there is no file {}", named_by, path)};
  }
  try {
    const QuietOpenCv quiet;
    cv::dnn::Net net = cv::dnn::readNetFromONNX(path);
    net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return net;
  } catch (const cv::Exception& error) {
    return Error{
        fmt::format("{}: OpenCV cannot read this ONNX file: {}", path, shortMessage(error))};
  }
}

Result<cv::Mat> runOnnx(cv::dnn::Net& net, const cv::Mat& input, const std::string& path) {
  try {
    const QuietOpenCv quiet;
    net.setInput(input);
    return net.forward();
  } catch (const cv::Exception& error) {
    return Error{fmt::format("{}: the network does not take a picture of {} x {} px: {}", path,
                             input.size[3], input.size[2], shortMessage(error))};
  }
}

std::string shapeOf(const cv::Mat& numbers) {
  std::string text;
  for (int i = 0; i < numbers.dims; ++i) {
    text += fmt::format("{}{}", i ? " x " : "", numbers.size[i]);
  }
  return text;
}

}  // namespace parkade
