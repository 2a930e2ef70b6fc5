// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/options.hpp"
#include "parkade/io/background_tasks.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

struct SequenceWriterOptions {
  std::string image_format = "jpg";
  int jpeg_quality = 92;
  int png_level = 3;
  int encode_threads = 1;
  int encode_queue = 16;
  bool resume = false;
  /// What decides the content (options, seed, ...): an interrupted folder is only resumed where it
  /// was begun with the same text. One line or many.
  std::string fingerprint;

  void visit(OptionVisitor& v) {
    v.field("image_format", image_format, "How images are stored; gray-png drops the colour.",
            {"jpg", "png", "gray-png"});
    v.field("jpeg_quality", jpeg_quality, "1 to 100", "Quality of JPEG images.", 1, 100);
    v.field("png_level", png_level, "0 to 9", "Effort of PNG compression.", 0, 9);
    v.field("encode_threads", encode_threads, "count",
            "Threads that encode and write images; 0: none, encode when given.", 0, 64);
    v.field("encode_queue", encode_queue, "count", "Images that wait to be encoded at most.", 1,
            1000);
    v.field("resume", resume, "Go on with a folder whose writing was interrupted.");
  }
};

/// What is known of the body at an instant; written for evaluation only.
struct GroundTruthState {
  TimeNs t_ns = 0;
  SE3 T_world_body;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< of the body in the world frame, m/s
  Eigen::Vector3d bias_gyro = Eigen::Vector3d::Zero();   ///< imu frame, rad/s
  Eigen::Vector3d bias_accel = Eigen::Vector3d::Zero();  ///< imu frame, m/s^2
};

/// Writes SEQ/mav0/state_groundtruth_estimate0 (data.csv, sensor.yaml), whole or not at all.
Status writeGroundTruth(const std::string& sequence, const std::vector<GroundTruthState>& states);

/// How far the writing of a folder came.
struct SequenceState {
  bool begun = false;       ///< a sequence is there, whole or in part
  bool finished = false;    ///< finish() came to its end
  std::string fingerprint;  ///< of an unfinished one
};
SequenceState inspectSequence(const std::string& path);

/// Writes events as a sequence folder (docs/formats.md, "Sequence folder"). Every file is whole or
/// absent: images are written under another name and renamed, each data.csv grows as data.csv.part
/// and gets its name in finish(). Until then the file UNFINISHED marks the folder. The bytes do not
/// depend on the number of threads.
class SequenceWriter {
 public:
  /// Makes the folder and its rig.yaml; masks that lie elsewhere are copied into it. Fails where
  /// the folder holds a sequence already, unless it is unfinished, `resume` is set and the
  /// fingerprint is the same.
  static Result<std::unique_ptr<SequenceWriter>> create(const std::string& path, const Rig& rig,
                                                        const SequenceWriterOptions& options = {});
  ~SequenceWriter();  ///< without finish() the folder stays unfinished
  SequenceWriter(const SequenceWriter&) = delete;
  SequenceWriter& operator=(const SequenceWriter&) = delete;

  /// Appends an event; stamps of each sensor (of each camera) must increase strictly. Image stamps
  /// are on the IMU's clock; the rig's time offset is taken off again for the file. The images are
  /// copied, the caller may reuse them. Fails where the disk does, perhaps some calls later.
  Status write(const SensorEvent& event);
  Status write(const ImuSample& sample);
  Status write(const WheelSample& sample);
  /// With `resume`, an image that is empty here but lies in the folder under its stamp (t_ns where
  /// image_t_ns is 0) counts as written: the caller need not make it again.
  Status write(const FrameSet& frame_set);

  /// Whether the image of a camera is in the folder, whole; t_ns as in FrameSet::image_t_ns.
  [[nodiscard]] bool hasImage(std::size_t camera, TimeNs t_ns) const;

  /// Waits for the images, gives every data.csv its name, writes the sensor.yaml files and removes
  /// the mark. To be called once.
  Status finish();

 private:
  class RowFile;
  struct CameraState {
    std::unique_ptr<RowFile> rows;
    std::string data_folder;
    TimeNs last_t_ns = 0;
    std::size_t count = 0;
    TimeNs first_t_ns = 0;
  };
  SequenceWriter(std::string path, Rig rig, SequenceWriterOptions options);
  Status begin();
  Status copyMasks();
  Status openCamera(const std::string& name);
  [[nodiscard]] std::string imageName(std::size_t camera, TimeNs t_ns) const;
  Status writeImageRow(std::size_t camera, TimeNs t_ns, const cv::Mat& image);
  Status writeSensorFiles();

  std::string path_;
  Rig rig_;
  SequenceWriterOptions options_;
  ImageEncoding encoding_;
  std::vector<CameraState> cameras_;
  std::unique_ptr<RowFile> imu_;
  std::unique_ptr<RowFile> wheel_;  // from the first sample on
  std::optional<TimeNs> last_imu_;
  std::optional<TimeNs> last_wheel_;
  bool finished_ = false;
  std::unique_ptr<BackgroundTasks> tasks_;
};

}  // namespace parkade
