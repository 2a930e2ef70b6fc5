// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <optional>

#include "parkade/cli/sample_score.hpp"
#include "parkade/cli/zone_text_truth.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/semantics/texts/zone_marker_views.hpp"
#include "parkade/semantics/texts/zone_text_reader.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade::cli {
namespace {

constexpr double kTextReach = 10.0;                // m
constexpr double kAnyDistance = 1e4;               // m
constexpr double kMaxSlant = 60.0 * M_PI / 180.0;  // as for maps: a face is legible up to there
constexpr double kLeastInSight = 0.9;              // share of the text's area
constexpr double kSure = 0.5;                      // readings that count as told
constexpr std::array<double, 4> kTextBins = {4.0, 6.0, 8.0, kTextReach};

struct TextCount {
  int texts = 0;  ///< that can be read
  int right = 0;
  [[nodiscard]] double share() const { return texts > 0 ? 1.0 * right / texts : 0.0; }
};

struct Read {
  ZoneMarkerFace face;
  const TrueZoneText* truth = nullptr;
  TextReading reading;
};

class ZoneTextScore : public SampleScore {
 public:
  ZoneTextScore(ZoneTextScoreOptions options, std::optional<SegmentationNetwork> network,
                ZoneTextReader reader)
      : options_(std::move(options)), network_(std::move(network)), reader_(std::move(reader)) {}

  Status begin(const SemanticSampler& sampler) override {
    garage_ = sampler.simulation().spec().garage_seed;
    return {};
  }

  Status add(const SemanticSampler& sampler, const SemanticSample& sample) override {
    for (std::size_t i = 0; i < sample.frames.images.size(); ++i) {
      const Status status = addView(sampler, sample, static_cast<int>(i));
      if (!status) return status;
    }
    return {};
  }

  [[nodiscard]] std::string table() const override {
    std::string text = "Zone text, single views: read rightly of those that can be read\n";
    const auto out = std::back_inserter(text);
    double from = 0.0;
    for (std::size_t k = 0; k < kTextBins.size(); ++k) {
      fmt::format_to(out, "{:<20} {:>8.3f} of {}\n",
                     fmt::format("{:g} to {:g} m", from, kTextBins[k]), bins_[k].share(),
                     bins_[k].texts);
      from = kTextBins[k];
    }
    fmt::format_to(out, "{:<20} {:>8.3f} of {}   (target 0.95)\n", "to 10 m", all().share(),
                   all().texts);
    fmt::format_to(out, "{:<20} {:>8.3f} of {}\n", "told readings right", told_.share(),
                   told_.texts);
    return text;
  }

  void writeTo(nlohmann::json& metrics) const override {
    nlohmann::json& out = metrics["zone_text"];
    for (std::size_t k = 0; k < kTextBins.size(); ++k) {
      out["to_m"][fmt::format("{:g}", kTextBins[k])] = {{"texts", bins_[k].texts},
                                                        {"right", bins_[k].right}};
    }
    out["texts"] = all().texts;
    out["right"] = all().right;
    out["share"] = all().share();
    out["told"] = {{"readings", told_.texts}, {"right", told_.right}};
  }

 private:
  [[nodiscard]] TextCount all() const {
    TextCount sum;
    for (const TextCount& bin : bins_) {
      sum.texts += bin.texts;
      sum.right += bin.right;
    }
    return sum;
  }

  Status addView(const SemanticSampler& sampler, const SemanticSample& sample, int camera) {
    const auto index = static_cast<std::size_t>(camera);
    const cv::Mat& image = sample.frames.images[index];
    const RigCamera& eye = sampler.simulation().toldRig().cameras[index];
    const cv::Mat true_labels = sampler.cameraLabels(sample, camera);
    cv::Mat labels = atNetworkSize(true_labels);
    if (network_) {
      Result<ViewLabels> found = network_->segmentView(image);
      if (!found) return found.error();
      labels = found->labels;
    }
    const SO3 R_level_vehicle = levelFrom(sample.attitude).rotation();
    const std::vector<ZoneMarkerSight> sights =
        findZoneMarkers(labels, image, sampler.bodyMask(camera), eye.camera,
                        R_level_vehicle * eye.T_vehicle_cam.rotation(), options_.faces);
    const std::vector<TrueZoneText> texts =
        trueZoneTexts(sampler, sample, camera, true_labels, kAnyDistance);
    std::vector<Read> reads;
    for (const ZoneMarkerSight& sight : sights) {
      Result<ReadMarker> marker = readMarker(sight, reader_, kZoneLetters);
      if (!marker) return marker.error();
      for (const ZoneMarkerFace& face : marker->faces) {
        reads.push_back({face, textWithin(texts, face.corners), marker->readings.front()});
      }
    }
    count(texts, reads);
    return options_.pictures.empty() ? Status() : writePatches(sample, camera, reads);
  }

  void count(const std::vector<TrueZoneText>& texts, const std::vector<Read>& reads) {
    for (const Read& read : reads) {
      if (read.reading.text.empty() || read.reading.probability < kSure) continue;
      const std::optional<bool> right = isRight(read.reading.text, read.truth, kTextReach);
      if (!right) continue;
      ++told_.texts;
      told_.right += *right ? 1 : 0;
    }
    for (const TrueZoneText& text : texts) {
      if (text.distance > kTextReach || text.slant > kMaxSlant || text.in_sight < kLeastInSight) {
        continue;
      }
      std::size_t bin = 0;
      while (text.distance > kTextBins[bin]) ++bin;
      ++bins_[bin].texts;
      // A pillar's faces bear the same text: a face that shows two of them is read once.
      bins_[bin].right += std::any_of(reads.begin(), reads.end(), [&](const Read& read) {
        return read.reading.text == text.text && holds(read.face, text.middle);
      });
    }
  }

  static bool holds(const ZoneMarkerFace& face, const Eigen::Vector2d& point) {
    TrueZoneText probe;
    probe.middle = point;
    probe.in_sight = 1.0;
    return textWithin({probe}, face.corners) != nullptr;
  }

  // Straightened faces one below the other, named by what was read and what is written there.
  Status writePatches(const SemanticSample& sample, int camera, const std::vector<Read>& reads) {
    int k = 0;
    for (const Read& read : reads) {
      const std::string truth = read.truth == nullptr ? "none" : read.truth->text;
      const std::string found = read.reading.text.empty() ? "none" : read.reading.text;
      const Status status = writeImage(
          joinPath(options_.pictures, fmt::format("{}_g{}_{:03d}_cam{}_{}_{}_is_{}.png",
                                                  found == truth ? "right" : "wrong", garage_,
                                                  sample.frames.index, camera, k++, found, truth)),
          read.face.patch, {.png = true});
      if (!status) return status;
    }
    return {};
  }

  ZoneTextScoreOptions options_;
  std::optional<SegmentationNetwork> network_;  // none: true labels
  ZoneTextReader reader_;
  std::array<TextCount, kTextBins.size()> bins_{};
  TextCount told_;
  int garage_ = 0;
};

}  // namespace

Result<std::unique_ptr<SampleScore>> makeZoneTextScore(const ZoneTextScoreOptions& options) {
  std::optional<SegmentationNetwork> network;
  if (!options.true_labels) {
    Result<SegmentationNetwork> loaded =
        SegmentationNetwork::loadOrOwn(options.view_network, kViewNetwork);
    if (!loaded) return loaded.error();
    network = std::move(loaded).value();
  }
  const Result<std::string> path = findModel("zone_text");
  if (!path) return path.error();
  Result<ZoneTextReader> reader = ZoneTextReader::load(*path);
  if (!reader) return reader.error();
  if (!options.pictures.empty()) {
    const Status status = makeFolders(options.pictures);
    if (!status) return status.error();
  }
  return std::unique_ptr<SampleScore>(
      new ZoneTextScore(options, std::move(network), std::move(reader).value()));
}

}  // namespace parkade::cli
