// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "parkade/cli/camera_errors.hpp"
#include "parkade/cli/command.hpp"
#include "parkade/cli/option_checks.hpp"
#ifdef PARKADE_WITH_EVAL_MAP
#include "parkade/cli/eval_map.hpp"
#include "parkade/cli/map_truth_file.hpp"
#endif
#ifdef PARKADE_WITH_REPORT
#include "parkade/cli/run_report.hpp"
#endif
#include "parkade/cli/told_covariances.hpp"
#include "parkade/eval/plot.hpp"
#include "parkade/eval/report.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/trajectory_io.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;

struct EvalArguments {
  std::string trajectory;
  std::string reference;
  std::string format = "auto";
  std::string reference_format = "auto";
  std::string times;
  std::string json;
  std::string plot;
  std::string report;
  std::string plane = "auto";
  std::vector<std::string> in_map;  // map and the sequence that it was made on
  EvaluationOptions options;
};

constexpr const char* kEvalFooter =
    "TRAJECTORY is a file (TUM, KITTI or EuRoC csv; the first row tells which) or the folder of a\n"
    "run (its trajectory.tum). REFERENCE is a file, or the folder of a sequence (its ground "
    "truth)\n"
    "or of another run. Stamps are seconds in TUM and nanoseconds in EuRoC files. KITTI files "
    "have\n"
    "none: two of them are matched row by row, and where one is longer its surplus is left out.\n"
    "\n"
    "Definitions of all figures: docs/evaluation.md.\n"
    "\n"
    "Examples:\n"
    "  parkade eval OUT SEQ --json metrics.json --plot error.svg\n"
    "  parkade eval map OUT SEQ --json map.json --picture errors.png\n"
    "  parkade eval LATER SEQ2 --in-map OUT SEQ\n"
    "  parkade eval estimate.tum groundtruth.tum --align sim3 --rpe-delta 1 --rpe-unit s";

// A run's trajectory, where the path is a run's folder.
std::optional<std::string> runTrajectory(const std::string& path) {
  const fs::path file = fs::path(path) / "trajectory.tum";
  return fs::is_regular_file(file) ? std::optional(file.string()) : std::nullopt;
}

// A file, or a sequence folder (its ground truth), from the path that the user gave.
Result<std::string> estimatePath(const std::string& path) {
  if (const auto run = runTrajectory(path)) return *run;
  if (fs::is_directory(path) && !findReference(path)) {
    return Error{fmt::format(
        "{}: the folder holds neither trajectory.tum (of a run) nor mav0 with a ground truth",
        path)};
  }
  return path;
}

Result<std::string> referencePath(const std::string& path) {
  if (path.starts_with("sim:")) {
    return Error{fmt::format(
        "{}: the truth of a simulated drive is read from a sequence folder: write it with 'parkade "
        "sim --out SEQ' and give SEQ",
        path)};
  }
  const auto run = runTrajectory(path);
  return run && !findReference(path) ? *run : path;
}

Result<TrajectoryFile> read(const Result<std::string>& path, const std::string& format,
                            const std::string& times) {
  if (!path) return path.error();
  if (!fs::exists(*path)) return Error{fmt::format("{}: no such file or folder", *path)};
  TrajectoryReadOptions options;
  options.format = trajectoryFormatFromName(format);
  auto file = readReference(*path, options);
  if (!times.empty() && !fs::exists(times)) {
    return Error{fmt::format("--times {}: no such file", times)};
  }
  if (!file || file->has_stamps || times.empty()) return file;
  options.kitti_times_path = times;
  return readReference(*path, options);
}

Status checkClocks(const TrajectoryFile& estimate, const TrajectoryFile& reference,
                   const EvalArguments& arguments) {
  if (estimate.has_stamps != reference.has_stamps) {
    return Error{fmt::format("{} has no stamps (KITTI) but {} has: give the stamps with --times",
                             estimate.has_stamps ? arguments.reference : arguments.trajectory,
                             estimate.has_stamps ? arguments.trajectory : arguments.reference)};
  }
  if (!estimate.has_stamps && arguments.options.rpe.unit == "s") {
    return Error{
        "an RPE over seconds needs stamps, and KITTI files have none: give them with --times, or "
        "use --rpe-unit f"};
  }
  return {};
}

#ifdef PARKADE_WITH_EVAL_MAP
// Lays the poses of a run in a saved map where the truth of the drive that made it says that it
// lies.
// Over the ground: a map knows no heights, and each drive its own vertical.
Status placeInMap(const EvalArguments& arguments, Trajectory& poses, Trajectory& reference) {
  const Result<MapTruth> truth = readMapTruth(arguments.in_map[1]);
  if (!truth) return truth.error();
  const Result<PlacedMap> placed = loadPlacedMap(arguments.in_map[0], truth->driven);
  if (!placed) return placed.error();
  const auto flat = [](const SE3& T) { return SE2::fromSE3(T).toSE3(); };
  for (StampedPose& pose : poses) {
    pose.T_world_body = flat(placed->T_truth_map * pose.T_world_body);
  }
  for (StampedPose& pose : reference) pose.T_world_body = flat(pose.T_world_body);
  return {};
}
#endif

Status evaluateFiles(const EvalArguments& arguments) {
  auto estimate = read(estimatePath(arguments.trajectory), arguments.format, arguments.times);
  if (!estimate) return estimate.error();
  auto reference =
      read(referencePath(arguments.reference), arguments.reference_format, arguments.times);
  if (!reference) return reference.error();
  if (auto status = checkClocks(*estimate, *reference, arguments); !status) return status;

  const bool in_map = !arguments.in_map.empty();
  EvaluationOptions options = arguments.options;
#ifdef PARKADE_WITH_EVAL_MAP
  if (in_map) {
    if (auto status = placeInMap(arguments, estimate->poses, reference->poses); !status)
      return status;
    options.align = "none";
  }
#endif

  auto evaluation = evaluate(estimate->poses, reference->poses, options);
  if (!evaluation) {
    return Error{fmt::format("{} against {}: {}", arguments.trajectory, arguments.reference,
                             evaluation.error().message)};
  }
  if (!in_map) {  // the covariances of a run in a map leave out the map's own errors
    auto status = judgeCovariances(arguments.trajectory, estimate->poses, reference->poses,
                                   options.association, *evaluation);
    if (!status) return status;
  }
  if (auto status = judgeCameras(arguments.trajectory, arguments.reference, *evaluation); !status) {
    return status;
  }
  EvaluationLabels labels{arguments.trajectory, arguments.reference, !estimate->has_stamps};
  if (labels.by_index && estimate->poses.size() != reference->poses.size()) {
    evaluation->notes.insert(
        evaluation->notes.begin(),
        fmt::format("the files have no stamps and differ in length ({} and {} poses): row i was "
                    "matched with row i, the surplus left out",
                    estimate->poses.size(), reference->poses.size()));
  }
  if (!arguments.json.empty()) {
    auto status = writeFileAtomic(arguments.json, evaluationJson(*evaluation, labels));
    if (!status) return status;
  }
  if (!arguments.plot.empty()) {
    const PlotPlane plane = arguments.plane == "xy"   ? PlotPlane::kXy
                            : arguments.plane == "xz" ? PlotPlane::kXz
                            : arguments.plane == "yz" ? PlotPlane::kYz
                                                      : PlotPlane::kAuto;
    auto status = writeFileAtomic(arguments.plot,
                                  evaluationSvg(*evaluation, reference->poses, labels, plane));
    if (!status) return status;
  }
#ifdef PARKADE_WITH_REPORT
  if (!arguments.report.empty()) {
    if (!runTrajectory(arguments.trajectory)) {
      return Error{fmt::format("{}: --report is about the folder of a run", arguments.trajectory)};
    }
    ReportTruth truth{*evaluation, reference->poses, {}};
#ifdef PARKADE_WITH_EVAL_MAP
    truth.plan = readPlanPicture(arguments.reference);
#endif
    const Status page = writeRunReport(arguments.trajectory, arguments.report, truth);
    if (!page) return page;
  }
#endif
  fmt::print("{}", evaluationTable(*evaluation, labels));
  return {};
}

}  // namespace

void addEvalCommand(CLI::App& app, int& exit_code) {
  auto* command =
      app.add_subcommand("eval", "Judge a trajectory by a reference: APE, RPE, drift; or a map");
  const auto a = std::make_shared<EvalArguments>();
  const std::vector<std::string> formats = {"auto", "tum", "kitti", "euroc"};
  // Not required(): 'eval map' does without; the callback asks for them.
  command->add_option("TRAJECTORY", a->trajectory, "Trajectory file or run folder");
  command->add_option("REFERENCE", a->reference, "Reference file, sequence or run folder");
#ifdef PARKADE_WITH_EVAL_MAP
  addEvalMapCommand(*command, exit_code);
#endif

  AssociationOptions& association = a->options.association;
  command
      ->add_option("--tolerance", association.tolerance_s,
                   "Largest difference of two stamps that match, s")
      ->check(notNegative())
      ->capture_default_str()
      ->group("Matching");
  command
      ->add_flag("--interpolate", association.interpolate,
                 "Interpolate the reference at the trajectory's stamps")
      ->group("Matching");
  command->add_option("--offset", association.offset_s, "Added to the trajectory's stamps, s")
      ->capture_default_str()
      ->group("Matching");
  command
      ->add_option("--max-gap", association.max_gap_s,
                   "A longer pause (and than 3 median steps) is a hole: not covered, not "
                   "interpolated across, s")
      ->check(notNegative())
      ->capture_default_str()
      ->group("Matching");
  command->add_option("--format", a->format, "Format of TRAJECTORY")
      ->check(CLI::IsMember(formats))
      ->capture_default_str()
      ->group("Matching");
  command->add_option("--reference-format", a->reference_format, "Format of REFERENCE")
      ->check(CLI::IsMember(formats))
      ->capture_default_str()
      ->group("Matching");
  command->add_option("--times", a->times, "Stamps of KITTI files: seconds, one a line")
      ->group("Matching");

  command
      ->add_option("--align", a->options.align,
                   "Alignment before measuring: se3 (rigid), sim3 (and scale), yaw (heading "
                   "about z and position), origin (first poses joined), none")
      ->check(CLI::IsMember({"se3", "sim3", "yaw", "origin", "none"}))
      ->capture_default_str()
      ->group("Measuring");
#ifdef PARKADE_WITH_EVAL_MAP
  command
      ->add_option("--in-map", a->in_map,
                   "Of a run in a saved map: that map (or its run's folder), and the sequence that "
                   "it was made on, whose truth tells where it lies; over the ground, no alignment")
      ->expected(2)
      ->type_name("MAP SEQ")
      ->excludes("--align")
      ->group("Measuring");
#endif
  command->add_option("--rpe-delta", a->options.rpe.delta, "Distance of the RPE's pairs")
      ->check(positive())
      ->capture_default_str()
      ->group("Measuring");
  command
      ->add_option("--rpe-unit", a->options.rpe.unit,
                   "Unit of --rpe-delta: m (path), s, f (frames)")
      ->check(CLI::IsMember({"m", "s", "f"}))
      ->capture_default_str()
      ->group("Measuring");
  command
      ->add_flag("--rpe-all-pairs", a->options.rpe.all_pairs,
                 "Pairs from every pose on, not only one after the other")
      ->group("Measuring");

  command->add_option("--json", a->json, "Write the figures to this file")->group("Output");
  command->add_option("--plot", a->plot, "Draw trajectories and errors to this SVG file")
      ->check(endsWith(".svg"))
      ->group("Output");
#ifdef PARKADE_WITH_REPORT
  command->add_option("--report", a->report, "Write a run's page with its errors to this HTML file")
      ->group("Output");
#endif
  command->add_option("--plane", a->plane, "Plane of the plot's top view")
      ->check(CLI::IsMember({"auto", "xy", "xz", "yz"}))
      ->capture_default_str()
      ->group("Output");
  command->footer(kEvalFooter);
  command->callback([a, command, &exit_code] {
    if (!command->get_subcommands().empty()) return;
    if (a->trajectory.empty()) throw CLI::RequiredError("TRAJECTORY");
    if (a->reference.empty()) throw CLI::RequiredError("REFERENCE");
    if (a->options.rpe.unit == "f" && a->options.rpe.delta != std::floor(a->options.rpe.delta)) {
      throw CLI::ValidationError("--rpe-delta",
                                 fmt::format("{} frames: a whole number", a->options.rpe.delta));
    }
    const Status status = evaluateFiles(*a);
    if (!status) exit_code = fail(status.error());
  });
}

}  // namespace parkade::cli
