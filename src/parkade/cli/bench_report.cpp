// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_report.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "parkade/cli/eval_map.hpp"
#include "parkade/cli/map_truth_file.hpp"
#include "parkade/cli/report_files.hpp"
#include "parkade/cli/report_map.hpp"
#include "parkade/cli/run_report.hpp"
#include "parkade/eval/charts.hpp"
#include "parkade/eval/evaluation.hpp"
#include "parkade/eval/html_page.hpp"
#include "parkade/eval/map_picture.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/trajectory_io.hpp"

namespace parkade::cli {
namespace {

// The map of a run drawn on the truth, as PNG bytes; nothing where there is none.
std::string mapErrors(const JudgedRun& run) {
  if (!std::filesystem::is_regular_file(joinPath(run.folder, "map.db"))) return "";
  const Result<MapTruth> truth = readMapTruth(run.sequence);
  if (!truth) return "";
  const Result<PlacedMap> placed = loadPlacedMap(run.folder, truth->driven);
  if (!placed) return "";
  const Result<MapEvaluation> evaluation =
      evaluateMap(placed->map, SE2::fromSE3(placed->T_truth_map), *truth);
  if (!evaluation) return "";
  return reportPng(drawMapErrors(placed->map, *truth, *evaluation));
}

struct DriveCharts {
  std::vector<ChartLine> ways;
  std::vector<ChartLine> errors;
  std::vector<ChartBar> speeds;
};

void addRun(const JudgedRun& run, const Trajectory& truth, DriveCharts& charts) {
  const Result<TrajectoryFile> estimate = readTrajectory(run.trajectory);
  if (!estimate) return;
  EvaluationOptions options;
  options.align = "origin";
  const Result<Evaluation> e = evaluate(estimate->poses, truth, options);
  if (!e) return;
  charts.ways.push_back({run.record.method, groundPoints(e->estimate), false});
  ChartLine errors{run.record.method, {}, false};
  for (std::size_t i = 0; i < e->pairs.estimate.size(); ++i) {
    errors.points.emplace_back(toSeconds(e->pairs.estimate[i].t_ns - truth.front().t_ns),
                               e->absolute.translation[i]);
  }
  charts.errors.push_back(std::move(errors));
  const double factor = run.record.figure("timing.real_time_factor");
  if (factor > 0.0) {
    charts.speeds.push_back({run.record.method, factor, -1.0, fmt::format("{:.2f}", factor)});
  }
}

// The run that shows the whole system best: the last one with a map, else the last that tracked.
const JudgedRun* shownRun(const std::vector<const JudgedRun*>& runs) {
  for (const char* file : {"map.db", "trajectory.tum"}) {
    for (auto at = runs.rbegin(); at != runs.rend(); ++at) {
      if ((*at)->record.failed) continue;
      if (std::filesystem::is_regular_file(joinPath((*at)->folder, file))) return *at;
    }
  }
  return nullptr;
}

void addShownRun(const JudgedRun& shown, HtmlPage& page) {
  const ReportedRun run = readReportedRun(shown.folder);
  page.subsection(fmt::format("What {} saw and mapped", shown.record.method));
  addCameraFigures(run, page);
  addMapFigures(run, page);
  addLayerFigures(run, page);
  addLocalMapFigures(run, page);
}

void addDrive(const std::vector<const JudgedRun*>& runs, bool in_full, HtmlPage& page) {
  const BenchRecord& first = runs.front()->record;
  page.section(fmt::format("{} / {}{}, seed {}", first.garage, first.route,
                           first.condition.empty() ? "" : ", " + first.condition, first.seed));
  const JudgedRun* judged = nullptr;
  for (const JudgedRun* run : runs) {
    if (run->record.failed) {
      page.paragraph(fmt::format("{} failed: {}", run->record.method, run->record.reason));
    } else {
      judged = run;
    }
  }
  if (judged == nullptr) return;
  const Result<TrajectoryFile> truth = readReference(judged->sequence);
  if (!truth || truth->poses.empty()) return;
  DriveCharts charts;
  for (const JudgedRun* run : runs) {
    if (!run->record.failed) addRun(*run, truth->poses, charts);
  }
  charts.ways.push_back({"truth", groundPoints(truth->poses), true});
  page.beginFigures();
  page.svg(groundChart("Ways over the plan, m", readPlanPicture(judged->sequence), charts.ways),
           "Estimated ways, first poses joined with the truth's (the paper's Fig. 9)");
  page.svg(lineChart("Position error, m", "time from the beginning, s", charts.errors),
           "Position error over time");
  if (!charts.speeds.empty()) {
    page.svg(barChart("Real-time factor (1: as fast as the car drove)", charts.speeds),
             "Processing time / recorded time");
  }
  const JudgedRun* shown = shownRun(runs);
  if (shown != nullptr) {
    page.svg(timingChart(shown->folder),
             fmt::format("Where the time of {} goes", shown->record.method));
  }
  for (auto at = runs.rbegin(); at != runs.rend(); ++at) {  // the whole system comes last
    const JudgedRun* run = *at;
    if (run->record.failed) continue;
    const std::string map = mapErrors(*run);
    if (map.empty()) continue;
    page.picture(map, fmt::format("The map of {} on the truth. Paint: both grey, the map's alone "
                                  "red, the truth's alone blue. Slots: found green, missed orange, "
                                  "wrong magenta; corner errors ten times as long, dark red",
                                  run->record.method));
    break;  // one is enough for a page
  }
  page.endFigures();
  if (shown != nullptr && in_full) addShownRun(*shown, page);
}

}  // namespace

Status writeBenchReport(const PaperBenchOptions& options, const std::vector<JudgedRun>& runs,
                        const std::vector<TextTable>& tables, const std::string& setting) {
  HtmlPage page("Parkade: bench");
  page.paragraph(setting);
  for (const TextTable& table : tables) page.table(table);
  // Of more drives the page would be too heavy; each run has a page of its own.
  constexpr int kInFull = 2;
  int shown_in_full = 0;
  for (std::size_t begin = 0; begin < runs.size();) {
    const BenchRecord& first = runs[begin].record;
    std::vector<const JudgedRun*> of_drive;
    std::size_t end = begin;
    for (; end < runs.size(); ++end) {
      const BenchRecord& r = runs[end].record;
      if (r.garage != first.garage || r.route != first.route || r.seed != first.seed ||
          r.condition != first.condition) {
        break;
      }
      of_drive.push_back(&runs[end]);
    }
    addDrive(of_drive, shown_in_full < kInFull, page);
    ++shown_in_full;
    begin = end;
  }
  return writeFileAtomic(joinPath(options.out, "report.html"), page.str());
}

}  // namespace parkade::cli
