// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_runs.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "parkade/camera/rig.hpp"
#include "parkade/cli/bench_key.hpp"
#include "parkade/cli/camera_errors.hpp"
#include "parkade/cli/child_process.hpp"
#include "parkade/cli/eval_map.hpp"
#include "parkade/cli/map_truth_file.hpp"
#include "parkade/cli/told_covariances.hpp"
#include "parkade/core/json_text.hpp"
#include "parkade/eval/map_report.hpp"
#include "parkade/eval/report.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/trajectory_io.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

bool isKept(const Json& mark, const std::string& key) {
  if (!mark.is_object() || !mark.contains("run") || !mark.contains("key")) return false;
  const Json& run = mark["run"];
  return mark["key"] == key && run.is_object() && run.contains("status") && run["status"] == "done";
}

void flatten(const Json& json, const std::string& path, std::map<std::string, double>& figures) {
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) {
      flatten(value, path.empty() ? name : path + "." + name, figures);
    }
  } else if (json.is_number()) {
    figures[path] = json.get<double>();
  }
}

JudgedRun emptyRun(const BenchDrive& drive, const BenchVariant& variant) {
  JudgedRun run;
  run.record.garage = drive.garage;
  run.record.route = drive.route;
  run.record.condition = drive.condition;
  run.record.method = variant.method.name;
  run.record.seed = drive.spec.seed;
  run.json = {{"garage", drive.garage},
              {"route", drive.route},
              {"condition", drive.condition},
              {"seed", drive.spec.seed},
              {"method", variant.method.name}};
  return run;
}

// Record and figures from the JSON of a run.
void readRecord(JudgedRun& run) {
  run.record.failed = run.json.value("status", "failed") != "done";
  run.record.reason = run.json.value("reason", "");
  run.record.figures.clear();
  flatten(run.json, "", run.record.figures);
}

Result<Json> judgeTrajectory(const std::string& trajectory, const std::string& sequence) {
  const Result<TrajectoryFile> estimate = readTrajectory(trajectory);
  if (!estimate) return estimate.error();
  const Result<TrajectoryFile> truth = readReference(sequence);
  if (!truth) return truth.error();
  EvaluationOptions options;
  options.align = "origin";
  Result<Evaluation> anchored = evaluate(estimate->poses, truth->poses, options);
  if (!anchored) return anchored.error();
  const Status told = judgeCovariances(fs::path(trajectory).parent_path().string(), estimate->poses,
                                       truth->poses, {}, *anchored);
  if (!told) return told.error();
  const Status found =
      judgeCameras(fs::path(trajectory).parent_path().string(), sequence, *anchored);
  if (!found) return found.error();
  options.align = "se3";
  const Result<Evaluation> aligned = evaluate(estimate->poses, truth->poses, options);
  if (!aligned) return aligned.error();
  Json json = Json::parse(evaluationJson(*anchored, {trajectory, sequence}));
  const Json other = Json::parse(evaluationJson(*aligned, {trajectory, sequence}));
  json["ape_aligned"] = other["ape"];
  json["ape_aligned_heading_deg"] = other["ape_heading_deg"];
  return json;
}

Result<Json> judgeMap(const std::string& folder, const std::string& sequence) {
  const Result<MapTruth> truth = readMapTruth(sequence);
  if (!truth) return truth.error();
  const Result<PlacedMap> placed = loadPlacedMap(folder, truth->driven);
  if (!placed) return placed.error();
  const Result<MapEvaluation> evaluation =
      evaluateMap(placed->map, SE2::fromSE3(placed->T_truth_map), *truth);
  if (!evaluation) return evaluation.error();
  return Json::parse(mapEvaluationJson(*evaluation));
}

Status judge(JudgedRun& run) {
  const Result<Json> accuracy = judgeTrajectory(run.trajectory, run.sequence);
  if (!accuracy) return accuracy.error();
  for (const auto& [name, value] : accuracy->items()) run.json[name] = value;
  const std::string timing = textOrEmpty(joinPath(run.folder, "timing.json"));
  if (!timing.empty()) run.json["timing"] = Json::parse(timing, nullptr, false);
  if (fs::is_regular_file(joinPath(run.folder, "map.db"))) {
    const Result<Json> map = judgeMap(run.folder, run.sequence);
    if (map) {
      run.json["map"] = *map;
    } else {
      run.json["map_reason"] = map.error().message;
    }
  }
  return {};
}

Status execute(const PaperBenchOptions& options, const BenchVariant& variant,
               const std::string& cameras, const JudgedRun& run) {
  if (!variant.import_folder.empty()) {
    if (fs::is_regular_file(run.trajectory)) return {};
    return Error{fmt::format("{}: no such file", run.trajectory)};
  }
  std::vector<std::string> arguments{
      "run",    run.sequence, "--method",  variant.run_method,
      "--out",  run.folder,   "--threads", std::to_string(options.threads),
      "--force"};
  if (!cameras.empty()) arguments.insert(arguments.end(), {"--cameras", cameras});
  for (const std::string& setting : variant.settings) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  return runProgram(arguments, run.folder + ".log");
}

Result<std::string> camerasOf(const BenchVariant& variant, const std::string& sequence) {
  if (!variant.import_folder.empty()) return std::string();
  const Result<Rig> rig = readSequenceRig(sequence);
  if (!rig) return rig.error();
  std::vector<std::string> names;
  for (const RigCamera& camera : rig->cameras) names.push_back(camera.name);
  if (variant.cameras > static_cast<int>(names.size())) {
    return Error{
        fmt::format("the rig has {} cameras, {} were asked for", names.size(), variant.cameras)};
  }
  return camerasOption(variant, names);
}

}  // namespace

JudgedRun failedRun(const BenchDrive& drive, const BenchVariant& variant,
                    const std::string& reason) {
  JudgedRun run = emptyRun(drive, variant);
  run.json["status"] = "failed";
  run.json["reason"] = reason;
  readRecord(run);
  return run;
}

JudgedRun performRun(const PaperBenchOptions& options, const BenchDrive& drive,
                     const BenchVariant& variant, const std::string& sequence) {
  JudgedRun run = emptyRun(drive, variant);
  const std::string runs = joinPath(joinPath(options.out, "runs"), drive.name);
  run.sequence = sequence;
  run.folder = joinPath(runs, variant.method.name);
  const bool imported = !variant.import_folder.empty();
  run.trajectory = imported ? joinPath(variant.import_folder, drive.name + ".tum")
                            : joinPath(run.folder, "trajectory.tum");
  const Result<std::string> cameras = camerasOf(variant, sequence);
  if (!cameras) return failedRun(drive, variant, cameras.error().message);
  const std::string key = runKey(variant, {*cameras, options.threads, sequence, run.trajectory});
  const std::string mark = joinPath(run.folder, "bench.json");
  Json before = Json::parse(textOrEmpty(mark), nullptr, false);
  if (!options.again && isKept(before, key)) {
    run.json = std::move(before["run"]);
    run.kept = true;
    readRecord(run);
    return run;
  }
  std::error_code code;
  fs::remove(mark, code);
  Status status = makeFolders(run.folder);
  if (status) status = execute(options, variant, *cameras, run);
  if (status) status = judge(run);
  run.json["status"] = status ? "done" : "failed";
  if (!status) run.json["reason"] = status.error().message;
  readRecord(run);
  // A failure is not kept: the next bench tries again.
  if (status) {
    const Json kept{{"key", key}, {"run", run.json}};
    status = writeFileAtomic(mark, jsonText(kept));
    if (!status) return failedRun(drive, variant, status.error().message);
  }
  return run;
}

}  // namespace parkade::cli
