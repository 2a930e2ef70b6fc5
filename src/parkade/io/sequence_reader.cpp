// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sequence_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "parkade/core/log.hpp"
#include "parkade/core/split.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/sequence_files.hpp"
#include "parkade/io/stamps.hpp"

namespace parkade {
namespace {

template <class Row>
Result<std::vector<Row>> orderedRows(SensorTable<Row> table, bool tolerate) {
  const Result<std::vector<std::size_t>> order =
      orderRows(table.path, table.stamps(), table.lines, tolerate);
  if (!order) return order.error();
  std::vector<Row> rows;
  rows.reserve(order->size());
  for (const std::size_t i : *order) rows.push_back(std::move(table.rows[i]));
  return rows;
}

template <class Row>
void keepBetween(std::vector<Row>& rows, TimeNs begin, TimeNs end) {
  std::erase_if(rows, [=](const Row& row) { return row.t_ns < begin || row.t_ns > end; });
}

Status checkRanges(const SequenceReaderOptions& options) {
  struct Range {
    const char* name;
    double value;
    double least;
  };
  const Range ranges[] = {{"join_tolerance_ms", options.join_tolerance_ms, -1.0},
                          {"start_s", options.start_s, 0.0},
                          {"duration_s", options.duration_s, 0.0},
                          {"decode_threads", static_cast<double>(options.decode_threads), 0.0},
                          {"decode_ahead", static_cast<double>(options.decode_ahead), 1.0}};
  for (const Range& range : ranges) {
    if (std::isfinite(range.value) && range.value >= range.least) continue;
    return Error{fmt::format("{} {:g} is out of its range; expected a number from {:g} on",
                             range.name, range.value, range.least)};
  }
  if (!options.cameras.empty() && hasEmptyPart(options.cameras, ',')) {
    return Error{
        fmt::format("cameras '{}': a name is empty; expected names as cam0,cam1", options.cameras)};
  }
  return {};
}

}  // namespace

Result<std::unique_ptr<SequenceReader>> SequenceReader::open(const std::string& path,
                                                             const SequenceReaderOptions& options) {
  std::unique_ptr<SequenceReader> reader(new SequenceReader);
  if (Status status = reader->load(path, options); !status) return status.error();
  return reader;
}

Status SequenceReader::load(const std::string& path, const SequenceReaderOptions& options) {
  if (Status status = checkRanges(options); !status) return status;
  const Result<std::string> sequence = findSequence(path);
  if (!sequence) return sequence.error();
  if (Status status = checkFinished(*sequence); !status) return status;

  Result<Rig> rig = options.rig.empty() ? readSequenceRig(*sequence) : readRig(options.rig);
  if (!rig) return rig.error();
  const std::vector<std::string> names = split(options.cameras, ',');
  if (!names.empty()) {
    rig = rig->subset(names);
    if (!rig) return Error{fmt::format("{}: {}", path, rig.error().message)};
  }
  rig_ = std::move(*rig);

  const std::string imu_path = joinPath(sensorFolder(*sequence, "imu0"), "data.csv");
  if (options.require_imu || std::filesystem::exists(imu_path)) {
    Result<SensorTable<ImuSample>> table = readImuTable(imu_path);
    if (!table) return table.error();
    auto rows = orderedRows(std::move(*table), options.tolerate_stamps);
    if (!rows) return rows.error();
    imu_ = std::move(*rows);
  }
  const std::string wheel_path = joinPath(sensorFolder(*sequence, "wheel0"), "data.csv");
  if (std::filesystem::exists(wheel_path)) {
    Result<SensorTable<WheelSample>> table = readWheelTable(wheel_path);
    if (!table) return table.error();
    auto rows = orderedRows(std::move(*table), options.tolerate_stamps);
    if (!rows) return rows.error();
    wheel_ = std::move(*rows);
  }
  if (Status status = loadImages(*sequence, options); !status) return status;
  info_.name = path;
  if (Status status = cut(options); !status) return status;
  startDecoding(options);
  return {};
}

Status SequenceReader::loadImages(const std::string& sequence,
                                  const SequenceReaderOptions& options) {
  for (RigCamera& camera : rig_.cameras) {
    const std::string folder = sensorFolder(sequence, camera.name);
    if (!std::filesystem::is_directory(folder)) {
      return Error{fmt::format(
          "{}: no such folder, but the calibration names camera '{}': choose the cameras to read "
          "(--cameras)",
          folder, camera.name)};
    }
    Result<SensorTable<ImageRow>> table = readImageTable(joinPath(folder, "data.csv"));
    if (!table) return table.error();
    auto rows = orderedRows(std::move(*table), options.tolerate_stamps);
    if (!rows) return rows.error();
    std::vector<TimeNs>& stamps = image_t_ns_.emplace_back();
    std::vector<std::string>& paths = image_paths_.emplace_back();
    const std::string data = joinPath(folder, "data");
    for (const ImageRow& row : *rows) {
      stamps.push_back(row.t_ns + camera.time_offset_ns);
      paths.push_back(joinPath(data, row.file));
    }
    time_offsets_ns_.push_back(camera.time_offset_ns);
    camera.time_offset_ns = 0;
    counts_.push_back({camera.name, 0, 0, 0});
  }
  const TimeNs tolerance = options.join_tolerance_ms >= 0.0
                               ? fromSeconds(options.join_tolerance_ms * 1e-3)
                               : usualJoinTolerance(image_t_ns_);
  Result<std::vector<JoinedFrame>> frames = joinFrames(image_t_ns_, tolerance);
  if (!frames) return Error{fmt::format("{}: {}", sequence, frames.error().message)};
  frames_ = std::move(*frames);
  return {};
}

Status SequenceReader::cut(const SequenceReaderOptions& options) {
  const auto span = [this](auto& rows, TimeNs& begin, TimeNs& end) {
    if (rows.empty()) return;
    begin = std::min(begin, rows.front().t_ns);
    end = std::max(end, rows.back().t_ns);
  };
  const auto span_of_all = [this, &span](TimeNs& begin, TimeNs& end) {
    begin = std::numeric_limits<TimeNs>::max();
    end = std::numeric_limits<TimeNs>::min();
    span(imu_, begin, end);
    span(wheel_, begin, end);
    span(frames_, begin, end);
    if (begin > end) begin = end = 0;
  };
  TimeNs begin = 0;
  TimeNs end = 0;
  span_of_all(begin, end);
  const TimeNs from = begin + fromSeconds(options.start_s);
  const TimeNs to = options.duration_s > 0.0 ? from + fromSeconds(options.duration_s) : end;
  const auto is_in = [=](const JoinedFrame& frame) {
    return frame.t_ns >= from && frame.t_ns <= to;
  };
  if (!frames_.empty() && std::none_of(frames_.begin(), frames_.end(), is_in)) {
    return Error{fmt::format(
        "{}: no pictures from {:g} s after its start{}; the recording lasts {:.1f} s and has "
        "pictures from {:.2f} s to {:.2f} s (see --start and --duration)",
        info_.name, options.start_s,
        options.duration_s > 0.0 ? fmt::format(", for {:g} s", options.duration_s) : "",
        toSeconds(end - begin), toSeconds(frames_.front().t_ns - begin),
        toSeconds(frames_.back().t_ns - begin))};
  }
  keepBetween(imu_, from, to);
  keepBetween(wheel_, from, to);
  keepBetween(frames_, from, to);
  span_of_all(info_.start_ns, info_.end_ns);
  info_.num_cameras = static_cast<int>(rig_.cameras.size());
  info_.num_frame_sets = static_cast<int>(frames_.size());
  info_.has_wheel = !wheel_.empty();
  return {};
}

void SequenceReader::startDecoding(const SequenceReaderOptions& options) {
  for (const JoinedFrame& frame : frames_) {
    for (std::size_t camera = 0; camera < frame.images.size(); ++camera) {
      const int image = frame.images[camera];
      if (image < 0) continue;
      jobs_.push_back({camera, image_paths_[camera][static_cast<std::size_t>(image)]});
      ++counts_[camera].listed;
    }
  }
  image_paths_.clear();
  const std::size_t ahead =
      static_cast<std::size_t>(options.decode_ahead) * std::max<std::size_t>(1, counts_.size());
  const auto read = [this, gray = options.gray,
                     beside = options.gray_beside](std::size_t i) -> Result<ImageAndGray> {
    if (!gray && beside) return readImageAndGray(jobs_[i].path);
    Result<cv::Mat> image = readImage(jobs_[i].path, gray);
    if (!image) return image.error();
    return ImageAndGray{std::move(*image), {}};
  };
  images_ = std::make_unique<OrderedPrefetch<Result<ImageAndGray>>>(jobs_.size(), read,
                                                                    options.decode_threads, ahead);
}

// Fills a frame set with the next instant; false where none of its images could be read.
Result<bool> SequenceReader::takeFrame(FrameSet& frame_set) {
  const JoinedFrame& frame = frames_[next_frame_++];
  frame_set.t_ns = frame.t_ns;
  frame_set.images.resize(frame.images.size());
  frame_set.image_t_ns.assign(frame.images.size(), 0);
  bool any = false;
  for (std::size_t camera = 0; camera < frame.images.size(); ++camera) {
    if (frame.images[camera] < 0) continue;
    const std::size_t job = images_->taken();
    Result<ImageAndGray> pictures = images_->take();
    CameraReadCount& count = counts_[camera];
    if (!pictures) {
      if (count.skipped++ == 0) {
        logWarning("{}; skipped, and so are others of {} like it", pictures.error().message,
                   count.name);
      }
      continue;
    }
    cv::Mat& image = pictures->image;
    const Camera& calibration = rig_.cameras[camera].camera;
    if (image.cols != calibration.width() || image.rows != calibration.height()) {
      return Error{fmt::format(
          "{}: the image is {} x {}, the calibration of {} is for {} x {}: use the calibration of "
          "this camera and resolution",
          jobs_[job].path, image.cols, image.rows, count.name, calibration.width(),
          calibration.height())};
    }
    const auto place = static_cast<std::size_t>(frame.images[camera]);
    frame_set.image_t_ns[camera] = image_t_ns_[camera][place];
    frame_set.images[camera] = std::move(image);
    if (!pictures->gray.empty()) {
      frame_set.gray.resize(frame.images.size());
      frame_set.gray[camera] = std::move(pictures->gray);
    }
    ++count.delivered;
    any = true;
  }
  if (any) frame_set.index = next_index_++;
  return any;
}

Result<std::optional<SensorEvent>> SequenceReader::next() {
  constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();
  while (!ended_) {
    const TimeNs imu = next_imu_ < imu_.size() ? imu_[next_imu_].t_ns : kNever;
    const TimeNs wheel = next_wheel_ < wheel_.size() ? wheel_[next_wheel_].t_ns : kNever;
    const TimeNs frame = next_frame_ < frames_.size() ? frames_[next_frame_].t_ns : kNever;
    const TimeNs first = std::min({imu, wheel, frame});
    if (first == kNever) break;
    if (imu == first) return std::optional<SensorEvent>(imu_[next_imu_++]);
    if (wheel == first) return std::optional<SensorEvent>(wheel_[next_wheel_++]);
    FrameSet frame_set;
    const Result<bool> taken = takeFrame(frame_set);
    if (!taken) {
      ended_ = true;
      return taken.error();
    }
    if (*taken) return std::optional<SensorEvent>(std::move(frame_set));
  }
  if (!ended_) reportSkipped();
  ended_ = true;
  return std::optional<SensorEvent>();
}

void SequenceReader::reportSkipped() {
  for (const CameraReadCount& count : counts_) {
    if (count.skipped == 0) continue;
    logWarning("{}: {} of {} images of {} were missing or corrupt and were skipped", info_.name,
               count.skipped, count.listed, count.name);
  }
}

}  // namespace parkade
