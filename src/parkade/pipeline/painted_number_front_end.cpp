// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/painted_number_front_end.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "parkade/core/log.hpp"
#include "parkade/core/split.hpp"
#include "parkade/semantics/networks/class_map.hpp"
#include "parkade/semantics/texts/zone_text_reader.hpp"
#include "parkade/types/level_frame.hpp"
#include "parkade/types/text_evidence.hpp"

namespace parkade {
namespace {

/// A number and the camera that the stitched picture has it from.
struct Seen {
  PaintedNumber number;
  std::size_t camera = 0;
  double height_px = 0.0;
  SE3 T_floor_cam;  ///< of that camera; z = 0 is the floor under the number
};

// Readings of one piece of worn paint repeat their errors: doubtful ones must not add up.
constexpr double kLikely = 0.5;

}  // namespace

struct PaintedNumberFrontEnd::Impl {
  PaintedNumberFrontEndOptions options;
  Rig rig;
  std::vector<cv::Mat> masks;
  ZoneTextReader reader;
  std::optional<Eigen::Vector3d> last_place = std::nullopt;
  /// Log-odds that numbers are upright for who enters a slot; that is usual.
  double upright = 2.0;
  bool looked = false;  ///< at a number, in this frame set

  [[nodiscard]] std::vector<Seen> bestSeen(const std::vector<PaintedNumber>& numbers,
                                           const FrameSet& frames, const BevViews& views,
                                           const SemanticFrame& frame,
                                           const SE3& T_level_vehicle) const {
    std::vector<Seen> all;
    for (const PaintedNumber& number : numbers) {
      // From elsewhere a car may hide what the stitched picture shows.
      const std::size_t c = views.indexAt(frame.labels.geometry, number.center);
      if (c >= std::min(rig.cameras.size(), frames.images.size()) || frames.images[c].empty()) {
        continue;
      }
      const RigCamera& eye = rig.cameras[c];
      const SE3 T_floor_level(SO3(), {0.0, 0.0, -frame.relief.at(number.center)});
      const SE3 T_floor_cam = T_floor_level * T_level_vehicle * eye.T_vehicle_cam;
      const double height = seenHeight(number, eye.camera, masks[c], T_floor_cam);
      if (height >= options.numbers.min_height_px) {
        all.push_back({number, c, height, T_floor_cam});
      }
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const Seen& a, const Seen& b) { return a.height_px > b.height_px; });
    return all;
  }

  [[nodiscard]] cv::Mat straighten(const Seen& seen, const FrameSet& frames) const {
    return straightenNumber(seen.number, frames.images[seen.camera],
                            rig.cameras[seen.camera].camera, seen.T_floor_cam);
  }

  // What a patch may say: of those texts whose figures fill the number's width, for they alone can
  // be right.
  Result<std::vector<TextReading>> readFilling(const PaintedNumber& number, const cv::Mat& patch,
                                               const std::string& only) {
    constexpr double kWidest = 1.2;  // of a figure's height
    Result<std::vector<TextReading>> readings = reader.read(patch, only);
    if (!readings) return readings;
    const auto fills = [&](const TextReading& reading) {
      return reading.text.empty() ||
             number.width <= kWidest * number.height * static_cast<double>(reading.text.size());
    };
    double possible = 1.0;
    for (const TextReading& reading : *readings) {
      if (!fills(reading)) possible -= reading.probability;
    }
    std::erase_if(*readings, [&](const TextReading& reading) { return !fills(reading); });
    constexpr double kLeastPossible = 0.1;
    for (TextReading& reading : *readings) {
      reading.probability /= std::max(kLeastPossible, possible);
    }
    return readings;
  }

  // Probability of the best text of these letters among all that the patch may say: upside down,
  // many a number looks more like letters.
  Result<double> certaintyAmongAll(const PaintedNumber& number, const cv::Mat& patch) {
    Result<std::vector<TextReading>> readings = readFilling(number, patch, {});
    if (!readings) return readings.error();
    std::erase_if(*readings, [&](const TextReading& reading) {
      return reading.text.find_first_not_of(options.letters) != std::string::npos;
    });
    return certaintyOf(*readings);
  }

  // Reads it both ways round until it is known which is right.
  Result<std::vector<TextReading>> read(const PaintedNumber& number, const cv::Mat& patch) {
    constexpr double kKnown = 6.0;
    constexpr double kMost = 9.0;
    constexpr double kStep = 1.5;    // one number may look like another one upside down
    constexpr double kLeast = 0.05;  // probability
    cv::Mat turned;
    cv::flip(patch, turned, -1);
    bool enters = upright > 0.0;
    if (std::abs(upright) <= kKnown) {
      const Result<double> entering = certaintyAmongAll(number, patch);
      if (!entering) return entering.error();
      const Result<double> leaving = certaintyAmongAll(number, turned);
      if (!leaving) return leaving.error();
      const double step = std::log((*entering + kLeast) / (*leaving + kLeast));
      enters = upright + step > 0.0;
      upright = std::clamp(upright + std::clamp(step, -kStep, kStep), -kMost, kMost);
    }
    return readFilling(number, enters ? patch : turned, options.letters);
  }

  Status readSlots(const FrameSet& frames, const BevViews& views, const SE3& T_level_vehicle,
                   SemanticFrame& frame);
  /// A painted speed limit by all its readings.
  struct Limit {
    Eigen::Vector3d p_odom;
    std::optional<Eigen::Vector3d> read_from = std::nullopt;   ///< the car's place
    std::optional<Eigen::Vector3d> tried_from = std::nullopt;  ///< the same, whatever it told
    int readings = 0;
    int tries = 0;
    TextEvidence text = {};
  };
  std::vector<Limit> limits = {};
  std::vector<std::string> limit_values = {};
  Limit& limitAt(const Eigen::Vector3d& p_odom);
  Result<std::optional<std::vector<TextReading>>> readTurned(std::size_t object,
                                                             const FrameSet& frames,
                                                             const BevViews& views,
                                                             const SE3& T_level_vehicle,
                                                             const SemanticFrame& frame);
  Status readLimits(const FrameSet& frames, const BevViews& views, const PoseEstimate& odometry,
                    const SE3& T_level_vehicle, SemanticFrame& frame);
};

PaintedNumberFrontEnd::PaintedNumberFrontEnd(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PaintedNumberFrontEnd::~PaintedNumberFrontEnd() = default;

void PaintedNumberFrontEnd::moveCamera(int camera, const SE3& T_vehicle_cam) {
  impl_->rig.cameras[static_cast<std::size_t>(camera)].T_vehicle_cam = T_vehicle_cam;
}

Result<std::unique_ptr<PaintedNumberFrontEnd>> PaintedNumberFrontEnd::create(
    const Rig& rig, std::vector<cv::Mat> masks, const PaintedNumberFrontEndOptions& options) {
  std::unique_ptr<PaintedNumberFrontEnd> none;
  if (!options.enabled) return none;
  const Result<std::string> path = namedOrOwnModel(options.reader, "slot_number");
  if (!path) {
    logInfo("no painted numbers: the network slot_number is not installed");
    return none;
  }
  Result<ZoneTextReader> reader = ZoneTextReader::load(*path);
  if (!reader) return reader.error();
  const Status known = reader->knows(options.letters, "semantics.painted_numbers.letters");
  if (!known) return known.error();
  std::vector<std::string> limits = split(options.limits, ' ');
  for (const std::string& limit : limits) {
    if (limit.find_first_not_of("0123456789") == std::string::npos) continue;
    return Error{fmt::format(
        "semantics.painted_numbers.limits: '{}' is no speed limit; expected numbers with spaces "
        "between, as '5 10 30'",
        limit)};
  }
  masks.resize(rig.cameras.size());
  auto impl =
      std::make_unique<Impl>(Impl{options, rig, std::move(masks), std::move(reader).value()});
  impl->limit_values = std::move(limits);
  return std::unique_ptr<PaintedNumberFrontEnd>(new PaintedNumberFrontEnd(std::move(impl)));
}

Status PaintedNumberFrontEnd::Impl::readSlots(const FrameSet& frames, const BevViews& views,
                                              const SE3& T_level_vehicle, SemanticFrame& frame) {
  std::vector<Seen> all =
      bestSeen(findPaintedNumbers(frame, options.numbers), frames, views, frame, T_level_vehicle);
  all.resize(std::min(all.size(), static_cast<std::size_t>(options.max_reads)));
  for (const Seen& seen : all) {
    Result<std::vector<TextReading>> readings = read(seen.number, straighten(seen, frames));
    if (!readings) return readings.error();
    if (certaintyOf(*readings) < kLikely) continue;
    frame.objects[seen.number.object].text = readings->front().text;
    SlotObservation& slot = frame.slots[*seen.number.slot];
    slot.number = std::move(readings).value();
    slot.number_place = seen.number.center;
  }
  looked = looked || !all.empty();
  return {};
}

PaintedNumberFrontEnd::Impl::Limit& PaintedNumberFrontEnd::Impl::limitAt(
    const Eigen::Vector3d& p_odom) {
  constexpr double kSame = 1.5;  // m
  const auto known = std::find_if(limits.begin(), limits.end(), [&](const Limit& limit) {
    return (limit.p_odom - p_odom).norm() < kSame;
  });
  if (known != limits.end()) return *known;
  limits.push_back({p_odom});
  return limits.back();
}

// A limit may face any way: read at many turns, that in which it is surest counts. Nothing where no
// camera sees it well enough.
Result<std::optional<std::vector<TextReading>>> PaintedNumberFrontEnd::Impl::readTurned(
    std::size_t object, const FrameSet& frames, const BevViews& views, const SE3& T_level_vehicle,
    const SemanticFrame& frame) {
  constexpr int kTurns = 12;
  std::optional<std::vector<TextReading>> surest;
  for (int k = 0; k < kTurns; ++k) {
    const double angle = 2.0 * M_PI * k / kTurns;
    const auto limit = findPaintedLimit(frame, object, {std::cos(angle), std::sin(angle)});
    if (!limit) break;
    const std::vector<Seen> seen = bestSeen({*limit}, frames, views, frame, T_level_vehicle);
    if (seen.empty()) break;
    auto readings = reader.read(straighten(seen.front(), frames), options.letters);
    if (!readings) return readings.error();
    keepTexts(limit_values, *readings);
    if (!surest || certaintyOf(*readings) > certaintyOf(*surest)) {
      surest = std::move(readings).value();
    }
  }
  return surest;
}

Status PaintedNumberFrontEnd::Impl::readLimits(const FrameSet& frames, const BevViews& views,
                                               const PoseEstimate& odometry,
                                               const SE3& T_level_vehicle, SemanticFrame& frame) {
  constexpr int kReadings = 12;   // of one limit are enough
  constexpr int kTries = 60;      // and so are those that tell nothing
  constexpr double kKnown = 0.9;  // probability
  const SE3 T_odom_level = odometry.T_odom_vehicle * T_level_vehicle.inverse();
  for (std::size_t i = 0; i < frame.objects.size(); ++i) {
    ObjectObservation& object = frame.objects[i];
    if (object.semantic_class != SemanticClass::kSpeedLimitPaint) continue;
    Limit& limit = limitAt(T_odom_level * object.position);
    const Eigen::Vector3d place = odometry.T_odom_vehicle.translation();
    const auto moved = [&](const std::optional<Eigen::Vector3d>& from, double distance) {
      return !from || (place - *from).norm() >= distance;
    };
    // A worn one, or what is none, must not cost twelve looks in every picture.
    if (limit.readings < kReadings && limit.tries < kTries &&
        moved(limit.read_from, 2.0 * options.distance_m) &&
        moved(limit.tried_from, options.distance_m)) {
      auto readings = readTurned(i, frames, views, T_level_vehicle, frame);
      if (!readings) return readings.error();
      if (*readings) {
        limit.tried_from = place;
        ++limit.tries;
        if (certaintyOf(**readings) >= kLikely) {
          limit.read_from = place;
          ++limit.readings;
          limit.text.add(**readings);
        }
      }
    }
    const TextReading best = limit.text.best();
    object.text = best.probability >= kKnown ? best.text : "";
  }
  return {};
}

Status PaintedNumberFrontEnd::read(const FrameSet& frames, const BevViews& views,
                                   const PoseEstimate& odometry, SemanticFrame& frame) {
  Impl& m = *impl_;
  const Eigen::Vector3d place = odometry.T_odom_vehicle.translation();
  const SE3 T_level_vehicle = levelFrom(frame.attitude);
  Status done = m.readLimits(frames, views, odometry, T_level_vehicle, frame);
  if (!done) return done;
  if (m.last_place && (place - *m.last_place).norm() < m.options.distance_m) return {};
  m.looked = false;
  done = m.readSlots(frames, views, T_level_vehicle, frame);
  if (m.looked) m.last_place = place;
  return done;
}

}  // namespace parkade
