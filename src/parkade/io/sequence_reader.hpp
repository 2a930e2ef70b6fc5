// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/options.hpp"
#include "parkade/io/frame_join.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/ordered_prefetch.hpp"
#include "parkade/types/sensor_source.hpp"

namespace parkade {

struct SequenceReaderOptions {
  std::string rig;
  std::string cameras;
  bool gray = true;
  bool gray_beside = false;
  double join_tolerance_ms = -1.0;
  bool tolerate_stamps = false;
  bool require_imu = true;
  double start_s = 0.0;
  double duration_s = 0.0;
  int decode_threads = 1;
  int decode_ahead = 4;

  void visit(OptionVisitor& v) {
    v.field("rig", rig,
            "Rig file (docs/formats.md) in place of the sequence's own; empty: its own.");
    v.field("cameras", cameras, "Cameras to read, as cam0,cam1; empty: all of the rig.");
    v.field("gray", gray, "Decode images as gray (true) or as BGR colour (false).");
    v.field("gray_beside", gray_beside, "Decode colour images as gray as well.");
    v.field("join_tolerance_ms", join_tolerance_ms, "ms",
            "Images of different cameras this close are one instant; at most half a period. -1: 5, "
            "or half a period where less.",
            -1.0, 1000.0);
    v.field("tolerate_stamps", tolerate_stamps,
            "Repair stamps that go backwards or repeat (docs/formats.md) instead of refusing.");
    v.field("require_imu", require_imu, "Refuse a sequence without imu0.");
    v.field("start_s", start_s, "s", "Skip this much from the first stamp on.", 0.0);
    v.field("duration_s", duration_s, "s", "Read this much; 0: to the end.", 0.0);
    v.field("decode_threads", decode_threads, "count",
            "Threads that decode images ahead; 0: decode when asked.", 0, 64);
    v.field("decode_ahead", decode_ahead, "count", "Frame sets decoded ahead at most.", 1, 1000);
  }
};

/// What became of one camera's images.
struct CameraReadCount {
  std::string name;
  int listed = 0;     ///< rows of data.csv within the cut, after repair
  int delivered = 0;  ///< so far
  int skipped = 0;    ///< missing, cut off or corrupt, so far
};

/// Reads a sequence folder (docs/formats.md, "Sequence folder") as a stream of events. Stamps leave
/// it on the IMU's clock: a camera's time offset is added to the recorded stamp. An image that is
/// missing, cut off or corrupt is skipped and counted (a warning for the first of each camera, the
/// counts at the end); an instant left with no image at all is left out. An image whose size is not
/// the calibration's ends the stream with an Error.
class SequenceReader : public SensorSource {
 public:
  /// path: the folder that holds mav0. Fails on a missing folder, file or column, NaN, stamps that
  /// do not increase (unless tolerated), a bad calibration, an option out of its range.
  static Result<std::unique_ptr<SequenceReader>> open(const std::string& path,
                                                      const SequenceReaderOptions& options = {});

  [[nodiscard]] const SensorSourceInfo& info() const override { return info_; }
  Result<std::optional<SensorEvent>> next() override;

  /// The cameras read, in the order of FrameSet::images. Time offsets are zero here, because the
  /// stamps have them already.
  [[nodiscard]] const Rig& rig() const { return rig_; }
  /// What was added to each camera's recorded stamps, as its calibration says.
  [[nodiscard]] const std::vector<TimeNs>& timeOffsets() const { return time_offsets_ns_; }
  [[nodiscard]] const std::vector<CameraReadCount>& counts() const { return counts_; }

 private:
  struct ImageJob {
    std::size_t camera = 0;
    std::string path;
  };
  SequenceReader() = default;
  Status load(const std::string& path, const SequenceReaderOptions& options);
  Status loadImages(const std::string& sequence, const SequenceReaderOptions& options);
  Status cut(const SequenceReaderOptions& options);
  void startDecoding(const SequenceReaderOptions& options);
  Result<bool> takeFrame(FrameSet& frame_set);
  void reportSkipped();

  SensorSourceInfo info_;
  Rig rig_;
  std::vector<TimeNs> time_offsets_ns_;
  std::vector<CameraReadCount> counts_;
  std::vector<ImuSample> imu_;
  std::vector<WheelSample> wheel_;
  std::vector<JoinedFrame> frames_;
  std::vector<std::vector<TimeNs>> image_t_ns_;        // per camera, on the IMU's clock
  std::vector<std::vector<std::string>> image_paths_;  // per camera
  std::size_t next_imu_ = 0;
  std::size_t next_wheel_ = 0;
  std::size_t next_frame_ = 0;
  int next_index_ = 0;
  bool ended_ = false;
  std::vector<ImageJob> jobs_;  // in the order of frames, then cameras
  // Last: its threads use what is above.
  std::unique_ptr<OrderedPrefetch<Result<ImageAndGray>>> images_;
};

}  // namespace parkade
