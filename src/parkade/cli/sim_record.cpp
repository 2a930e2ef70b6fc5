// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/sim_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "parkade/cli/sim_truth.hpp"
#include "parkade/core/log.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/sequence_writer.hpp"
#include "parkade/sim/drive/frame_renderer.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kGroundPx = 480;
constexpr double kGroundMetresPerPx = 0.03;  // 14.4 m across

bool exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

class Recorder {
 public:
  Recorder(std::shared_ptr<const sim::Simulation> simulation, const RecordOptions& options)
      : simulation_(std::move(simulation)), options_(options) {
    label_encoding_.png = true;
    told_rig_ = simulation_->toldRig();
  }

  Status record() {
    const Result<Folder> folder = prepareFolder();
    if (!folder) return folder.error();
    if (*folder == Folder::kComplete) {
      fmt::print(stderr, "{}: the recording is complete already\n", options_.out);
      return {};
    }
    Status status = simulation_->spec().images ? startDrawing() : Status();
    if (status) status = openWriter(*folder == Folder::kBegun);
    if (status) status = writeTruth(*simulation_, options_.out);
    if (status) status = writeEvents();
    if (status) status = writer_->finish();
    if (status) report();
    return status;
  }

 private:
  enum class Folder { kNew, kBegun, kComplete };

  // An empty folder, a recording to replace, or one to go on with.
  Result<Folder> prepareFolder() {
    const std::string spec_path = joinPath(options_.out, "spec.yaml");
    const std::string spec = specText(simulation_->spec());
    const bool is_recording = exists(spec_path);
    std::error_code code;
    Folder folder = Folder::kNew;
    if (options_.resume && is_recording) {
      const Result<std::string> before = readFile(spec_path);
      if (!before) return before.error();
      if (*before != spec) {
        return Error{fmt::format(
            "{}: the recording was begun with other options; repeat those that {} holds, or start "
            "anew with --force",
            options_.out, spec_path)};
      }
      const SequenceState state = inspectSequence(options_.out);
      folder = state.finished ? Folder::kComplete : state.begun ? Folder::kBegun : Folder::kNew;
      if (folder == Folder::kComplete) {
        if (Status holds = holdsWhatIsAsked(); !holds) return holds.error();
      }
    } else if (options_.force && is_recording) {
      Status removed = removeRecording();
      if (!removed) return removed.error();
    } else if (exists(options_.out) && !fs::is_empty(options_.out, code)) {
      return Error{fmt::format(
          "{}: {}", options_.out,
          is_recording ? "holds a recording already; --force replaces it, --resume goes on"
                       : "the folder is not empty and holds no simulated recording; name another")};
    }
    Status made = makeFolders(options_.out);
    if (made) made = writeFileAtomic(spec_path, spec);
    if (!made) return made.error();
    return folder;
  }

  // A complete recording is not drawn again for what it lacks.
  [[nodiscard]] Status holdsWhatIsAsked() const {
    if (!simulation_->spec().images) return {};
    for (const auto& [asked, part] : {std::pair(options_.labels, "truth/labels"),
                                      std::pair(options_.bev_labels, "truth/bev_labels")}) {
      if (!asked || exists(joinPath(options_.out, part))) continue;
      return Error{fmt::format(
          "{}: the recording is complete, without {}; draw it anew with --force, or elsewhere",
          options_.out, part)};
    }
    return {};
  }

  // Only what a recording consists of: the folder may hold notes of its user.
  Status removeRecording() {
    for (const char* part : {"mav0", "truth", "masks", "rig.yaml", "spec.yaml", "UNFINISHED"}) {
      std::error_code code;
      fs::remove_all(joinPath(options_.out, part), code);
      if (code) {
        return Error{fmt::format("{}/{}: cannot remove: {}", options_.out, part, code.message())};
      }
    }
    return {};
  }

  // Named like the picture that it tells of: by the camera's own clock.
  [[nodiscard]] std::string labelPath(std::size_t camera, TimeNs t_ns) const {
    const RigCamera& told = told_rig_.cameras[camera];
    return joinPath(options_.out,
                    fmt::format("truth/labels/{}/{}.png", told.name, t_ns - told.time_offset_ns));
  }
  [[nodiscard]] std::string groundPath(TimeNs t_ns) const {
    return joinPath(options_.out, fmt::format("truth/bev_labels/{}.png", t_ns));
  }

  // Builds the scene; masks of the own body, agents, folders.
  Status startDrawing() {
    fmt::print(stderr, "{}: building the scene and baking its light\n", simulation_->spec().name());
    Result<std::unique_ptr<sim::FrameRenderer>> renderer = sim::FrameRenderer::make(simulation_);
    if (!renderer) return renderer.error();
    renderer_ = std::move(renderer).value();
    const std::vector<RigCamera>& cameras = simulation_->trueRig().cameras;
    std::vector<std::string> folders{joinPath(options_.out, "masks"),
                                     joinPath(options_.out, "truth")};
    if (options_.bev_labels) folders.push_back(joinPath(options_.out, "truth/bev_labels"));
    for (const RigCamera& camera : cameras) {
      if (!options_.labels) continue;
      folders.push_back(joinPath(options_.out, fmt::format("truth/labels/{}", camera.name)));
    }
    for (const std::string& folder : folders) {
      Status made = makeFolders(folder);
      if (!made) return made;
    }
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const cv::Mat mask = renderer_->bodyMask(static_cast<int>(i));
      if (cv::countNonZero(mask) == static_cast<int>(mask.total())) continue;
      told_rig_.cameras[i].mask_path =
          joinPath(options_.out, fmt::format("masks/{}.png", cameras[i].name));
      Status status = writeImage(told_rig_.cameras[i].mask_path, mask, label_encoding_);
      if (!status) return status;
    }
    return writeAgents(*simulation_, renderer_->scene(), options_.out);
  }

  Status openWriter(bool resume) {
    SequenceWriterOptions options;
    options.image_format = options_.gray_png ? "gray-png" : "jpg";
    options.resume = resume;
    // Other builds draw the same spec otherwise: half a recording of theirs is none of this one's.
    constexpr const char* kDrawing = " drawing 2";
    options.fingerprint = specText(simulation_->spec()) + options.image_format + kDrawing;
    Result<std::unique_ptr<SequenceWriter>> writer =
        SequenceWriter::create(options_.out, told_rig_, options);
    if (!writer) return writer.error();
    writer_ = std::move(writer).value();
    return {};
  }

  // Pictures are drawn ahead while the ones before are written; those in the folder are not drawn.
  Status writeEvents() {
    const std::vector<TimeNs>& times = simulation_->frameTimes();
    sim::FrameFunction draw;
    if (renderer_) {
      draw = [this, &times](int index) -> Result<FrameSet> {
        std::vector<bool> wanted(told_rig_.cameras.size());
        for (std::size_t i = 0; i < wanted.size(); ++i) {
          wanted[i] = !writer_->hasImage(i, times[static_cast<std::size_t>(index)]);
        }
        return renderer_->draw(index, wanted);
      };
    }
    sim::SimSource source(simulation_, told_rig_, std::move(draw), sim::kFrameSetsAhead,
                          simulation_->spec().threads);
    ProgressPrinter progress(simulation_->spec().name());
    while (true) {
      const Result<std::optional<SensorEvent>> event = source.next();
      if (!event) return event.error();
      if (!event->has_value()) break;
      Status status = writer_->write(**event);
      const auto* set = std::get_if<FrameSet>(&**event);
      if (status && set != nullptr) {
        status = writeLabels(*set);
        progress.update((set->index + 1.0) / static_cast<double>(times.size()));
      }
      if (!status) return status;
    }
    progress.finish();
    return {};
  }

  Status writeLabels(const FrameSet& set) {
    Status status;
    for (std::size_t i = 0; i < set.images.size() && options_.labels; ++i) {
      const std::string path = labelPath(i, set.t_ns);
      if (status && !exists(path)) {
        status =
            writeImage(path, renderer_->labels(set.index, static_cast<int>(i)), label_encoding_);
      }
    }
    const std::string ground_path = groundPath(set.t_ns);
    if (status && options_.bev_labels && !exists(ground_path)) {
      status = writeImage(ground_path,
                          renderer_->groundView(set.index, kGroundPx, kGroundMetresPerPx).labels,
                          label_encoding_);
    }
    return status;
  }

  void report() const {
    fmt::print(stderr, "{}: {:.1f} s and {:.0f} m of driving, {} frame sets of {} cameras\n",
               options_.out, simulation_->duration(), simulation_->drivenDistance(),
               renderer_ ? simulation_->frameTimes().size() : 0, told_rig_.cameras.size());
  }

  std::shared_ptr<const sim::Simulation> simulation_;
  RecordOptions options_;
  ImageEncoding label_encoding_;
  Rig told_rig_;
  std::unique_ptr<sim::FrameRenderer> renderer_;
  std::unique_ptr<SequenceWriter> writer_;
};

}  // namespace

Status recordSequence(std::shared_ptr<const sim::Simulation> simulation,
                      const RecordOptions& options) {
  return Recorder(std::move(simulation), options).record();
}

int defaultThreads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace parkade::cli
