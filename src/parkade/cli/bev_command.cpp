// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <vector>

#include "parkade/bev/stitcher.hpp"
#include "parkade/cli/command.hpp"
#include "parkade/cli/open_source.hpp"
#include "parkade/cli/option_checks.hpp"
#include "parkade/cli/output_folder.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/pipeline/stitched_views.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"
#include "parkade/semantics/drawing/draw_objects.hpp"
#include "parkade/semantics/drawing/draw_slots.hpp"
#include "parkade/semantics/lines/line_extraction.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"
#include "parkade/semantics/standing/object_extraction.hpp"
#include "parkade/tracking/overlap.hpp"

namespace parkade::cli {
namespace {

struct BevArguments {
  std::string source;
  std::string out;
  std::string rig;
  std::vector<std::string> images;  // NAME=FILE
  std::string cameras;
  double start_s = 0.0;
  double duration_s = 0.0;
  int every = 1;
  bool tolerate_stamps = false;
  bool overlay = false;
  bool force = false;
  std::string network;  // class map
  std::vector<std::string> settings;
  BevOptions options;
};

constexpr const char* kBevFooter =
    "SEQ is a sequence folder, or sim:GARAGE/ROUTE. The pictures are DIR/<t_ns>.png: ahead is up,\n"
    "black is what no camera sees, and the own car. Without SEQ, single pictures of a rig:\n"
    "--rig and one --image per camera.\n"
    "\n"
    "Examples:\n"
    "  parkade bev SEQ --out DIR --every 10\n"
    "  parkade bev SEQ --out SEEN --overlay\n"
    "  parkade bev SEQ --out LARGE --set width_px=800 --set height_px=800 --set "
    "metres_per_px=0.02\n"
    "  parkade bev --rig config/rigs/garage_fisheye_sim.yaml --image cam0=0.png \\\n"
    "      --image cam1=1.png --image cam2=2.png --image cam3=3.png --out ONE";

/// Writes pictures as they are, or with what the network sees laid over.
class BevWriter {
 public:
  /// Makes no folder: begin() does, when nothing else can go wrong before.
  static Result<BevWriter> make(const BevArguments& arguments) {
    BevWriter writer;
    writer.folder_ = arguments.out;
    if (!arguments.overlay) return writer;
    Result<SegmentationNetwork> network =
        SegmentationNetwork::loadOrOwn(arguments.network, kBevNetwork);
    if (!network) return network.error();
    writer.network_ = std::make_shared<SegmentationNetwork>(std::move(network).value());
    return writer;
  }

  /// The stitcher with its masks, whose pictures these are: objects and slots are drawn too.
  void setViews(const BevStitcher& stitcher, const Rig& rig) {
    views_ = viewsOf(stitcher, rig);
    objects_ = std::make_shared<ObjectExtractor>(stitcher.geometry(), views_);
  }

  [[nodiscard]] Status begin() const { return makeWritable(folder_); }

  Status write(const BevImage& bev) const {
    cv::Mat picture = bev.image;
    if (network_) {
      const Result<BevLabels> labels = network_->segment(bev);
      if (!labels) return labels.error();
      picture = drawLabels(bev.image, labels->labels, kShare);
      if (objects_) {
        const Lines lines = extractLines(bev, *labels, kAttitudeSigma);
        const std::vector<SlotObservation> slots =
            extractSlots(bev, *labels, lines.segments, views_, {kAttitudeSigma, kHeightSigma});
        const FoundObjects found = objects_->extract(*labels, slots, kAttitudeSigma);
        picture = drawObjects(picture, bev.geometry, found.objects, untracked(found.agents),
                              bev.geometry.width_px < kSmall ? 2.0 : 1.0);
        picture = drawSlots(picture, bev.geometry, slots, lines.segments);
      }
    }
    return writeImage((std::filesystem::path(folder_) / fmt::format("{}.png", bev.t_ns)).string(),
                      picture, {.png = true});
  }

 private:
  static constexpr double kShare = 0.35;  // of the classes' colours
  static constexpr double kAttitudeSigma =
      0.0087;                                   // rad: the body's attitude is not estimated here
  static constexpr double kHeightSigma = 0.02;  // m
  static constexpr int kSmall = 600;            // px: smaller pictures are enlarged for texts
  std::string folder_;
  std::shared_ptr<SegmentationNetwork> network_;
  BevViews views_;
  std::shared_ptr<ObjectExtractor> objects_;
};

// The frame set of single pictures given as NAME=FILE.
Result<FrameSet> readFrames(const Rig& rig, const std::vector<std::string>& images) {
  FrameSet frames;
  frames.images.resize(rig.cameras.size());
  frames.image_t_ns.resize(rig.cameras.size());
  for (const std::string& text : images) {
    const std::size_t equals = text.find('=');
    const int camera = equals == std::string::npos ? -1 : rig.find(text.substr(0, equals));
    if (camera < 0) {
      std::string known;
      for (const RigCamera& one : rig.cameras) known += (known.empty() ? "" : ", ") + one.name;
      return Error{fmt::format("--image {}: expected CAMERA=FILE with one of the rig's cameras: {}",
                               text, known)};
    }
    if (!frames.images[static_cast<std::size_t>(camera)].empty()) {
      return Error{fmt::format("--image {}: the camera has a picture already", text)};
    }
    Result<cv::Mat> image = readImage(text.substr(equals + 1), false);
    if (!image) return image.error();
    const Camera& model = rig.cameras[static_cast<std::size_t>(camera)].camera;
    if (image->cols != model.width() || image->rows != model.height()) {
      return Error{fmt::format("{}: the picture has {} x {} pixels, the rig's {} {} x {}",
                               text.substr(equals + 1), image->cols, image->rows,
                               text.substr(0, equals), model.width(), model.height())};
    }
    frames.images[static_cast<std::size_t>(camera)] = *image;
  }
  return frames;
}

Status stitchSingle(const BevArguments& arguments) {
  const Result<Rig> rig = readRig(arguments.rig);
  if (!rig) return rig.error();
  const Result<FrameSet> frames = readFrames(*rig, arguments.images);
  if (!frames) return frames.error();
  Result<BevWriter> writer = BevWriter::make(arguments);
  if (!writer) return writer.error();
  BevStitcher stitcher(*rig, arguments.options);
  writer->setViews(stitcher, *rig);
  if (Status begun = writer->begin(); !begun) return begun;
  return writer->write(stitcher.stitch(*frames));
}

Status stitchSequence(const BevArguments& arguments) {
  SourceRequest request;
  request.spec = arguments.source;
  request.cameras = arguments.cameras;
  request.start_s = arguments.start_s;
  request.duration_s = arguments.duration_s;
  request.tolerate_stamps = arguments.tolerate_stamps;
  request.gray = false;
  Result<OpenedSource> opened = openSource(request);
  if (!opened) return opened.error();
  SensorSource& source = *opened->source;
  Result<BevWriter> writer = BevWriter::make(arguments);
  if (!writer) return writer.error();
  BevStitcher stitcher(opened->rig, arguments.options);
  const Result<std::vector<cv::Mat>> masks = readBodyMasks(opened->rig);
  if (!masks) return masks.error();
  for (std::size_t i = 0; i < masks->size(); ++i) {
    if (!(*masks)[i].empty()) stitcher.setMask(static_cast<int>(i), (*masks)[i]);
  }
  writer->setViews(stitcher, opened->rig);
  if (Status begun = writer->begin(); !begun) return begun;
  ProgressPrinter progress("bev");
  int written = 0;
  while (true) {
    Result<std::optional<SensorEvent>> event = source.next();
    if (!event) return event.error();
    if (!*event) break;
    const auto* frames = std::get_if<FrameSet>(&**event);
    if (frames == nullptr) continue;
    const double span = toSeconds(source.info().end_ns - source.info().start_ns);
    progress.update(toSeconds(frames->t_ns - source.info().start_ns) / std::max(span, 1e-9));
    if (frames->index % arguments.every != 0) continue;
    const Status status = writer->write(stitcher.stitch(*frames));
    if (!status) return status;
    ++written;
  }
  progress.finish();
  if (written == 0) {
    return Error{fmt::format(
        "{}: no picture was written: no frame set could be read; 'parkade info' tells more",
        arguments.source)};
  }
  fmt::print("{} pictures in {}\n", written, arguments.out);
  return {};
}

int run(BevArguments& arguments) {
  for (const std::string& setting : arguments.settings) {
    const Status status = setOption(asOptions(arguments.options), setting);
    if (!status) return failUsage(status.error());
  }
  if (arguments.source.empty() == arguments.rig.empty()) {
    return failUsage({"give either a sequence, or --rig with one --image per camera"});
  }
  if (arguments.rig.empty() != arguments.images.empty()) {
    return failUsage({"--rig and --image go together: --rig RIG.yaml --image cam0=FILE ..."});
  }
  const Status usable = checkOutputFolder(arguments.out, arguments.force);
  if (!usable) return fail(usable.error());
  const Status status =
      arguments.source.empty() ? stitchSingle(arguments) : stitchSequence(arguments);
  return status ? 0 : fail(status.error());
}

}  // namespace

void addBevCommand(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("bev", "Stitch the cameras into bird's-eye pictures");
  auto arguments = std::make_shared<BevArguments>();
  command->add_option("SEQ", arguments->source, "Sequence folder, or sim:GARAGE/ROUTE");
  command->add_option("-o,--out", arguments->out, "Folder to write, made where it is not there")
      ->required();
  command->add_option("--every", arguments->every, "Stitch every N-th frame set only [1]")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--cameras", arguments->cameras, "Cameras to use, as cam0,cam1; default: all")
      ->check(checkCameraNames);
  command->add_option("--start", arguments->start_s, "Skip this much of the sequence, s")
      ->check(notNegative());
  command->add_option("--duration", arguments->duration_s, "Stop after this much, s; 0: at the end")
      ->check(notNegative());
  command->add_flag("--tolerate-stamps", arguments->tolerate_stamps,
                    "Repair stamps that go backwards or repeat instead of refusing the sequence");
  command->add_option("--rig", arguments->rig, "rig.yaml for single pictures");
  command->add_option("--image", arguments->images, "CAMERA=FILE, once per camera, with --rig")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  CLI::Option* overlay =
      command->add_flag("--overlay", arguments->overlay,
                        "Lay the classes and objects that the network sees over the pictures");
  command
      ->add_option("--network", arguments->network,
                   "Class map of another network for --overlay (docs/networks.md)")
      ->needs(overlay);
  command->add_flag(
      "--force", arguments->force,
      "Write into a folder that is not empty; pictures of the same names are replaced");
  command->add_option("--set", arguments->settings, "An option below, as metres_per_px=0.02")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->footer(std::string(kBevFooter) + "\n\nOptions for --set (name, default, meaning):\n" +
                  describeOptions(asOptions(arguments->options)));
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace parkade::cli
