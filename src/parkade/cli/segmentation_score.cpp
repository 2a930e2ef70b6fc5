// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "parkade/cli/sample_score.hpp"
#include "parkade/eval/label_confusion.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"
#include "parkade/semantics/networks/segmentation.hpp"

namespace parkade::cli {
namespace {

const std::vector<SemanticClass> kGround = {
    SemanticClass::kFloor,    SemanticClass::kSlotLine,        SemanticClass::kLaneLine,
    SemanticClass::kArrow,    SemanticClass::kSpeedLimitPaint, SemanticClass::kStopLine,
    SemanticClass::kCrossing, SemanticClass::kSpeedBump,       SemanticClass::kPaintedNumber,
    SemanticClass::kWheelStop};
const std::vector<SemanticClass> kUpright = {SemanticClass::kPillar, SemanticClass::kWall,
                                             SemanticClass::kVehicle, SemanticClass::kPedestrian};
const std::vector<SemanticClass> kViews = {
    SemanticClass::kVehicle,    SemanticClass::kPedestrian, SemanticClass::kPillar,
    SemanticClass::kZoneMarker, SemanticClass::kGuideSign,  SemanticClass::kSpeedLimitSign};
constexpr double kNearMiddle = 5.0;  // m from the car's middle

/// True labels in the classes that a network knows: a zone marker is part of its pillar to one that
/// does not tell it apart, everything else unknown.
class KnownClasses {
 public:
  explicit KnownClasses(const ClassMap& map) {
    const auto knows = [&](SemanticClass c) {
      return std::find(map.classes.begin(), map.classes.end(), c) != map.classes.end();
    };
    for (int value = 0; value < kNumSemanticClasses; ++value) {
      const auto semantic_class = static_cast<SemanticClass>(value);
      SemanticClass known = knows(semantic_class) ? semantic_class : SemanticClass::kUnknown;
      if (semantic_class == SemanticClass::kZoneMarker && !knows(semantic_class) &&
          knows(SemanticClass::kPillar)) {
        known = SemanticClass::kPillar;
      }
      table_[static_cast<std::size_t>(value)] = static_cast<std::uint8_t>(known);
    }
  }
  /// At another size the nearest pixels.
  [[nodiscard]] cv::Mat of(const cv::Mat& truth, const cv::Size& size) const {
    cv::Mat out(size, CV_8UC1);
    for (int v = 0; v < size.height; ++v) {
      const int y = static_cast<int>((v + 0.5) * truth.rows / size.height);
      for (int u = 0; u < size.width; ++u) {
        const int x = static_cast<int>((u + 0.5) * truth.cols / size.width);
        out.at<std::uint8_t>(v, u) = table_[truth.at<std::uint8_t>(y, x)];
      }
    }
    return out;
  }

 private:
  std::array<std::uint8_t, kNumSemanticClasses> table_{};
};

void writeIou(const LabelConfusion& confusion, const std::vector<SemanticClass>& classes,
              nlohmann::json& out) {
  for (const SemanticClass c : classes) {
    if (confusion.truePixels(c) == 0) continue;
    out[std::string(kSemanticClassNames[static_cast<std::size_t>(c)])] = confusion.iou(c);
  }
}

class SegmentationScore : public SampleScore {
 public:
  SegmentationScore(SegmentationScoreOptions options, SegmentationNetwork bev,
                    std::optional<SegmentationNetwork> raw)
      : options_(std::move(options)), bev_(std::move(bev)), raw_(std::move(raw)) {}

  Status begin(const SemanticSampler& sampler) override {
    garage_ = sampler.simulation().spec().garage_seed;
    return {};
  }

  Status add(const SemanticSampler& sampler, const SemanticSample& sample) override {
    const Result<BevLabels> found = bev_.segment(sample.bev);
    if (!found) return found.error();
    const cv::Mat truth =
        KnownClasses(bev_.classMap()).of(sample.bev_labels, sample.bev_labels.size());
    bev_all_.add(truth, found->labels, sample.bev.valid);
    bev_near_.add(truth, found->labels, near(sample.bev));
    ++samples_;
    Status status = addViews(sampler, sample);
    if (status && !options_.pictures.empty()) status = writePicture(sample, truth, found->labels);
    return status;
  }

  [[nodiscard]] std::string table() const override;
  void writeTo(nlohmann::json& metrics) const override;

 private:
  Status addViews(const SemanticSampler& sampler, const SemanticSample& sample) {
    if (!raw_) return {};
    const KnownClasses known(raw_->classMap());
    for (std::size_t i = 0; i < sample.frames.images.size(); ++i) {
      const Result<ViewLabels> found = raw_->segmentView(sample.frames.images[i]);
      if (!found) return found.error();
      const int camera = static_cast<int>(i);
      const cv::Size size = found->labels.size();
      // The own car is unknown in the labels; what a network says there does not count.
      views_.add(known.of(sampler.cameraLabels(sample, camera), size), found->labels,
                 nearest(sampler.bodyMask(camera), size));
    }
    return {};
  }

  static cv::Mat nearest(const cv::Mat& in, const cv::Size& size) {
    cv::Mat out(size, CV_8UC1);
    for (int v = 0; v < size.height; ++v) {
      for (int u = 0; u < size.width; ++u) {
        out.at<std::uint8_t>(v, u) =
            in.at<std::uint8_t>(static_cast<int>((v + 0.5) * in.rows / size.height),
                                static_cast<int>((u + 0.5) * in.cols / size.width));
      }
    }
    return out;
  }

  static cv::Mat near(const BevImage& bev) {
    cv::Mat mask = bev.valid.clone();
    for (int v = 0; v < mask.rows; ++v) {
      for (int u = 0; u < mask.cols; ++u) {
        const Eigen::Vector2d p = bev.geometry.toGround(Eigen::Vector2d(u, v));
        if ((p - bev.geometry.center).norm() > kNearMiddle) mask.at<std::uint8_t>(v, u) = 0;
      }
    }
    return mask;
  }

  Status writePicture(const SemanticSample& sample, const cv::Mat& truth, const cv::Mat& found) {
    const cv::Mat parts[3] = {sample.bev.image, drawLabels(sample.bev.image, found, 0.6),
                              drawLabels(sample.bev.image, truth, 0.6)};
    cv::Mat picture(parts[0].rows, 3 * parts[0].cols, CV_8UC3);
    for (int k = 0; k < 3; ++k) {
      cv::Mat place = picture.colRange(k * parts[0].cols, (k + 1) * parts[0].cols);
      (parts[k].channels() == 3 ? parts[k] : drawLabels(parts[k], truth, 0.0)).copyTo(place);
    }
    return writeImage(
        joinPath(options_.pictures, fmt::format("g{}_{:03d}.png", garage_, sample.frames.index)),
        picture, {.png = true});
  }

  SegmentationScoreOptions options_;
  SegmentationNetwork bev_;
  std::optional<SegmentationNetwork> raw_;
  LabelConfusion bev_all_;
  LabelConfusion bev_near_;
  LabelConfusion views_;
  int samples_ = 0;
  int garage_ = 0;
};

std::string SegmentationScore::table() const {
  std::string text = fmt::format(
      "Segmentation of the stitched picture, {} pictures: intersection over union\n"
      "{:<20} {:>8} {:>10} {:>14}\n",
      samples_, "class", "all", "to 5 m", "true pixels");
  const auto out = std::back_inserter(text);
  const auto row = [&](std::string_view name, double all, double near_by, std::int64_t pixels) {
    fmt::format_to(out, "{:<20} {:>8.3f} {:>10.3f} {:>14}\n", name, all, near_by, pixels);
  };
  const auto rows = [&](const std::vector<SemanticClass>& classes) {
    for (const SemanticClass c : classes) {
      if (bev_all_.truePixels(c) == 0) continue;
      row(kSemanticClassNames[static_cast<std::size_t>(c)], bev_all_.iou(c), bev_near_.iou(c),
          bev_all_.truePixels(c));
    }
  };
  rows(kGround);
  row("mean of the ground", bev_all_.meanIou(kGround), bev_near_.meanIou(kGround), 0);
  rows(kUpright);
  const std::vector<SemanticClass> fixed = {SemanticClass::kPillar, SemanticClass::kWall};
  row("pillar or wall", bev_all_.iou(fixed), bev_near_.iou(fixed), 0);
  if (!raw_) return text;
  fmt::format_to(out, "\nSegmentation of the cameras' views: intersection over union\n");
  for (const SemanticClass c : kViews) {
    if (views_.truePixels(c) == 0) continue;
    fmt::format_to(out, "{:<20} {:>8.3f} {:>25}\n",
                   kSemanticClassNames[static_cast<std::size_t>(c)], views_.iou(c),
                   views_.truePixels(c));
  }
  fmt::format_to(out, "{:<20} {:>8.3f}\n", "mean", views_.meanIou(kViews));
  return text;
}

void SegmentationScore::writeTo(nlohmann::json& metrics) const {
  nlohmann::json& bev = metrics["segmentation"]["bev"];
  bev["pictures"] = samples_;
  std::vector<SemanticClass> all = kGround;
  all.insert(all.end(), kUpright.begin(), kUpright.end());
  writeIou(bev_all_, all, bev["iou"]);
  writeIou(bev_near_, all, bev["iou_to_5m"]);
  bev["mean_iou_ground"] = bev_all_.meanIou(kGround);
  bev["mean_iou_ground_to_5m"] = bev_near_.meanIou(kGround);
  if (!raw_) return;
  nlohmann::json& views = metrics["segmentation"]["views"];
  writeIou(views_, kViews, views["iou"]);
  views["mean_iou"] = views_.meanIou(kViews);
}

}  // namespace

Result<std::unique_ptr<SampleScore>> makeSegmentationScore(
    const SegmentationScoreOptions& options) {
  Result<SegmentationNetwork> bev =
      SegmentationNetwork::loadOrOwn(options.bev_network, kBevNetwork);
  if (!bev) return bev.error();
  std::optional<SegmentationNetwork> raw;
  if (!options.raw_network.empty() || findModel(kViewNetwork)) {
    Result<SegmentationNetwork> loaded =
        SegmentationNetwork::loadOrOwn(options.raw_network, kViewNetwork);
    if (!loaded) return loaded.error();
    raw = std::move(loaded).value();
  }
  if (!options.pictures.empty()) {
    const Status status = makeFolders(options.pictures);
    if (!status) return status.error();
  }
  return std::unique_ptr<SampleScore>(
      new SegmentationScore(options, std::move(bev).value(), std::move(raw)));
}

}  // namespace parkade::cli
