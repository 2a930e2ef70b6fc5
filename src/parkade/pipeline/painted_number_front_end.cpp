// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/painted_number_front_end.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "parkade/core/log.hpp"
#include "parkade/semantics/class_map.hpp"
#include "parkade/semantics/zone_text_reader.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade {
namespace {

/// A number and the camera that the stitched picture has it from.
struct Seen {
  PaintedNumber number;
  std::size_t camera = 0;
  double height_px = 0.0;
};

double certainty(const std::vector<TextReading>& readings) {
  for (const TextReading& reading : readings) {
    if (!reading.text.empty()) return reading.probability;
  }
  return 0.0;
}

}  // namespace

struct PaintedNumberFrontEnd::Impl {
  PaintedNumberFrontEndOptions options;
  Rig rig;
  std::vector<cv::Mat> masks;
  ZoneTextReader reader;
  std::optional<Eigen::Vector3d> last_place = std::nullopt;
  /// Log-odds that numbers are upright for who enters a slot; that is usual.
  double upright = 2.0;

  [[nodiscard]] std::vector<Seen> bestSeen(const FrameSet& frames, const BevViews& views,
                                           const SemanticFrame& frame,
                                           const SE3& T_level_vehicle) const {
    std::vector<Seen> all;
    for (const PaintedNumber& number : findPaintedNumbers(frame, options.numbers)) {
      // From elsewhere a car may hide what the stitched picture shows.
      const std::size_t c = views.indexAt(frame.labels.geometry, number.center);
      if (c >= std::min(rig.cameras.size(), frames.images.size()) || frames.images[c].empty()) {
        continue;
      }
      const RigCamera& eye = rig.cameras[c];
      const double height =
          seenHeight(number, eye.camera, masks[c], T_level_vehicle * eye.T_vehicle_cam);
      if (height >= options.numbers.min_height_px) all.push_back({number, c, height});
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Seen& a, const Seen& b) { return a.height_px > b.height_px; });
    all.resize(std::min(all.size(), static_cast<std::size_t>(options.max_reads)));
    return all;
  }

  // Reads it both ways round until it is known which is right.
  Result<std::vector<TextReading>> read(const cv::Mat& patch) {
    constexpr double kKnown = 6.0;
    constexpr double kMost = 9.0;
    constexpr double kStep = 1.5;    // one number may look like another one upside down
    constexpr double kLeast = 0.05;  // probability
    cv::Mat turned;
    cv::flip(patch, turned, -1);
    if (std::abs(upright) > kKnown)
      return reader.read(upright > 0.0 ? patch : turned, options.letters);
    auto entering = reader.read(patch, options.letters);
    if (!entering) return entering;
    auto leaving = reader.read(turned, options.letters);
    if (!leaving) return leaving;
    const double step = std::log((certainty(*entering) + kLeast) / (certainty(*leaving) + kLeast));
    const bool enters = upright + step > 0.0;
    upright = std::clamp(upright + std::clamp(step, -kStep, kStep), -kMost, kMost);
    return enters ? entering : leaving;
  }
};

PaintedNumberFrontEnd::PaintedNumberFrontEnd(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PaintedNumberFrontEnd::~PaintedNumberFrontEnd() = default;

Result<std::unique_ptr<PaintedNumberFrontEnd>> PaintedNumberFrontEnd::create(
    const Rig& rig, std::vector<cv::Mat> masks, const PaintedNumberFrontEndOptions& options) {
  std::unique_ptr<PaintedNumberFrontEnd> none;
  if (!options.enabled) return none;
  const Result<std::string> path = namedOrOwnModel(options.reader, "zone_text");
  if (!path) {
    logInfo("no painted numbers: the network zone_text is not installed");
    return none;
  }
  Result<ZoneTextReader> reader = ZoneTextReader::load(*path);
  if (!reader) return reader.error();
  masks.resize(rig.cameras.size());
  return std::unique_ptr<PaintedNumberFrontEnd>(new PaintedNumberFrontEnd(
      std::make_unique<Impl>(Impl{options, rig, std::move(masks), std::move(reader).value()})));
}

Status PaintedNumberFrontEnd::read(const FrameSet& frames, const BevViews& views,
                                   const PoseEstimate& odometry, SemanticFrame& frame) {
  Impl& m = *impl_;
  const Eigen::Vector3d place = odometry.T_odom_vehicle.translation();
  if (m.last_place && (place - *m.last_place).norm() < m.options.distance_m) return {};
  const SE3 T_level_vehicle = levelFrom(frame.attitude);
  for (const Seen& seen : m.bestSeen(frames, views, frame, T_level_vehicle)) {
    m.last_place = place;
    const RigCamera& eye = m.rig.cameras[seen.camera];
    const cv::Mat patch = straightenNumber(seen.number, frames.images[seen.camera], eye.camera,
                                           T_level_vehicle * eye.T_vehicle_cam);
    Result<std::vector<TextReading>> readings = m.read(patch);
    if (!readings) return readings.error();
    // Readings of one piece of worn paint repeat their errors: doubtful ones must not add up.
    constexpr double kLikely = 0.5;
    if (certainty(*readings) < kLikely) continue;
    frame.objects[seen.number.object].text = readings->front().text;
    SlotObservation& slot = frame.slots[seen.number.slot];
    slot.number = std::move(readings).value();
    slot.number_place = seen.number.center;
  }
  return {};
}

}  // namespace parkade
