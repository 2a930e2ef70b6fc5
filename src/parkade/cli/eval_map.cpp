// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/eval_map.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <memory>

#include "parkade/cli/command.hpp"
#include "parkade/cli/map_path.hpp"
#include "parkade/cli/map_truth_file.hpp"
#include "parkade/cli/option_checks.hpp"
#include "parkade/eval/map_picture.hpp"
#include "parkade/eval/map_report.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/trajectory_io.hpp"
#include "parkade/mapping/storage/map_file.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;

struct EvalMapArguments {
  std::string map;
  std::string sequence;
  std::string json;
  std::string picture;
  MapEvaluationOptions options;
};

Status evaluateMapFile(const EvalMapArguments& arguments) {
  const Result<MapTruth> truth = readMapTruth(arguments.sequence);
  if (!truth) return truth.error();
  const Result<PlacedMap> placed = loadPlacedMap(arguments.map, truth->driven);
  if (!placed) return placed.error();
  const Result<MapEvaluation> evaluation =
      evaluateMap(placed->map, SE2::fromSE3(placed->T_truth_map), *truth, arguments.options);
  if (!evaluation) {
    return Error{fmt::format("{}: {}", arguments.map, evaluation.error().message)};
  }
  fmt::print("map        {}\ntruth      {}\n\n{}", arguments.map, arguments.sequence,
             mapEvaluationTable(*evaluation));
  if (!arguments.json.empty()) {
    if (Status s = writeFileAtomic(arguments.json, mapEvaluationJson(*evaluation)); !s) return s;
  }
  if (arguments.picture.empty()) return {};
  const Result<cv::Mat> picture = drawMapErrors(placed->map, *truth, *evaluation);
  if (!picture) return picture.error();
  ImageEncoding png;
  png.png = true;
  return writeImage(arguments.picture, *picture, png);
}

}  // namespace

Result<PlacedMap> loadPlacedMap(const std::string& path, const Trajectory& driven) {
  const bool folder = fs::is_directory(path);
  const std::string file = mapFileOf(path);
  if (!fs::is_regular_file(file)) {
    return Error{fmt::format("{}: no map there; run with --method fused writes one", file)};
  }
  Result<ParkingMap> map = loadMap(file);
  if (!map) return map.error();
  StampedPose first;
  if (folder && fs::is_regular_file(joinPath(path, "trajectory.tum"))) {
    const Result<TrajectoryFile> poses = readTrajectory(joinPath(path, "trajectory.tum"));
    if (!poses) return poses.error();
    if (poses->poses.empty()) return Error{fmt::format("{}: the trajectory is empty", path)};
    first = poses->poses.front();
  } else if (!map->nodes.empty()) {
    first = {map->nodes.front().t_ns, map->nodes.front().T_world_vehicle};
  } else {
    return Error{fmt::format("{}: the map has no poses: where it lies is not known", path)};
  }
  const Result<SE3> place = placeByFirstPose(first.t_ns, first.T_world_body, driven);
  if (!place) return Error{fmt::format("{}: {}", path, place.error().message)};
  return PlacedMap{std::move(map).value(), *place};
}

void addEvalMapCommand(CLI::App& eval, int& exit_code) {
  auto* command = eval.add_subcommand("map", "Judge a map by the truth of a simulated sequence");
  const auto a = std::make_shared<EvalMapArguments>();
  command->add_option("MAP", a->map, "Run folder, or map file")->required();
  command->add_option("SEQ", a->sequence, "Sequence folder with its truth")->required();
  command
      ->add_option("--passed-within", a->options.passed_within_m,
                   "Judge what the car came this near to, m")
      ->check(positive())
      ->capture_default_str();
  command->add_option("--min-iou", a->options.min_iou, "A slot is found from this overlap on")
      ->check(CLI::Range(0.05, 0.99))
      ->capture_default_str();
  command->add_option("--json", a->json, "Write the figures to this file")->group("Output");
  command->add_option("--picture", a->picture, "Draw map and truth to this PNG file")
      ->check(endsWith(".png"))
      ->group("Output");
  command->footer(
      "The map is laid on the truth by its first pose. Definitions: docs/evaluation.md.\n"
      "\n"
      "Example:\n"
      "  parkade eval map OUT SEQ --json map.json --picture errors.png");
  command->callback([a, &exit_code] {
    const Status status = evaluateMapFile(*a);
    if (!status) exit_code = fail(status.error());
  });
}

}  // namespace parkade::cli
