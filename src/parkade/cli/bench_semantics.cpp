// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <functional>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "parkade/cli/command.hpp"
#include "parkade/cli/marking_points.hpp"
#include "parkade/cli/sample_score.hpp"
#include "parkade/cli/semantic_garages.hpp"
#include "parkade/cli/semantic_samples.hpp"
#include "parkade/cli/sim_record.hpp"
#include "parkade/cli/text_samples.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/semantics/networks/class_map.hpp"
#include "parkade/semantics/networks/segmentation.hpp"

namespace parkade::cli {
namespace {

constexpr const char* kSemanticsFooter =
    "Draws garages with light, occupancy, people and camera rigs of their own, drives through "
    "them,\n"
    "and compares what the program sees with the truth. Garage seeds 5000 to 5999 are for tests;\n"
    "networks are trained on others (tools/train). DIR/metrics.json holds all figures.\n"
    "\n"
    "Examples:\n"
    "  parkade bench semantics --garages random:20 --out DIR\n"
    "  parkade bench semantics --garages random:3 --out DIR --pictures --network mine.yaml\n"
    "  parkade bench semantics --marking-points PS2.0 --out DIR --pictures\n"
    "  parkade bench semantics --garages random:0-99 --samples DATA   (training data)\n"
    "  parkade bench semantics --garages random:0-99 --samples TEXTS --texts\n"
    "  parkade bench semantics --garages random:0-99 --samples ALL --everything";

struct BenchArguments {
  std::string garages = "random:20";
  std::string out;
  std::string samples;
  std::string marking_points;
  bool pictures = false;
  bool slot_trials = false;
  bool fast = false;
  bool texts = false;
  bool everything = false;
  int threads = defaultThreads();
  SegmentationScoreOptions segmentation;
  std::string labels = "network";
  std::vector<std::string> settings;
  SampleOptions options;
  BevOptions bev;
};

/// What is done with each sample.
using Visit = std::function<Status(const SemanticSampler&, const SemanticSample&)>;

Status drawAll(const BenchArguments& arguments, const std::vector<int>& seeds,
               const std::string& folder,
               const std::function<Status(const SemanticSampler&)>& begin, const Visit& visit) {
  ProgressPrinter progress("bench");
  for (std::size_t g = 0; g < seeds.size(); ++g) {
    Result<sim::SimSpec> spec = drawConditions(seeds[g], folder);
    if (!spec) return spec.error();
    spec->fast = arguments.fast;
    spec->threads = arguments.threads;
    spec->first_zone = arguments.options.first_zone;
    const Result<std::unique_ptr<SemanticSampler>> sampler =
        SemanticSampler::make(*spec, arguments.options, arguments.bev);
    if (!sampler) return sampler.error();
    Status status = begin(**sampler);
    for (int i = 0; status && i < (*sampler)->count(); ++i) {
      status = visit(**sampler, (*sampler)->draw(i));
      progress.update((static_cast<double>(g) + (i + 1.0) / (*sampler)->count()) /
                      static_cast<double>(seeds.size()));
    }
    if (!status) return status;
  }
  progress.finish();
  return {};
}

// A training sample as files: the stitched picture and its labels, and two cameras' pictures with
// theirs, or all cameras'.
Status writeSample(const SemanticSampler& sampler, const SemanticSample& sample, bool all_views,
                   const std::string& stem) {
  const ImageEncoding png{.png = true, .png_level = 1};
  const ImageEncoding jpeg{.png = false, .jpeg_quality = 95};
  constexpr int kNotSeen = 255;
  const bool stitched = !sample.bev.image.empty();
  Status status;
  if (stitched) {
    status = writeImage(stem + "_bev.png", sample.bev.image, png);
    cv::Mat labels = sample.bev_labels.clone();
    labels.setTo(kNotSeen, sample.bev.valid == 0);
    if (status) status = writeImage(stem + "_bev_labels.png", labels, png);
  }
  const std::size_t cameras = sample.frames.images.size();
  for (std::size_t k = 0; status && k < (all_views ? cameras : 2); ++k) {
    const std::size_t i =
        (static_cast<std::size_t>(sample.frames.index) + k * (cameras / 2)) % cameras;
    const std::size_t view = all_views ? k : i;
    const int camera = static_cast<int>(view);
    status = writeImage(fmt::format("{}_raw{}.jpg", stem, k), sample.frames.images[view], jpeg);
    cv::Mat labels = sampler.cameraLabels(sample, camera);
    labels.setTo(kNotSeen, sampler.bodyMask(camera) == 0);
    if (status) status = writeImage(fmt::format("{}_raw{}_labels.png", stem, k), labels, png);
  }
  return status;
}

// What all cameras show of texts, as files.
Status writeTexts(TextSampler& texts, const SemanticSampler& sampler, const SemanticSample& sample,
                  const std::string& stem) {
  Status status;
  for (std::size_t i = 0; status && i < sample.frames.images.size(); ++i) {
    status = texts.write(sampler, sample, static_cast<int>(i), fmt::format("{}_cam{}", stem, i));
  }
  return status;
}

Status writeSamples(const BenchArguments& arguments, const std::vector<int>& seeds) {
  std::string folder;
  const auto done = [&] {
    return folder.empty() ? Status() : writeFileAtomic(joinPath(folder, "done"), "");
  };
  Result<TextSampler> texts = TextSampler::make(arguments.segmentation.raw_network);
  if (!texts) return texts.error();
  const Status status = drawAll(
      arguments, seeds, arguments.samples,
      [&](const SemanticSampler& sampler) {
        const Status before = done();
        if (!before) return before;
        folder = joinPath(arguments.samples,
                          fmt::format("g{:04d}", sampler.simulation().spec().garage_seed));
        return makeFolders(folder);
      },
      [&](const SemanticSampler& sampler, const SemanticSample& sample) {
        const std::string stem = joinPath(folder, fmt::format("{:03d}", sample.frames.index));
        const bool pictures = arguments.everything || !arguments.texts;
        const bool all_views = arguments.everything || !arguments.options.stitched;
        Status each = pictures ? writeSample(sampler, sample, all_views, stem) : Status();
        if (each && (arguments.everything || arguments.texts)) {
          each = writeTexts(*texts, sampler, sample, stem);
        }
        return each;
      });
  return status ? done() : status;
}

Result<std::vector<std::unique_ptr<SampleScore>>> makeScores(const BenchArguments& arguments) {
  std::vector<std::unique_ptr<SampleScore>> scores;
  const std::string pictures =
      arguments.pictures ? joinPath(arguments.out, "pictures") : std::string();
  const bool true_labels = arguments.labels == "truth";
  if (!true_labels) {
    SegmentationScoreOptions options = arguments.segmentation;
    options.pictures = pictures;
    Result<std::unique_ptr<SampleScore>> segmentation = makeSegmentationScore(options);
    if (!segmentation) return segmentation.error();
    scores.push_back(std::move(segmentation).value());
  }
  Result<std::unique_ptr<SampleScore>> objects =
      makeObjectScore({arguments.segmentation.bev_network, true_labels, pictures,
                       arguments.options.attitude_error_deg * M_PI / 180.0});
  if (!objects) return objects.error();
  scores.push_back(std::move(objects).value());
  Result<std::unique_ptr<SampleScore>> slots =
      makeSlotScore({arguments.segmentation.bev_network, true_labels, pictures,
                     arguments.options.attitude_error_deg * M_PI / 180.0,
                     0.01 * arguments.options.height_error_cm,
                     arguments.slot_trials ? joinPath(arguments.out, "slot_trials.csv") : ""});
  if (!slots) return slots.error();
  scores.push_back(std::move(slots).value());
  const std::string& views = arguments.segmentation.raw_network;
  if (!true_labels && views.empty() && !findModel(kViewNetwork)) return scores;
  const std::string faces = pictures.empty() ? pictures : joinPath(pictures, "zone_texts");
  Result<std::unique_ptr<SampleScore>> texts = makeZoneTextScore({views, true_labels, faces, {}});
  if (!texts) return texts.error();
  scores.push_back(std::move(texts).value());
  return scores;
}

Status score(const BenchArguments& arguments, const std::vector<int>& seeds) {
  Status status = makeFolders(arguments.out);
  if (!status) return status;
  Result<std::vector<std::unique_ptr<SampleScore>>> scores = makeScores(arguments);
  if (!scores) return scores.error();
  status = drawAll(
      arguments, seeds, arguments.out,
      [&](const SemanticSampler& sampler) {
        Status each;
        for (const auto& one : *scores) {
          if (each) each = one->begin(sampler);
        }
        return each;
      },
      [&](const SemanticSampler& sampler, const SemanticSample& sample) {
        Status each;
        for (const auto& one : *scores) {
          if (each) each = one->add(sampler, sample);
        }
        return each;
      });
  if (!status) return status;
  nlohmann::json metrics;
  metrics["garages"] = seeds;
  metrics["labels"] = arguments.labels;
  metrics["frames_per_garage"] = arguments.options.frames;
  metrics["attitude_error_deg"] = arguments.options.attitude_error_deg;
  metrics["height_error_cm"] = arguments.options.height_error_cm;
  for (const auto& one : *scores) {
    fmt::print("{}\n", one->table());
    one->writeTo(metrics);
  }
  return writeFileAtomic(joinPath(arguments.out, "metrics.json"), metrics.dump(2) + "\n");
}

int run(BenchArguments& arguments) {
  for (const std::string& setting : arguments.settings) {
    const Status status = setOption(asOptions(arguments.options), setting);
    if (!status) return failUsage(status.error());
  }
  if (arguments.slot_trials && !(arguments.samples.empty() && arguments.marking_points.empty())) {
    return failUsage(
        {"bench semantics: --slot-trials goes with --out DIR, not with --samples or "
         "--marking-points"});
  }
  if (!arguments.marking_points.empty()) {
    const Status status =
        arguments.out.empty() || !arguments.samples.empty()
            ? Status(Error{"bench semantics: --marking-points DIR needs --out DIR"})
            : scoreMarkingPoints({arguments.marking_points, arguments.segmentation.bev_network,
                                  arguments.out, arguments.pictures});
    return status ? 0 : fail(status.error());
  }
  const Result<std::vector<int>> seeds = parseGarages(arguments.garages);
  if (!seeds) return failUsage(seeds.error());
  if (arguments.out.empty() == arguments.samples.empty()) {
    return failUsage(
        {"bench semantics: give --out DIR for scores, or --samples DIR for training data"});
  }
  if (arguments.texts && arguments.samples.empty()) {
    return failUsage({"bench semantics: --texts needs --samples DIR"});
  }
  if (arguments.everything &&
      (arguments.samples.empty() || arguments.texts || !arguments.options.stitched)) {
    return failUsage(
        {"bench semantics: --everything goes with --samples DIR, without --texts and "
         "stitched=false"});
  }
  if (!arguments.options.stitched && arguments.samples.empty()) {
    return failUsage({"bench semantics: stitched=false serves --samples alone"});
  }
  if (arguments.texts) arguments.options.stitched = false;
  const Status status =
      arguments.samples.empty() ? score(arguments, *seeds) : writeSamples(arguments, *seeds);
  return status ? 0 : fail(status.error());
}

}  // namespace

void addBenchSemantics(CLI::App& bench, int& exit_code) {
  CLI::App* command =
      bench.add_subcommand("semantics", "Score networks and features on random garages");
  const auto arguments = std::make_shared<BenchArguments>();
  command
      ->add_option("--garages", arguments->garages,
                   "random:N (test garages), or random:FIRST-LAST with garage seeds")
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out, "Folder to write, made where it is not there")
      ->type_name("DIR");
  command
      ->add_option("--network", arguments->segmentation.bev_network,
                   "Class map of another network for stitched pictures (docs/networks.md)")
      ->type_name("YAML");
  command
      ->add_option("--view-network", arguments->segmentation.raw_network,
                   "Class map of another network for the cameras' views")
      ->type_name("YAML");
  command
      ->add_option("--labels", arguments->labels,
                   "What features are drawn from: the network's labels, or the true ones")
      ->check(CLI::IsMember({"network", "truth"}))
      ->capture_default_str();
  command->add_flag("--pictures", arguments->pictures,
                    "Write every picture, with found and with true labels, to DIR/pictures");
  command->add_flag("--slot-trials", arguments->slot_trials,
                    "Write all pairs of marks that may be slots, with what speaks for and against "
                    "them and whether they are, to DIR/slot_trials.csv (docs/networks.md)");
  command->add_option("--samples", arguments->samples, "Write training samples instead of scores")
      ->type_name("DIR");
  command->add_flag("--texts", arguments->texts,
                    "With --samples: straightened zone markers and slots' numbers with their texts "
                    "instead of pictures with labels");
  command->add_flag("--everything", arguments->everything,
                    "With --samples: stitched pictures, all cameras' views and texts of one drive "
                    "through each garage");
  command
      ->add_option("--marking-points", arguments->marking_points,
                   "Score slots' corners on marked real pictures instead: 10 m wide, with "
                   "annotations.txt (docs/networks.md)")
      ->type_name("DIR");
  command->add_flag("--fast", arguments->fast,
                    "One sample per pixel, 2 x 2 only where a surface ends");
  command->add_option("--threads", arguments->threads, "Threads that draw [all processors]")
      ->check(CLI::Range(1, 256));
  command->add_option("--set", arguments->settings, "An option below, as frames=20")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->footer(std::string(kSemanticsFooter) +
                  "\n\nOptions for --set (name, default, meaning):\n" +
                  describeOptions(asOptions(arguments->options)));
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace parkade::cli
