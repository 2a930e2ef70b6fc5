// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/segmentation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "parkade/core/check.hpp"
#include "parkade/semantics/lines/paint_strokes.hpp"
#include "parkade/semantics/networks/label_decoding.hpp"
#include "parkade/semantics/networks/onnx_network.hpp"

namespace parkade {
namespace {

constexpr int kMultiple = 32;  // sizes that a network of any size takes

int roundUp(int value) {
  return (value + kMultiple - 1) / kMultiple * kMultiple;
}

Error wrongKind(const std::string& path, bool for_views) {
  return {fmt::format("{}: this network is for {}", path,
                      for_views ? "camera views (it has no input: metres_per_px), not for "
                                  "bird's-eye pictures"
                                : "bird's-eye pictures (it has input: metres_per_px), not for "
                                  "camera views")};
}

}  // namespace

struct SegmentationNetwork::Impl {
  ClassMap map;
  std::optional<OnnxNetwork> net;
  cv::Mat input;     // N x C x H x W
  cv::Mat logits;    // the same, of the output
  cv::Mat mirrored;  // the input's mirror image
  cv::Mat resized;

  Status addMirrored(const cv::Size& size);
  Status forward(const cv::Mat& bgr);
  // Of a bird's-eye picture at the network's metres per pixel.
  [[nodiscard]] cv::Size sizeFor(const BevGeometry& geometry) const {
    const double factor = geometry.metres_per_px / map.metres_per_px;
    return {static_cast<int>(std::lround(geometry.width_px * factor)),
            static_cast<int>(std::lround(geometry.height_px * factor))};
  }
  [[nodiscard]] Status checkOutput(const cv::Size& size) const;
  // Whether each channel of a class holds one pixel of every 2 x 2 block.
  [[nodiscard]] bool inBlocks(const cv::Size& size) const;
  Result<DecodedLabels> run(const cv::Mat& image);
};

Status SegmentationNetwork::Impl::forward(const cv::Mat& bgr) {
  const std::array<int, 4> shape{1, 3, bgr.rows, bgr.cols};
  input.create(4, shape.data(), CV_32F);
  for (int v = 0; v < bgr.rows; ++v) {
    const std::uint8_t* in = bgr.ptr<std::uint8_t>(v);
    for (int c = 0; c < 3; ++c) {
      const int source = map.rgb ? 2 - c : c;
      const auto mean = static_cast<float>(map.mean[static_cast<std::size_t>(c)]);
      const auto scale = static_cast<float>(map.scale[static_cast<std::size_t>(c)]);
      float* out = input.ptr<float>(0, c) + static_cast<std::ptrdiff_t>(v) * bgr.cols;
      for (int u = 0; u < bgr.cols; ++u) {
        out[u] = (static_cast<float>(in[3 * u + source]) - mean) * scale;
      }
    }
  }
  Result<cv::Mat> out = net->run(input);
  if (!out) return out.error();
  logits = std::move(out).value();
  const Status as_expected = checkOutput(bgr.size());
  return as_expected && map.mirror ? addMirrored(bgr.size()) : as_expected;
}

// Takes the mean of the logits and of those of the mirror image, mirrored back.
Status SegmentationNetwork::Impl::addMirrored(const cv::Size& size) {
  mirrored.create(input.dims, input.size.p, CV_32F);
  const cv::Size lines(input.size[3], 3 * input.size[2]);
  cv::flip(cv::Mat(lines, CV_32F, input.data), cv::Mat(lines, CV_32F, mirrored.data), 1);
  cv::Mat mean = logits.clone();  // the next run writes where these are
  const Result<cv::Mat> other = net->run(mirrored);
  if (!other) return other.error();
  const int width = mean.size[3];
  // Within blocks left and right pixels are channels of their own.
  const int swap = inBlocks(size) ? 1 : 0;
  for (int c = 0; c < mean.size[1]; ++c) {
    for (int v = 0; v < mean.size[2]; ++v) {
      float* const to = mean.ptr<float>(0, c, v);
      const float* const from = other->ptr<float>(0, c ^ swap, v);
      for (int u = 0; u < width; ++u) to[u] = 0.5F * (to[u] + from[width - 1 - u]);
    }
  }
  logits = mean;
  return {};
}

Status SegmentationNetwork::Impl::checkOutput(const cv::Size& size) const {
  const int classes = static_cast<int>(map.classes.size());
  const std::string shape = shapeOf(logits);
  if (logits.dims != 4 || logits.size[0] != 1 || logits.type() != CV_32F) {
    return Error{fmt::format(
        "{}: the network's output is {}; expected 1 x channels x height x width numbers",
        map.network, shape)};
  }
  if (!inBlocks(size) && logits.size[1] != classes) {
    return Error{fmt::format(
        "{}: {} classes, but the network {} gives {} for a picture of {} x {} px; expected {} "
        "channels (or {} at half the size, four per class)",
        map.path, classes, map.network, shape, size.width, size.height, classes, 4 * classes)};
  }
  return {};
}

bool SegmentationNetwork::Impl::inBlocks(const cv::Size& size) const {
  if (logits.size[1] != 4 * static_cast<int>(map.classes.size())) return false;
  const cv::Size labels(2 * logits.size[3], 2 * logits.size[2]);
  if (labels == size) return true;
  // Labels of camera views may be coarser than what the network sees, by a whole number.
  const int step = std::max(1, size.width / std::max(1, labels.width));
  return map.metres_per_px <= 0.0 && size == cv::Size(step * labels.width, step * labels.height);
}

Result<DecodedLabels> SegmentationNetwork::Impl::run(const cv::Mat& image) {
  PARKADE_CHECK(image.type() == CV_8UC3 || image.type() == CV_8UC1, "picture of type {}",
                image.type());
  cv::Mat bgr = image;
  if (image.channels() == 1) cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
  const Status status = forward(bgr);
  if (!status) return status.error();
  const cv::Size size =
      inBlocks(bgr.size()) ? cv::Size(2 * logits.size[3], 2 * logits.size[2]) : bgr.size();
  return decodeLogits(logits, map.classes, size, map.unknown_is_unseen);
}

SegmentationNetwork::SegmentationNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SegmentationNetwork::SegmentationNetwork(SegmentationNetwork&&) noexcept = default;
SegmentationNetwork& SegmentationNetwork::operator=(SegmentationNetwork&&) noexcept = default;
SegmentationNetwork::~SegmentationNetwork() = default;

const ClassMap& SegmentationNetwork::classMap() const {
  return impl_->map;
}

Result<SegmentationNetwork> SegmentationNetwork::loadOrOwn(const std::string& class_map_path,
                                                           const std::string& own_name) {
  const Result<std::string> path = namedOrOwnModel(class_map_path, own_name);
  if (!path) return path.error();
  Result<SegmentationNetwork> network = load(*path);
  if (!network) return network;
  const bool for_views = network->classMap().metres_per_px <= 0.0;
  if (for_views == (own_name == kViewNetwork)) return network;
  return wrongKind(*path, for_views);
}

Result<SegmentationNetwork> SegmentationNetwork::load(const std::string& class_map_path) {
  Result<ClassMap> map = readClassMap(class_map_path);
  if (!map) return map.error();
  auto impl = std::make_unique<Impl>();
  impl->map = std::move(map).value();
  Result<OnnxNetwork> net = OnnxNetwork::read(impl->map.network, class_map_path);
  if (!net) return net.error();
  impl->net = std::move(net).value();
  const Status status =
      impl->forward(cv::Mat(impl->map.height, impl->map.width, CV_8UC3, cv::Scalar::all(0)));
  if (!status) return status.error();
  return SegmentationNetwork(std::move(impl));
}

Status SegmentationNetwork::takes(const BevGeometry& geometry) const {
  const ClassMap& map = impl_->map;
  if (map.metres_per_px <= 0.0) {
    return wrongKind(map.path, true);
  }
  const cv::Size size = impl_->sizeFor(geometry);
  if (map.any_size || (size.width == map.width && size.height == map.height)) return {};
  return Error{fmt::format(
      "{}: the network takes {} x {} px of {} m, the bird's-eye picture has {} x {} px of {} m; "
      "set the picture's width_px, height_px and metres_per_px to match (--set, see --help)",
      map.path, map.width, map.height, map.metres_per_px, geometry.width_px, geometry.height_px,
      geometry.metres_per_px)};
}

Result<BevLabels> SegmentationNetwork::segment(const BevImage& bev) {
  const Status taken = takes(bev.geometry);
  if (!taken) return taken.error();
  const ClassMap& map = impl_->map;
  const cv::Size size = impl_->sizeFor(bev.geometry);
  cv::Mat image = bev.image;
  if (size != image.size()) {
    cv::resize(image, impl_->resized, size, 0, 0,
               size.width < image.cols ? cv::INTER_AREA : cv::INTER_LINEAR);
    image = impl_->resized;
  }
  const cv::Size padded(map.any_size ? roundUp(size.width) : size.width,
                        map.any_size ? roundUp(size.height) : size.height);
  if (padded != size) {
    cv::copyMakeBorder(image, image, 0, padded.height - size.height, 0, padded.width - size.width,
                       cv::BORDER_CONSTANT, cv::Scalar::all(0));
  }
  BevLabels result;
  result.t_ns = bev.t_ns;
  result.geometry = bev.geometry;
  Result<DecodedLabels> decoded = impl_->run(image);
  if (!decoded) return decoded.error();
  result.labels = decoded->labels;
  result.confidence = decoded->confidence;
  result.slot_line = decoded->slot_line;
  result.paint = decoded->paint;
  const std::array<cv::Mat*, 4> pictures{&result.labels, &result.confidence, &result.slot_line,
                                         &result.paint};
  if (size != bev.image.size() || padded != size) {
    // Exact: by the middles of pixels, as the picture was scaled; the other rounds down, half a
    // pixel off.
    const cv::Rect used(cv::Point(), size);
    for (cv::Mat* picture : pictures) {
      if (picture->empty()) continue;
      cv::resize((*picture)(used).clone(), *picture, bev.image.size(), 0, 0,
                 cv::INTER_NEAREST_EXACT);
    }
  }
  tellStrokesFromArrows(result.slot_line, bev.geometry.metres_per_px, result.labels);
  uniteStrokes(result.labels, bev.geometry.metres_per_px);
  tellSlotsFromLanes(result.slot_line, bev.geometry.metres_per_px, result.labels);
  const cv::Mat unseen = bev.valid == 0;
  static_assert(static_cast<int>(SemanticClass::kUnknown) == 0);
  for (cv::Mat* picture : pictures) {
    if (!picture->empty()) picture->setTo(0, unseen);
  }
  return result;
}

Result<ViewLabels> SegmentationNetwork::segmentView(const cv::Mat& image) {
  cv::Mat input = image;
  const cv::Size size(impl_->map.width, impl_->map.height);
  if (image.size() != size) {
    const bool smaller = size.width < image.cols;
    cv::resize(image, impl_->resized, size, 0, 0, smaller ? cv::INTER_AREA : cv::INTER_LINEAR);
    input = impl_->resized;
  }
  Result<DecodedLabels> decoded = impl_->run(input);
  if (!decoded) return decoded.error();
  return ViewLabels{decoded->labels, decoded->confidence};
}

}  // namespace parkade
