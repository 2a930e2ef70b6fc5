// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_plan.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "parkade/cli/bench_conditions.hpp"
#include "parkade/cli/run_methods.hpp"
#include "parkade/cli/semantic_garages.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/split.hpp"
#include "parkade/pipeline/mapping_run.hpp"

namespace parkade::cli {
namespace {

// The method for which 'parkade run' takes one camera where none is named.
constexpr const char* kOneCameraMethod = "semantic";

// The methods that the command knows by name: those of the paper's tables, and what teaches more.
const std::vector<BenchVariant>& knownVariants() {
  static const std::vector<BenchVariant> kVariants = {
      {{"vis1", "vis, one camera", false, true}, "vis", 1, {}, ""},
      {{"vis", "vis, all cameras", false, true}, "vis", 0, {}, ""},
      {{"semantic", "semantic, one camera", false, true}, "semantic", 1, {}, ""},
      {{"semantic-all", "semantic, all cameras", false, true}, "semantic", 0, {}, ""},
      {{"avp-slam", "avp-slam", true, false}, "avp-slam", 0, {}, ""},
      {{"fused1", "fused, one camera", false, true}, "fused", 1, {}, ""},
      {{"fused-no-loops", "fused without loop closure", false, true},
       "fused",
       0,
       {"fusion.submaps.revisit_age_m=1000"},
       ""},
      {{"fused", "fused, all cameras", true, true}, "fused", 0, {}, ""},
  };
  return kVariants;
}

// NAME=REST.
Result<std::pair<std::string, std::string>> named(const std::string& option,
                                                  const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string name = text.substr(0, std::min(equals, text.size()));
  const bool plain = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
  if (equals == std::string::npos || !plain) {
    return Error{fmt::format(
        "bench: {} {}: expected NAME=..., the name of letters, digits, '-', '_' and '.'", option,
        text)};
  }
  return std::pair(name, text.substr(equals + 1));
}

Status addVariant(BenchPlan& plan, BenchVariant variant) {
  for (const BenchVariant& other : plan.variants) {
    if (other.method.name == variant.method.name) {
      return Error{fmt::format("bench: two methods are named '{}'", variant.method.name)};
    }
  }
  plan.variants.push_back(std::move(variant));
  return {};
}

Status addKnown(const PaperBenchOptions& options, BenchPlan& plan) {
  std::vector<std::string> wanted = split(options.methods, ',');
  std::string known;
  for (const BenchVariant& variant : knownVariants()) {
    known += (known.empty() ? "" : ", ") + variant.method.name;
    const auto at = std::find(wanted.begin(), wanted.end(), variant.method.name);
    if (at == wanted.end()) continue;
    wanted.erase(at);
    plan.variants.push_back(variant);
    auto& settings = plan.variants.back().settings;
    settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  }
  if (wanted.empty()) return {};
  return Error{
      fmt::format("bench: --methods: '{}' is unknown or twice; known are {}", wanted[0], known)};
}

Status addOwn(const PaperBenchOptions& options, BenchPlan& plan) {
  for (const std::string& text : options.variants) {
    const auto pair = named("--variant", text);
    if (!pair) return pair.error();
    const std::vector<std::string> parts = split(pair->second, ',');
    if (parts.empty()) {
      return Error{fmt::format("bench: --variant {}: expected NAME=METHOD,option=value,...", text)};
    }
    // As 'parkade run' does where no cameras are named.
    const int cameras = parts[0] == kOneCameraMethod ? 1 : 0;
    BenchVariant variant{
        {pair->first, pair->first, false, true}, parts[0], cameras, options.settings, ""};
    variant.settings.insert(variant.settings.end(), parts.begin() + 1, parts.end());
    if (Status added = addVariant(plan, std::move(variant)); !added) return added;
  }
  if (!options.cameras.empty()) {
    int first = 0;
    int last = 0;
    int read = 0;
    if (std::sscanf(options.cameras.c_str(), "%d..%d%n", &first, &last, &read) != 2 ||
        read != static_cast<int>(options.cameras.size()) || first < 1 || last < first ||
        last > 16) {
      return Error{
          fmt::format("bench: --cameras {}: expected FIRST..LAST, as 1..6", options.cameras)};
    }
    for (int count = first; count <= last; ++count) {
      BenchVariant variant{
          {fmt::format("vis-{}cam", count),
           fmt::format("vis, {} camera{}", count, count > 1 ? "s" : ""), false, true},
          "vis",
          count,
          options.settings,
          ""};
      if (Status added = addVariant(plan, std::move(variant)); !added) return added;
    }
  }
  for (const std::string& text : options.imports) {
    const auto pair = named("--import", text);
    if (!pair) return pair.error();
    BenchVariant variant{
        {pair->first, pair->first + " (imported)", true, false}, "", 0, {}, pair->second};
    if (Status added = addVariant(plan, std::move(variant)); !added) return added;
  }
  return {};
}

// What a run would refuse, before anything is drawn.
Status checkVariants(const BenchPlan& plan) {
  for (const BenchVariant& variant : plan.variants) {
    const std::string& name = variant.method.name;
    if (!variant.import_folder.empty()) {
      std::error_code code;
      if (std::filesystem::is_directory(variant.import_folder, code)) continue;
      return Error{
          fmt::format("bench: --import {}={}: no such folder", name, variant.import_folder)};
    }
    if (std::find(kRunMethods.begin(), kRunMethods.end(), variant.run_method) ==
        kRunMethods.end()) {
      return Error{fmt::format("bench: --variant {}={}: no such method; known are {}", name,
                               variant.run_method, fmt::join(kRunMethods, ", "))};
    }
    PipelineOptions options;
    for (const std::string& setting : variant.settings) {
      const Status set = setOption(asOptions(options), setting);
      if (!set) return Error{fmt::format("bench: {}: {}", name, set.error().message)};
    }
  }
  return {};
}

// Drives of one garage and route under every condition, with every seed.
Status addDrives(const PaperBenchOptions& options, const BenchDrive& base, BenchPlan& plan) {
  std::vector<BenchDrive> kinds{base};
  if (Status added = addConditions(options, base, kinds); !added) return added;
  for (const BenchDrive& kind : kinds) {
    for (int k = 0; k < options.seeds; ++k) {
      BenchDrive drive = kind;
      drive.spec.seed += k;
      const std::string which = k > 0 ? fmt::format("_seed{}", drive.spec.seed) : "";
      drive.name += which;
      if (!drive.pictures_of.empty()) drive.pictures_of += which;
      drive.spec.fast = options.fast || options.quick;
      drive.spec.duration = options.duration_s;
      drive.spec.threads = options.threads;
      plan.drives.push_back(std::move(drive));
    }
  }
  return {};
}

Status addPaperGarage(const PaperBenchOptions& options, BenchPlan& plan) {
  for (const std::string& route : split(options.routes, ',')) {
    const Result<sim::SimSpec> spec = sim::defaultSpec("paper", route);
    if (!spec) return spec.error();
    const Status added = addDrives(options, {route, "paper", route, "", *spec, ""}, plan);
    if (!added) return added;
  }
  return {};
}

Status addRandomGarages(const PaperBenchOptions& options, BenchPlan& plan) {
  const Result<std::vector<int>> seeds = parseGarages(options.garages);
  if (!seeds) return seeds.error();
  for (const int seed : *seeds) {
    Result<sim::SimSpec> spec = sim::defaultSpec("random", "random");
    if (!spec) return spec.error();
    spec->garage_seed = seed;
    const Status added = addDrives(
        options,
        {fmt::format("random_{}", seed), fmt::format("random {}", seed), "random", "", *spec, ""},
        plan);
    if (!added) return added;
  }
  return {};
}

}  // namespace

Result<BenchPlan> planBench(const PaperBenchOptions& options) {
  BenchPlan plan;
  Status status = addKnown(options, plan);
  if (status) status = addOwn(options, plan);
  if (status) status = checkVariants(plan);
  if (status) {
    status = options.garages == "paper" ? addPaperGarage(options, plan)
                                        : addRandomGarages(options, plan);
  }
  if (!status) return status.error();
  if (plan.drives.empty() || plan.variants.empty()) {
    return Error{"bench: nothing to do: name at least one route and one method"};
  }
  return plan;
}

std::string pickCameras(const std::vector<std::string>& names, int count) {
  if (count <= 0 || count >= static_cast<int>(names.size())) return "";
  std::string text;
  for (int i = 0; i < count; ++i) {
    const std::size_t at =
        static_cast<std::size_t>(i) * names.size() / static_cast<std::size_t>(count);
    text += (i > 0 ? "," : "") + names[at];
  }
  return text;
}

std::string camerasOption(const BenchVariant& variant, const std::vector<std::string>& names) {
  std::string picked = pickCameras(names, variant.cameras);
  if (!picked.empty() || variant.run_method != kOneCameraMethod) return picked;
  return fmt::format("{}", fmt::join(names, ","));
}

std::string settingText(const PaperBenchOptions& options, const BenchPlan& plan,
                        const std::vector<std::string>& given) {
  const char* samples = options.fast || options.quick ? "one sample" : "2 x 2 samples";
  const bool all_given = given.size() >= plan.drives.size();
  std::string text = fmt::format("Simulated garage(s): {}; ", options.garages);
  if (given.empty()) text += fmt::format("{} a pixel, ", samples);
  text += fmt::format("{} threads, parkade {}.", options.threads, PARKADE_VERSION);
  if (!given.empty()) {
    text += fmt::format(" Recordings in {} were used as they are for {}.", options.sequences,
                        fmt::join(given, ", "));
    if (!all_given) text += fmt::format(" Others were drawn with {} a pixel.", samples);
  }
  if (options.duration_s > 0.0 && !all_given) {
    text += fmt::format(" {} was cut after {:g} s: not the paper's whole routes.",
                        given.empty() ? "Every drive" : "Each of these", options.duration_s);
  }
  return text;
}

}  // namespace parkade::cli
