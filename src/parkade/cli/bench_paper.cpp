// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_paper.hpp"

#include <fmt/core.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <set>

#include "parkade/cli/bench_recording.hpp"
#include "parkade/cli/bench_report.hpp"
#include "parkade/cli/bench_runs.hpp"
#include "parkade/cli/option_checks.hpp"
#include "parkade/cli/output_folder.hpp"
#include "parkade/cli/sim_record.hpp"
#include "parkade/core/json_text.hpp"
#include "parkade/io/file.hpp"

namespace parkade::cli {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr const char* kPaperFooter =
    "Drives the routes of the paper's experiments through the simulated garage 'paper', runs "
    "every\n"
    "method on them, judges by the truth, and prints the paper's Tables 2 and 3 with its figures\n"
    "beside those measured. DIR then holds report.html, tables.md, metrics.json, sequences/ and "
    "runs/.\n"
    "Started again, it goes on where it stopped: what the same program did with the same options "
    "is\n"
    "kept. Definitions: docs/evaluation.md.\n"
    "\n"
    "Examples:\n"
    "  parkade bench --out DIR                                   all routes, all methods: hours\n"
    "  parkade bench --out DIR --quick                           a look: a few minutes\n"
    "  parkade bench --out DIR --garages random:10 --fast        ten garages of another kind\n"
    "  parkade bench --out DIR --routes test1 --light 10,50,200,1000 --methods fused\n"
    "  parkade bench --out DIR --garages random:10 --fast --calib-error 0.1:1\n"
    "  parkade bench --out DIR --variant wide=fused,vio.window.keyframes=12\n"
    "  parkade bench --out DIR --import orb-slam3=TRAJECTORIES   judges TRAJECTORIES/test1.tum, "
    "...";

void makeQuick(PaperBenchOptions& options) {
  const PaperBenchOptions untouched;
  constexpr double kSeconds = 30.0;
  if (options.routes == untouched.routes) options.routes = "test1,test2";
  if (options.methods == untouched.methods) options.methods = "vis1,vis,avp-slam,fused";
  if (options.duration_s == 0.0) options.duration_s = kSeconds;
}

// The work that remains, in time: each kind takes as long as its last ones did.
class Remaining {
 public:
  void add(const std::string& kind) { ++open_[kind]; }
  void done(const std::string& kind, double seconds) {
    --open_[kind];
    if (seconds >= 0.0) {
      auto& [sum, count] = taken_[kind];
      sum += seconds;
      ++count;
    }
  }
  [[nodiscard]] std::string text() const {
    double seconds = 0.0;
    bool known = true;
    bool any = false;
    for (const auto& [kind, count] : open_) {
      if (count <= 0) continue;
      any = true;
      const auto found = taken_.find(kind);
      if (found == taken_.end()) {
        known = false;
      } else {
        seconds += count * found->second.first / found->second.second;
      }
    }
    if (!any) return "all done";
    if (!known && seconds < 1.0) return "time left not known yet";
    const std::string least = known ? "" : "more than ";
    return seconds < 90.0 ? fmt::format("{}{:.0f} s left", least, seconds)
                          : fmt::format("{}{:.0f} min left", least, seconds / 60.0);
  }

 private:
  std::map<std::string, int> open_;
  std::map<std::string, std::pair<double, int>> taken_;
};

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::string outcome(const BenchRecord& record) {
  if (record.failed) return "failed: " + record.reason;
  return fmt::format("{} m (aligned {}), heading {} deg, real-time factor {}",
                     figureText(record.figure("ape.rmse")),
                     figureText(record.figure("ape_aligned.rmse")),
                     figureText(record.figure("ape_heading_deg.rmse"), 2),
                     figureText(record.figure("timing.real_time_factor"), 2));
}

std::vector<JudgedRun> performAll(const PaperBenchOptions& options, const BenchPlan& plan) {
  const std::string kRecording = "recording";
  Remaining remaining;
  for (std::size_t d = 0; d < plan.drives.size(); ++d) {
    remaining.add(kRecording);
    for (const BenchVariant& variant : plan.variants) remaining.add(variant.method.name);
  }
  std::vector<JudgedRun> runs;
  const std::size_t total = plan.drives.size() * plan.variants.size();
  for (const BenchDrive& drive : plan.drives) {
    const Clock::time_point begin = Clock::now();
    const Result<std::string> sequence = provideSequence(options, drive);
    remaining.done(kRecording, secondsSince(begin));
    for (const BenchVariant& variant : plan.variants) {
      const Clock::time_point start = Clock::now();
      runs.push_back(sequence ? performRun(options, drive, variant, *sequence)
                              : failedRun(drive, variant, sequence.error().message));
      const JudgedRun& run = runs.back();
      const bool telling = !run.kept && !run.record.failed;
      remaining.done(variant.method.name, telling ? secondsSince(start) : -1.0);
      fmt::print(stderr, "bench [{}/{}] {} {}: {}{}; {}\n", runs.size(), total, drive.name,
                 variant.method.name, outcome(run.record), run.kept ? " (kept)" : "",
                 remaining.text());
    }
  }
  return runs;
}

Json tableJson(const TextTable& table) {
  return {
      {"title", table.title}, {"note", table.note}, {"header", table.header}, {"rows", table.rows}};
}

Status writeAll(const PaperBenchOptions& options, const BenchPlan& plan,
                const std::vector<JudgedRun>& runs, const std::string& setting) {
  std::vector<BenchRecord> records;
  Json metrics;
  metrics["setting"] = setting;
  metrics["runs"] = Json::array();
  for (const JudgedRun& run : runs) {
    records.push_back(run.record);
    metrics["runs"].push_back(run.json);
  }
  std::vector<BenchMethod> methods;
  for (const BenchVariant& variant : plan.variants) methods.push_back(variant.method);
  std::vector<TextTable> tables = paperTables(records, methods);
  for (TextTable& table : detailTables(records, methods)) tables.push_back(std::move(table));
  std::string text = "## Bench\n\n" + setting + "\n";
  metrics["tables"] = Json::array();
  for (const TextTable& table : tables) {
    fmt::print("{}\n", plainText(table));
    text += "\n" + markdown(table);
    metrics["tables"].push_back(tableJson(table));
  }
  Status status = writeBenchReport(options, runs, tables, setting);
  if (status) status = writeFileAtomic(joinPath(options.out, "tables.md"), text);
  if (status) {
    status = writeFileAtomic(joinPath(options.out, "metrics.json"), jsonText(metrics));
  }
  if (status) fmt::print("Report: {}\n", joinPath(options.out, "report.html"));
  return status;
}

// A folder misspelt would cost hours of drawing.
Status checkSequences(const PaperBenchOptions& options, const BenchPlan& plan,
                      const std::vector<std::string>& given) {
  if (options.sequences.empty()) return {};
  std::error_code code;
  if (!std::filesystem::is_directory(options.sequences, code)) {
    return Error{fmt::format("bench: --sequences {}: no such folder", options.sequences)};
  }
  if (given.empty()) {
    return Error{fmt::format(
        "bench: --sequences {}: holds no whole recording that is asked for, as {}; without "
        "--sequences all are drawn",
        options.sequences, plan.drives.front().name)};
  }
  return {};
}

}  // namespace

int runPaperBench(PaperBenchOptions options) {
  if (options.out.empty()) {
    return failUsage({"bench: --out DIR is missing: where shall the results go?"});
  }
  if (options.quick) makeQuick(options);
  const Result<BenchPlan> plan = planBench(options);
  if (!plan) return failUsage(plan.error());
  // Before anything is drawn, perhaps into the same folder.
  const std::vector<std::string> given = givenDrives(options, *plan);
  if (Status fit = checkSequences(options, *plan, given); !fit) return failUsage(fit.error());
  if (Status made = makeWritable(options.out); !made) return fail(made.error());
  const std::string setting = settingText(options, *plan, given);
  const std::vector<JudgedRun> runs = performAll(options, *plan);
  if (Status written = writeAll(options, *plan, runs, setting); !written) {
    return fail(written.error());
  }
  std::size_t failed = 0;
  for (const JudgedRun& run : runs) failed += run.record.failed ? 1 : 0;
  if (failed == 0) return 0;
  return fail({fmt::format("bench: {} of {} runs failed: see the tables", failed, runs.size())});
}

std::shared_ptr<PaperBenchOptions> addPaperBenchOptions(CLI::App& bench) {
  auto o = std::make_shared<PaperBenchOptions>();
  o->threads = defaultThreads();
  bench.add_option("-o,--out", o->out, "Folder for recordings, runs and results")->type_name("DIR");
  bench.add_option("--garages", o->garages, "paper; random:N (test garages) or random:FIRST-LAST")
      ->capture_default_str();
  bench.add_option("--routes", o->routes, "Routes of the garage 'paper'")->capture_default_str();
  bench
      .add_option("--methods", o->methods,
                  "Of vis1, vis, semantic, semantic-all, avp-slam, fused1, fused-no-loops, fused")
      ->capture_default_str();
  bench.add_option("--seeds", o->seeds, "Drives of each route: other stops, people and noise")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  bench.add_flag("--quick", o->quick,
                 "Two routes, 30 s each, one sample per pixel, four methods (unless set)");
  bench.add_flag("--fast", o->fast, "One sample per pixel, 2 x 2 only where a surface ends");
  bench.add_option("--duration", o->duration_s, "Cut every drive after S seconds; 0: whole")
      ->type_name("S")
      ->check(notNegative());
  bench
      .add_option("--sequences", o->sequences,
                  "Use recordings found here as test1, test2_seed2, random_5000, ...")
      ->type_name("DIR");
  bench.add_option("--light", o->light, "Also at these mean lights on the floor, lux")
      ->type_name("LX,...");
  bench
      .add_option("--occupancy", o->occupancy, "Also with such shares of slots taken, as 0.2,0.95")
      ->type_name("SHARE,...");
  bench
      .add_option("--agents", o->agents,
                  "Also with so many moving cars and walking people, as 0:0,6:8")
      ->type_name("CARS:PEOPLE,...");
  bench
      .add_option("--calib-error", o->calib_error,
                  "Also with cameras told wrong by so many degrees and centimetres, as 0.1:1; one "
                  "number: as many of either")
      ->type_name("DEG:CM,...");
  bench.add_option("--cameras", o->cameras, "Also vis with so many cameras, as 1..6")
      ->type_name("FIRST..LAST");
  bench
      .add_option("--variant", o->variants,
                  "Also NAME=METHOD,option=value,...: an ablation; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  bench
      .add_option("--import", o->imports,
                  "Also trajectories of another system: NAME=DIR with DIR/test1.tum, ...; poses of "
                  "the vehicle frame; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  bench.add_option("--set", o->settings, "An option of every run, as of 'parkade run'")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  bench.add_flag("--again", o->again, "Run anew what an earlier bench did already");
  bench.add_option("--threads", o->threads, "Threads that draw and run [all processors]")
      ->check(CLI::Range(1, 64));
  bench.footer(kPaperFooter);
  return o;
}

}  // namespace parkade::cli
