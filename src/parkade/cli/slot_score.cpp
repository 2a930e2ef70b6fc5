// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "parkade/cli/sample_score.hpp"
#include "parkade/cli/slot_truth.hpp"
#include "parkade/eval/statistics.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/pipeline/stitched_views.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"
#include "parkade/semantics/drawing/draw_slots.hpp"
#include "parkade/semantics/lines/line_extraction.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"

namespace parkade::cli {
namespace {

using Eigen::Vector2d;

constexpr double kSlotReach = 8.0;  // m from the picture's middle
constexpr double kMatch = 0.5;      // m: entrance corners nearer than this are the same
constexpr std::array<double, 5> kSlotBins = {0.0, 3.0, 5.0, 6.5, 8.0};

class SlotScore : public SampleScore {
 public:
  SlotScore(SlotScoreOptions options, std::optional<SegmentationNetwork> network)
      : options_(std::move(options)), network_(std::move(network)) {}

  // Where all candidates are asked for.
  Status openTrials() {
    if (options_.trials.empty()) return {};
    trials_.open(options_.trials);
    trials_ << fmt::format("garage,right,doubt,{}\n", fmt::join(kSlotClueNames, ","));
    return checkTrials();
  }

  Status begin(const SemanticSampler& sampler) override {
    garage_ = sampler.simulation().spec().garage_seed;
    views_ = viewsOf(sampler.stitcher(), sampler.simulation().toldRig());
    return {};
  }

  Status add(const SemanticSampler& sampler, const SemanticSample& sample) override {
    BevLabels truth;
    truth.geometry = sample.bev.geometry;
    truth.labels = sample.bev_labels;
    truth.confidence = cv::Mat(truth.labels.size(), CV_8UC1, cv::Scalar(255));
    BevLabels labels = truth;
    if (network_) {
      Result<BevLabels> found = network_->segment(sample.bev);
      if (!found) return found.error();
      labels = std::move(found).value();
    }
    const Lines lines = extractLines(sample.bev, labels, options_.attitude_sigma);
    std::vector<SlotTrial> trials;
    const std::vector<SlotObservation> found =
        extractSlots(sample.bev, labels, lines.segments, views_,
                     {options_.attitude_sigma, options_.height_sigma}, {},
                     options_.trials.empty() ? nullptr : &trials);
    const std::vector<TrueSlot> slots = trueSlots(sampler, sample, truth, kSlotReach);
    if (Status status = writeTrials(trials, slots); !status) return status;
    compare(sample.bev.geometry, found, slots);
    if (options_.pictures.empty()) return {};
    return draw(sample, labels, lines, found, slots);
  }

  [[nodiscard]] std::string table() const override;
  void writeTo(nlohmann::json& metrics) const override;

 private:
  struct Bin {
    std::vector<double> errors;  // m, of entrance corners
    double chi2 = 0.0;           // sum over corners
  };
  struct Count {
    int visible = 0;
    int found = 0;
  };

  void compare(const BevGeometry& geometry, const std::vector<SlotObservation>& found,
               const std::vector<TrueSlot>& slots);
  Status writeTrials(const std::vector<SlotTrial>& trials, const std::vector<TrueSlot>& slots);
  Status checkTrials();

  void measure(const BevGeometry& geometry, const SlotObservation& found, const TrueSlot& truth);
  Status draw(const SemanticSample& sample, const BevLabels& labels, const Lines& lines,
              const std::vector<SlotObservation>& found, const std::vector<TrueSlot>& slots) const;
  [[nodiscard]] double recall() const {
    return visible_ > 0 ? static_cast<double>(found_visible_) / visible_ : 0.0;
  }
  [[nodiscard]] double precision() const {
    return told_ > 0 ? static_cast<double>(right_) / told_ : 0.0;
  }
  [[nodiscard]] double decidedRight() const {
    return decided_ > 0 ? static_cast<double>(decided_right_) / decided_ : 0.0;
  }
  [[nodiscard]] std::vector<double> nearErrors() const {
    std::vector<double> errors = bins_[0].errors;
    errors.insert(errors.end(), bins_[1].errors.begin(), bins_[1].errors.end());
    return errors;
  }

  SlotScoreOptions options_;
  std::optional<SegmentationNetwork> network_;
  BevViews views_;
  int garage_ = 0;
  int visible_ = 0;
  int found_visible_ = 0;
  int told_ = 0;
  int right_ = 0;
  int matched_ = 0;
  int decided_ = 0;
  int decided_right_ = 0;
  int free_told_taken_ = 0;
  int taken_told_free_ = 0;
  std::array<Bin, kSlotBins.size() - 1> bins_;
  std::array<Count, 3> shapes_;
  std::array<Count, 4> markings_;
  std::ofstream trials_;
};

void SlotScore::measure(const BevGeometry& geometry, const SlotObservation& found,
                        const TrueSlot& truth) {
  for (int k = 0; k < 2; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vector2d error = found.corners[i] - truth.slot.corners[i];
    const double distance = (truth.slot.corners[i] - geometry.center).norm();
    for (std::size_t b = 0; b + 1 < kSlotBins.size(); ++b) {
      if (distance < kSlotBins[b] || distance >= kSlotBins[b + 1]) continue;
      bins_[b].errors.push_back(error.norm());
      const Eigen::Matrix2d C = found.entrance_covariance.block<2, 2>(2 * k, 2 * k);
      bins_[b].chi2 += error.dot(C.llt().solve(error));
    }
  }
  ++matched_;
  constexpr double kSure = 0.1;
  if (std::abs(found.probability_free - 0.5) < kSure) return;
  ++decided_;
  if ((found.probability_free < 0.5) == truth.occupied) {
    ++decided_right_;
  } else {
    ++(truth.occupied ? taken_told_free_ : free_told_taken_);
  }
}

void SlotScore::compare(const BevGeometry& geometry, const std::vector<SlotObservation>& found,
                        const std::vector<TrueSlot>& slots) {
  std::vector<bool> taken(slots.size(), false);
  for (const SlotObservation& f : found) {
    const auto distance = [&](const Vector2d& p) { return (p - geometry.center).norm(); };
    // One a little beyond may be a true one that is not.
    const bool within = std::max(distance(f.corners[0]), distance(f.corners[1])) <= kSlotReach;
    std::size_t best = slots.size();
    double best_off = kMatch;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const auto& c = slots[i].slot.corners;
      const double off = std::max((f.corners[0] - c[0]).norm(), (f.corners[1] - c[1]).norm());
      if (taken[i] || off >= best_off) continue;
      best_off = off;
      best = i;
    }
    if (within) ++told_;
    if (best == slots.size()) continue;
    taken[best] = true;
    if (!within) continue;
    ++right_;
    measure(geometry, f, slots[best]);
  }
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (!slots[i].counts) continue;
    Count& shape = shapes_[static_cast<std::size_t>(slots[i].slot.shape)];
    Count& marking = markings_[static_cast<std::size_t>(slots[i].slot.marking)];
    ++visible_;
    ++shape.visible;
    ++marking.visible;
    if (!taken[i]) continue;
    ++found_visible_;
    ++shape.found;
    ++marking.found;
  }
}

Status SlotScore::writeTrials(const std::vector<SlotTrial>& trials,
                              const std::vector<TrueSlot>& slots) {
  if (options_.trials.empty()) return {};
  for (const SlotTrial& trial : trials) {
    const bool right = std::any_of(slots.begin(), slots.end(), [&trial](const TrueSlot& slot) {
      const auto& c = slot.slot.corners;
      return std::max((trial.left - c[0]).norm(), (trial.right - c[1]).norm()) < kMatch;
    });
    trials_ << fmt::format("{},{:d},{:.3f},{:.4f}\n", garage_, right, trial.doubt,
                           fmt::join(trial.clues, ","));
  }
  return checkTrials();
}

Status SlotScore::checkTrials() {
  if (!trials_.flush()) return Error{fmt::format("{}: cannot be written", options_.trials)};
  return {};
}

Status SlotScore::draw(const SemanticSample& sample, const BevLabels& labels, const Lines& lines,
                       const std::vector<SlotObservation>& found,
                       const std::vector<TrueSlot>& slots) const {
  std::vector<LineSegment> truth;
  for (const TrueSlot& one : slots) {
    if (!one.counts) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      LineSegment side;
      side.begin = one.slot.corners[i];
      side.end = one.slot.corners[(i + 1) % 4];
      truth.push_back(side);
    }
  }
  const BevGeometry& g = sample.bev.geometry;
  const cv::Mat plain = drawLabels(sample.bev.image, labels.labels, 0.0);
  const cv::Mat parts[2] = {
      drawSlots(plain, g, found, truth, 2.0),
      drawSlots(drawLabels(sample.bev.image, labels.labels, 0.6), g, {}, lines.segments, 2.0)};
  cv::Mat picture(parts[0].rows, 2 * parts[0].cols, CV_8UC3);
  for (int k = 0; k < 2; ++k) {
    parts[k].copyTo(picture.colRange(k * parts[0].cols, (k + 1) * parts[0].cols));
  }
  return writeImage(joinPath(options_.pictures,
                             fmt::format("g{}_{:03d}_slots.png", garage_, sample.frames.index)),
                    picture, {.png = true});
}

std::string SlotScore::table() const {
  std::string text = fmt::format("Slots to {:.0f} m, from {} labels\n", kSlotReach,
                                 network_ ? "the network's" : "true");
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "entrance in sight    {:>6}, found {:>6}: recall {:.4f}\n", visible_,
                 found_visible_, recall());
  fmt::format_to(out, "told                 {:>6}, right {:>6}: precision {:.4f}\n", told_, right_,
                 precision());
  fmt::format_to(out, "free or occupied     {:>6} told, right {:.4f}; not told {}\n", decided_,
                 decidedRight(), matched_ - decided_);
  fmt::format_to(out, "                     {} free told occupied, {} occupied told free\n",
                 free_told_taken_, taken_told_free_);
  constexpr std::array<const char*, 3> kShapes = {"perpendicular", "parallel", "slanted"};
  constexpr std::array<const char*, 4> kMarkings = {"closed", "T", "L", "open"};
  const auto counts = [&](const char* name, const Count& count) {
    if (count.visible == 0) return;
    fmt::format_to(out, "  {:<18} {:>6}, found {:>6}: recall {:.4f}\n", name, count.visible,
                   count.found, static_cast<double>(count.found) / count.visible);
  };
  for (std::size_t i = 0; i < 3; ++i) counts(kShapes[i], shapes_[i]);
  for (std::size_t i = 0; i < 4; ++i) counts(kMarkings[i], markings_[i]);
  fmt::format_to(out, "{:<20} {:>8} {:>10} {:>8} {:>12}\n", "entrance corners", "count", "median m",
                 "p95 m", "chi2 per 2");
  const auto row = [&](const std::string& name, const std::vector<double>& errors, double chi2) {
    if (errors.empty()) return;
    fmt::format_to(out, "{:<20} {:>8} {:>10.4f} {:>8.4f} {:>12.3f}\n", name, errors.size(),
                   quantile(errors, 0.5), quantile(errors, 0.95),
                   chi2 / (2.0 * static_cast<double>(errors.size())));
  };
  for (std::size_t b = 0; b + 1 < kSlotBins.size(); ++b) {
    row(fmt::format("  {:.1f} to {:.1f} m", kSlotBins[b], kSlotBins[b + 1]), bins_[b].errors,
        bins_[b].chi2);
  }
  row("  to 5 m", nearErrors(), bins_[0].chi2 + bins_[1].chi2);
  return text;
}

void SlotScore::writeTo(nlohmann::json& metrics) const {
  nlohmann::json& slots = metrics["slots"];
  slots["visible"] = visible_;
  slots["told"] = told_;
  slots["recall"] = recall();
  slots["precision"] = precision();
  slots["availability_right"] = decidedRight();
  slots["free_told_occupied"] = free_told_taken_;
  slots["occupied_told_free"] = taken_told_free_;
  slots["availability_told"] = matched_ > 0 ? static_cast<double>(decided_) / matched_ : 0.0;
  const std::vector<double> near = nearErrors();
  slots["corner_median_to_5m"] = quantile(near, 0.5);
  slots["corner_p95_to_5m"] = quantile(near, 0.95);
  for (std::size_t b = 0; b + 1 < kSlotBins.size(); ++b) {
    const std::vector<double>& errors = bins_[b].errors;
    if (errors.empty()) continue;
    slots["corners"].push_back(
        {{"from", kSlotBins[b]},
         {"to", kSlotBins[b + 1]},
         {"count", errors.size()},
         {"median", quantile(errors, 0.5)},
         {"p95", quantile(errors, 0.95)},
         {"chi2_per_dof", bins_[b].chi2 / (2.0 * static_cast<double>(errors.size()))}});
  }
}

}  // namespace

Result<std::unique_ptr<SampleScore>> makeSlotScore(const SlotScoreOptions& options) {
  std::optional<SegmentationNetwork> network;
  if (!options.true_labels) {
    Result<SegmentationNetwork> loaded =
        SegmentationNetwork::loadOrOwn(options.bev_network, kBevNetwork);
    if (!loaded) return loaded.error();
    network = std::move(loaded).value();
  }
  if (!options.pictures.empty()) {
    const Status status = makeFolders(options.pictures);
    if (!status) return status.error();
  }
  auto score = std::make_unique<SlotScore>(options, std::move(network));
  if (const Status status = score->openTrials(); !status) return status.error();
  return std::unique_ptr<SampleScore>(std::move(score));
}

}  // namespace parkade::cli
