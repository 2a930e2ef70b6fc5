// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/onnx_network.hpp"

#include <fmt/core.h>

#include <array>
#include <filesystem>
#include <map>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <optional>
#include <utility>

#include "parkade/semantics/networks/compiled_network.hpp"

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

cv::dnn::Net readByOpenCv(const std::string& path) {
  cv::dnn::Net net = cv::dnn::readNetFromONNX(path);
  net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  return net;
}

}  // namespace

struct OnnxNetwork::Impl {
  std::string path;
  std::optional<CompiledNetwork> compiled;
  // By height and width of the input: OpenCV is slow to change it.
  std::map<std::array<int, 2>, cv::dnn::Net> nets;
  cv::dnn::Net unused;  // read already, for the first size

  Result<cv::Mat> forward(const cv::Mat& input) {
    if (compiled) return compiled->run(input);
    try {
      const QuietOpenCv quiet;
      const std::array<int, 2> size{input.size[2], input.size[3]};
      auto found = nets.find(size);
      if (found == nets.end()) {
        if (unused.empty()) unused = readByOpenCv(path);
        found = nets.emplace(size, std::exchange(unused, {})).first;
      }
      found->second.setInput(input);
      return found->second.forward();
    } catch (const cv::Exception& error) {
      return Error{shortMessage(error)};
    }
  }
};

OnnxNetwork::OnnxNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
OnnxNetwork::OnnxNetwork(OnnxNetwork&&) noexcept = default;
OnnxNetwork& OnnxNetwork::operator=(OnnxNetwork&&) noexcept = default;
OnnxNetwork::~OnnxNetwork() = default;

bool OnnxNetwork::isCompiled() const {
  return impl_->compiled.has_value();
}

Result<OnnxNetwork> OnnxNetwork::read(const std::string& path, const std::string& named_by) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) {
    return Error{fmt::format("{}: network: there is no file {}", named_by, path)};
  }
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  if (std::optional<NetworkGraph> graph = readNetworkGraph(path)) {
    impl->compiled.emplace(std::move(*graph));
    return OnnxNetwork(std::move(impl));
  }
  try {
    const QuietOpenCv quiet;
    impl->unused = readByOpenCv(path);
  } catch (const cv::Exception& error) {
    return Error{
        fmt::format("{}: OpenCV cannot read this ONNX file: {}", path, shortMessage(error))};
  }
  return OnnxNetwork(std::move(impl));
}

Result<cv::Mat> OnnxNetwork::run(const cv::Mat& input) {
  Result<cv::Mat> output = impl_->forward(input);
  if (output) return output;
  return Error{fmt::format("{}: the network does not take a picture of {} x {} px: {}", impl_->path,
                           input.size[3], input.size[2], output.error().message)};
}

std::string shapeOf(const cv::Mat& numbers) {
  std::string text;
  for (int i = 0; i < numbers.dims; ++i) {
    text += fmt::format("{}{}", i ? " x " : "", numbers.size[i]);
  }
  return text;
}

}  // namespace parkade
