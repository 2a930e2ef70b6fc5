// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sequence_writer.hpp"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "parkade/io/file.hpp"
#include "parkade/io/sensor_yaml.hpp"
#include "parkade/io/sequence_files.hpp"

namespace parkade {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMarkerText =
    "This sequence was not written to its end. Run the program that wrote it again: it resumes.\n";

bool exists(const std::string& path) {
  std::error_code code;
  return fs::exists(path, code);
}

bool isInside(const std::string& path, const std::string& folder) {
  std::error_code code;
  const fs::path relative =
      fs::weakly_canonical(path, code).lexically_relative(fs::weakly_canonical(folder, code));
  return !relative.empty() && *relative.begin() != "..";
}

// Files that a killed writer left half written.
void removeTemporaries(const std::string& folder) {
  std::error_code code;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, code)) {
    if (entry.path().extension() == ".tmp") fs::remove(entry.path(), code);
  }
}

constexpr const char* kImuHeader =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
constexpr const char* kWheelHeader =
    "#timestamp [ns],rear_left [m/s],rear_right [m/s],steering [rad]\n";
constexpr const char* kImageHeader = "#timestamp [ns],filename\n";
constexpr const char* kStateHeader =
    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],"
    "q_RS_z [],v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],b_w_RS_S_x [rad s^-1],"
    "b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],"
    "b_a_RS_S_z [m s^-2]\n";

std::string csvText(const Eigen::Vector3d& v) {
  return fmt::format("{},{},{}", v.x(), v.y(), v.z());
}

std::string orEmpty(double value) {
  return std::isnan(value) ? std::string() : fmt::format("{}", value);
}

}  // namespace

// A data.csv that grows by whole rows as data.csv.part and gets its name at the end.
class SequenceWriter::RowFile {
 public:
  static Result<std::unique_ptr<RowFile>> open(const std::string& folder, const char* header) {
    if (Status status = makeFolders(folder); !status) return status.error();
    std::unique_ptr<RowFile> file(new RowFile(joinPath(folder, "data.csv")));
    if (!file->stream_) return file->error();
    file->buffer_ = header;
    return file;
  }

  Status append(std::string_view row) {
    buffer_ += row;
    constexpr std::size_t kFlushBytes = 65536;
    return buffer_.size() < kFlushBytes ? Status() : flush();
  }

  Status finish() {
    if (Status status = flush(); !status) return status;
    stream_.close();
    std::error_code code;
    fs::rename(path_ + ".part", path_, code);
    if (!stream_ || code) return error();
    return {};
  }

 private:
  explicit RowFile(std::string path)
      : path_(std::move(path)), stream_(path_ + ".part", std::ios::binary | std::ios::trunc) {}
  [[nodiscard]] Error error() const {
    return {fmt::format("{}: cannot write the file; is the disk full?", path_)};
  }
  Status flush() {
    stream_ << buffer_ << std::flush;
    buffer_.clear();
    return stream_ ? Status() : Status(error());
  }

  std::string path_;
  std::ofstream stream_;
  std::string buffer_;
};

SequenceState inspectSequence(const std::string& path) {
  SequenceState state;
  const Result<std::string> marker = readFile(joinPath(path, kUnfinishedFile));
  if (marker) {
    state.begun = true;
    const std::size_t header = std::string_view(kMarkerText).size();
    if (marker->size() >= header) state.fingerprint = marker->substr(header);
    return state;
  }
  for (const char* sensor : {"imu0", "cam0"}) {
    const std::string file = joinPath(sensorFolder(path, sensor), "data.csv");
    state.finished = state.finished || exists(file);
    state.begun = state.begun || exists(file) || exists(file + ".part");
  }
  return state;
}

SequenceWriter::SequenceWriter(std::string path, Rig rig, SequenceWriterOptions options)
    : path_(std::move(path)), rig_(std::move(rig)), options_(std::move(options)) {
  encoding_.png = options_.image_format != "jpg";
  encoding_.jpeg_quality = options_.jpeg_quality;
  encoding_.png_level = options_.png_level;
}

SequenceWriter::~SequenceWriter() = default;

Result<std::unique_ptr<SequenceWriter>> SequenceWriter::create(
    const std::string& path, const Rig& rig, const SequenceWriterOptions& options) {
  const std::string& format = options.image_format;
  PARKADE_CHECK(format == "jpg" || format == "png" || format == "gray-png", "image format '{}'",
                format);
  const SequenceState state = inspectSequence(path);
  if (state.begun && !options.resume) {
    return Error{fmt::format(
        "{}: the folder holds {} sequence already: choose another folder, "
        "remove this one{}",
        path, state.finished ? "a" : "an unfinished", state.finished ? "" : ", or resume")};
  }
  if (state.finished) return Error{path + ": the sequence is finished, there is nothing to resume"};
  if (state.begun && state.fingerprint != options.fingerprint) {
    return Error{fmt::format(
        "{}: the unfinished sequence was begun with other options ('{}', now '{}'): repeat those, "
        "or remove the folder",
        path, state.fingerprint, options.fingerprint)};
  }
  std::unique_ptr<SequenceWriter> writer(new SequenceWriter(path, rig, options));
  if (Status status = writer->begin(); !status) return status.error();
  return writer;
}

Status SequenceWriter::begin() {
  if (Status status = makeFolders(path_); !status) return status;
  const std::string marker = joinPath(path_, kUnfinishedFile);
  if (Status status = writeFileAtomic(marker, kMarkerText + options_.fingerprint); !status) {
    return status;
  }
  if (Status status = copyMasks(); !status) return status;
  if (Status status = writeRig(rig_, joinPath(path_, "rig.yaml")); !status) return status;
  for (const RigCamera& camera : rig_.cameras) {
    if (Status status = openCamera(camera.name); !status) return status;
  }
  Result<std::unique_ptr<RowFile>> imu = RowFile::open(sensorFolder(path_, "imu0"), kImuHeader);
  if (!imu) return imu.error();
  imu_ = std::move(*imu);
  tasks_ = std::make_unique<BackgroundTasks>(options_.encode_threads,
                                             static_cast<std::size_t>(options_.encode_queue));
  return {};
}

Status SequenceWriter::openCamera(const std::string& name) {
  CameraState state;
  const std::string folder = sensorFolder(path_, name);
  state.data_folder = joinPath(folder, "data");
  if (Status status = makeFolders(state.data_folder); !status) return status;
  removeTemporaries(state.data_folder);
  Result<std::unique_ptr<RowFile>> rows = RowFile::open(folder, kImageHeader);
  if (!rows) return rows.error();
  state.rows = std::move(*rows);
  cameras_.push_back(std::move(state));
  return {};
}

Status SequenceWriter::copyMasks() {
  for (RigCamera& camera : rig_.cameras) {
    if (camera.mask_path.empty() || isInside(camera.mask_path, path_)) continue;
    const std::string folder = joinPath(path_, "masks");
    if (Status status = makeFolders(folder); !status) return status;
    const Result<std::string> bytes = readFile(camera.mask_path);
    if (!bytes) return bytes.error();
    const std::string extension = fs::path(camera.mask_path).extension().string();
    camera.mask_path = joinPath(folder, camera.name + extension);
    if (Status status = writeFileAtomic(camera.mask_path, *bytes); !status) return status;
  }
  return {};
}

Status SequenceWriter::write(const SensorEvent& event) {
  return std::visit([this](const auto& value) { return write(value); }, event);
}

Status SequenceWriter::write(const ImuSample& sample) {
  PARKADE_CHECK(!finished_ && (!last_imu_ || sample.t_ns > *last_imu_),
                "imu stamp {} after {}, finished: {}", sample.t_ns, last_imu_.value_or(0),
                finished_);
  last_imu_ = sample.t_ns;
  return imu_->append(
      fmt::format("{},{},{}\n", sample.t_ns, csvText(sample.gyro), csvText(sample.accel)));
}

Status SequenceWriter::write(const WheelSample& sample) {
  PARKADE_CHECK(!finished_ && (!last_wheel_ || sample.t_ns > *last_wheel_),
                "wheel stamp {} after {}, finished: {}", sample.t_ns, last_wheel_.value_or(0),
                finished_);
  last_wheel_ = sample.t_ns;
  if (!wheel_) {
    Result<std::unique_ptr<RowFile>> file =
        RowFile::open(sensorFolder(path_, "wheel0"), kWheelHeader);
    if (!file) return file.error();
    wheel_ = std::move(*file);
  }
  return wheel_->append(fmt::format("{},{},{},{}\n", sample.t_ns, orEmpty(sample.rear_left_mps),
                                    orEmpty(sample.rear_right_mps), orEmpty(sample.steering_rad)));
}

std::string SequenceWriter::imageName(std::size_t camera, TimeNs t_ns) const {
  return fmt::format("{}.{}", t_ns - rig_.cameras[camera].time_offset_ns, encoding_.extension());
}

bool SequenceWriter::hasImage(std::size_t camera, TimeNs t_ns) const {
  PARKADE_CHECK(camera < cameras_.size(), "camera {} of {}", camera, cameras_.size());
  return exists(joinPath(cameras_[camera].data_folder, imageName(camera, t_ns)));
}

Status SequenceWriter::write(const FrameSet& frame_set) {
  PARKADE_CHECK(!finished_ && frame_set.images.size() == cameras_.size(),
                "{} images for {} cameras, finished: {}", frame_set.images.size(), cameras_.size(),
                finished_);
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    const bool has_stamp =
        camera < frame_set.image_t_ns.size() && frame_set.image_t_ns[camera] != 0;
    const TimeNs t_ns = has_stamp ? frame_set.image_t_ns[camera] : frame_set.t_ns;
    const cv::Mat& image = frame_set.images[camera];
    if (image.empty() && !(options_.resume && hasImage(camera, t_ns))) continue;
    if (Status status = writeImageRow(camera, t_ns, image); !status) return status;
  }
  return {};
}

// An empty image: it is in the folder already.
Status SequenceWriter::writeImageRow(std::size_t camera, TimeNs t_ns, const cv::Mat& image) {
  CameraState& state = cameras_[camera];
  const Camera& calibration = rig_.cameras[camera].camera;
  PARKADE_CHECK(state.count == 0 || t_ns > state.last_t_ns, "{}: image stamp {} after {}",
                rig_.cameras[camera].name, t_ns, state.last_t_ns);
  PARKADE_CHECK(
      image.empty() || (image.cols == calibration.width() && image.rows == calibration.height()),
      "{}: the image is {} x {}, its calibration for {} x {}", rig_.cameras[camera].name,
      image.cols, image.rows, calibration.width(), calibration.height());
  if (state.count == 0) state.first_t_ns = t_ns;
  ++state.count;
  state.last_t_ns = t_ns;
  const std::string name = imageName(camera, t_ns);
  if (!image.empty()) {
    const bool to_gray = options_.image_format == "gray-png";
    Status status = tasks_->submit([this, path = joinPath(state.data_folder, name), to_gray,
                                    copy = image.clone()]() -> Status {
      return writeImage(path, to_gray ? grayOf(copy) : copy, encoding_);
    });
    if (!status) return status;
  }
  return state.rows->append(
      fmt::format("{},{}\n", t_ns - rig_.cameras[camera].time_offset_ns, name));
}

Status SequenceWriter::writeSensorFiles() {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    const CameraState& state = cameras_[i];
    const double span = toSeconds(state.last_t_ns - state.first_t_ns);
    const double rate = span > 0.0 ? static_cast<double>(state.count - 1) / span : 1.0;
    const std::string path = joinPath(sensorFolder(path_, rig_.cameras[i].name), "sensor.yaml");
    if (Status status = writeFileAtomic(path, cameraSensorYaml(rig_.cameras[i], rate)); !status) {
      return status;
    }
  }
  if (wheel_) {
    const std::string path = joinPath(sensorFolder(path_, "wheel0"), "sensor.yaml");
    if (Status status = writeFileAtomic(path, wheelSensorYaml()); !status) return status;
  }
  return writeFileAtomic(joinPath(sensorFolder(path_, "imu0"), "sensor.yaml"),
                         imuSensorYaml(rig_.imu));
}

Status SequenceWriter::finish() {
  PARKADE_CHECK(!finished_, "finish() was called before");
  finished_ = true;
  if (Status status = tasks_->wait(); !status) return status;
  for (const CameraState& state : cameras_) {
    if (Status status = state.rows->finish(); !status) return status;
  }
  if (wheel_) {
    if (Status status = wheel_->finish(); !status) return status;
  }
  if (Status status = imu_->finish(); !status) return status;
  if (Status status = writeSensorFiles(); !status) return status;
  std::error_code code;
  fs::remove(joinPath(path_, kUnfinishedFile), code);
  if (code) return Error{fmt::format("{}: cannot remove: {}", kUnfinishedFile, code.message())};
  return {};
}

Status writeGroundTruth(const std::string& sequence, const std::vector<GroundTruthState>& states) {
  const std::string folder = sensorFolder(sequence, "state_groundtruth_estimate0");
  if (Status status = makeFolders(folder); !status) return status;
  std::string text = kStateHeader;
  for (const GroundTruthState& state : states) {
    const Eigen::Quaterniond& q = state.T_world_body.rotation().quaternion();
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{}\n", state.t_ns,
                   csvText(state.T_world_body.translation()), q.w(), q.x(), q.y(), q.z(),
                   csvText(state.velocity), csvText(state.bias_gyro), csvText(state.bias_accel));
  }
  if (Status status = writeFileAtomic(joinPath(folder, "data.csv"), text); !status) return status;
  return writeFileAtomic(joinPath(folder, "sensor.yaml"), groundTruthSensorYaml());
}

}  // namespace parkade
