// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>

#include "parkade/core/check.hpp"
#include "parkade/core/yaml.hpp"
#include "parkade/semantics/networks/onnx_network.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"

namespace parkade {
namespace {

constexpr int kBeam = 8;
constexpr int kReadings = 5;

/// What the YAML file says.
struct TextNetworkFile {
  std::string network;
  std::string letters;
  double mean = 0.0;
  double scale = 1.0;
};

TextNetworkFile parseTextNetwork(const YamlNode& root, const std::string& path) {
  root.allowOnly({"network", "input", "letters"});
  TextNetworkFile file;
  file.network =
      (std::filesystem::path(path).parent_path() / root.at("network").asString()).string();
  const YamlNode input = root.at("input");
  input.allowOnly({"width", "height", "mean", "scale"});
  if (input.at("width").asInt() != kZonePatchWidth ||
      input.at("height").asInt() != kZonePatchHeight) {
    input.fail(fmt::format("{} x {} px; faces are straightened to {} x {} px",
                           input.at("width").asInt(), input.at("height").asInt(), kZonePatchWidth,
                           kZonePatchHeight));
  }
  file.mean = input.at("mean").asDouble();
  file.scale = input.at("scale").asDouble();
  file.letters = root.at("letters").asString();
  for (std::size_t i = 0; i < file.letters.size(); ++i) {
    if (file.letters.find(file.letters[i], i + 1) != std::string::npos) {
      root.at("letters").fail(fmt::format("'{}' comes twice", file.letters[i]));
    }
  }
  if (file.letters.empty()) root.at("letters").fail("expected at least one letter");
  return file;
}

}  // namespace

struct ZoneTextReader::Impl {
  TextNetworkFile file;
  std::optional<OnnxNetwork> net;
  bool takes_tall = false;
  cv::Mat input;

  // Logits for each patch from the uppermost down, one row per letter (and the blank).
  Result<std::vector<cv::Mat>> forward(const cv::Mat& patch) {
    const std::array<int, 4> shape{1, 3, patch.rows, patch.cols};
    input.create(4, shape.data(), CV_32F);
    for (int v = 0; v < patch.rows; ++v) {
      const auto* in = patch.ptr<cv::Vec3b>(v);
      for (int c = 0; c < 3; ++c) {
        float* out = input.ptr<float>(0, c) + static_cast<std::ptrdiff_t>(v) * patch.cols;
        for (int u = 0; u < patch.cols; ++u) {
          out[u] = static_cast<float>((in[u][2 - c] - file.mean) * file.scale);  // RGB
        }
      }
    }
    const bool tall = patch.rows == kTallPatchHeight;
    Result<cv::Mat> result = net->run(input);
    if (!result) return result.error();
    const cv::Mat out = std::move(result).value();
    const int channels = static_cast<int>(file.letters.size()) + 1;
    const int looks = tall ? (kTallPatchHeight - kZonePatchHeight) / kTallPatchStep + 1 : 1;
    if (out.dims != 4 || out.size[1] != channels || out.size[2] != looks) {
      return Error{
          fmt::format("{}: the network's output is {}; expected 1 x {} x {} x steps numbers: a "
                      "blank and {} letters",
                      file.network, shapeOf(out), channels, looks, file.letters.size())};
    }
    std::vector<cv::Mat> logits;
    for (int k = 0; k < looks; ++k) {
      cv::Mat rows(channels, out.size[3], CV_32F);
      for (int c = 0; c < channels; ++c) {
        const auto* const from = out.ptr<float>(0, c, k);
        std::copy(from, from + out.size[3], rows.ptr<float>(c));
      }
      logits.push_back(rows);
    }
    return logits;
  }

  // Letters that are not asked for are never there.
  SequenceLikelihood likelihood(cv::Mat logits, const std::string& only) const {
    constexpr double kNever = -1e4;
    for (std::size_t i = 0; i < file.letters.size() && !only.empty(); ++i) {
      if (only.find(file.letters[i]) == std::string::npos) {
        logits.row(static_cast<int>(i) + 1).setTo(cv::Scalar(kNever));
      }
    }
    return {logits, file.letters};
  }
};

ZoneTextReader::ZoneTextReader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ZoneTextReader::ZoneTextReader(ZoneTextReader&&) noexcept = default;
ZoneTextReader& ZoneTextReader::operator=(ZoneTextReader&&) noexcept = default;
ZoneTextReader::~ZoneTextReader() = default;

const std::string& ZoneTextReader::letters() const {
  return impl_->file.letters;
}

Status ZoneTextReader::knows(const std::string& wanted, const std::string& option) const {
  if (wanted.find_first_not_of(letters()) == std::string::npos) return {};
  return Error{fmt::format("{}: '{}' holds more than the letters that {} reads, '{}'", option,
                           wanted, impl_->file.network, letters())};
}

Result<ZoneTextReader> ZoneTextReader::load(const std::string& path) {
  Result<TextNetworkFile> file = parseYamlFile<TextNetworkFile>(
      path, [&](const YamlNode& root) { return parseTextNetwork(root, path); });
  if (!file) return file.error();
  auto impl = std::make_unique<Impl>();
  impl->file = std::move(file).value();
  Result<OnnxNetwork> net = OnnxNetwork::read(impl->file.network, path);
  if (!net) return net.error();
  impl->net = std::move(net).value();
  const auto tried =
      impl->forward(cv::Mat(kZonePatchHeight, kZonePatchWidth, CV_8UC3, cv::Scalar::all(0)));
  if (!tried) return tried.error();
  impl->takes_tall = static_cast<bool>(
      impl->forward(cv::Mat(kTallPatchHeight, kZonePatchWidth, CV_8UC3, cv::Scalar::all(0))));
  return ZoneTextReader(std::move(impl));
}

Result<SequenceLikelihood> ZoneTextReader::look(const cv::Mat& patch, const std::string& only) {
  PARKADE_CHECK(
      patch.type() == CV_8UC3 && patch.cols == kZonePatchWidth && patch.rows == kZonePatchHeight,
      "patch of {} x {} px, type {}", patch.cols, patch.rows, patch.type());
  const auto logits = impl_->forward(patch);
  if (!logits) return logits.error();
  return impl_->likelihood(logits->front(), only);
}

Result<std::vector<SequenceLikelihood>> ZoneTextReader::lookAround(const cv::Mat& tall,
                                                                   const std::string& only) {
  PARKADE_CHECK(
      tall.type() == CV_8UC3 && tall.cols == kZonePatchWidth && tall.rows == kTallPatchHeight,
      "patch of {} x {} px, type {}", tall.cols, tall.rows, tall.type());
  std::vector<SequenceLikelihood> looks;
  if (!impl_->takes_tall) return looks;
  const auto logits = impl_->forward(tall);
  if (!logits) return logits.error();
  for (const cv::Mat& each : *logits) looks.push_back(impl_->likelihood(each, only));
  return looks;
}

std::vector<TextReading> ZoneTextReader::readingsOf(const SequenceLikelihood& letters) {
  return letters.best(kBeam, kReadings);
}

Result<std::vector<TextReading>> ZoneTextReader::read(const cv::Mat& patch,
                                                      const std::string& only) {
  const Result<SequenceLikelihood> letters = look(patch, only);
  if (!letters) return letters.error();
  return readingsOf(*letters);
}

}  // namespace parkade
