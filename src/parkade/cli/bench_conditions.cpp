// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_conditions.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "parkade/core/split.hpp"

namespace parkade::cli {
namespace {

Result<double> number(const std::string& option, const std::string& text) {
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size()) {
    return Error{
        fmt::format("bench: {}: expected numbers with commas between, found '{}'", option, text)};
  }
  return value;
}

// Values of one swept condition: how each changes a drive and what it is then called.
Status sweep(const std::string& option, const std::string& values, const BenchDrive& base,
             const std::function<Status(double value, BenchDrive& drive)>& change,
             std::vector<BenchDrive>& kinds) {
  for (const std::string& text : split(values, ',')) {
    const Result<double> value = number(option, text);
    if (!value) return value.error();
    BenchDrive drive = base;
    if (Status changed = change(*value, drive); !changed) return changed;
    kinds.push_back(std::move(drive));
  }
  return {};
}

// "A:B" as two numbers that are not negative; "A" alone as A and A where one will do.
std::optional<std::pair<double, double>> pairOf(const std::string& text, bool one_will_do) {
  const std::vector<std::string> parts = split(text, ':');
  if (parts.size() == 2 || (one_will_do && parts.size() == 1)) {
    const Result<double> first = number("", parts.front());
    const Result<double> second = number("", parts.back());
    if (first && second && *first >= 0.0 && *second >= 0.0) return std::pair(*first, *second);
  }
  return std::nullopt;
}

Status sweepAgents(const std::string& values, const BenchDrive& base,
                   std::vector<BenchDrive>& kinds) {
  for (const std::string& text : split(values, ',')) {
    const auto pair = pairOf(text, false);
    constexpr double kMost = 50.0;
    const auto countable = [](double n) { return n <= kMost && n == std::floor(n); };
    if (!pair || !countable(pair->first) || !countable(pair->second)) {
      return Error{fmt::format(
          "bench: --agents: expected CARS:PEOPLE with commas between, as 0:0,6:8, found '{}'",
          text)};
    }
    const auto [cars, people] = *pair;
    BenchDrive drive = base;
    drive.spec.cars = static_cast<int>(cars);
    drive.spec.people = static_cast<int>(people);
    drive.condition = fmt::format("{:g} cars, {:g} people", cars, people);
    drive.name += fmt::format("_agents{:g}-{:g}", cars, people);
    kinds.push_back(std::move(drive));
  }
  return {};
}

Status sweepCalibration(const std::string& values, const BenchDrive& base,
                        std::vector<BenchDrive>& kinds) {
  for (const std::string& text : split(values, ',')) {
    const auto pair = pairOf(text, true);
    if (!pair) {
      return Error{fmt::format(
          "bench: --calib-error: expected DEG:CM with commas between, as 0.1:1,0.3:1, found '{}'",
          text)};
    }
    const auto [degrees, centimetres] = *pair;
    BenchDrive drive = base;
    drive.spec.calib_error_deg = degrees;
    drive.spec.calib_error_cm = centimetres;
    drive.condition = fmt::format("calibration off by {:g} deg, {:g} cm", degrees, centimetres);
    drive.name += fmt::format("_calib{:g}", degrees);
    if (centimetres != degrees) drive.name += fmt::format("-{:g}", centimetres);
    drive.pictures_of = base.name;
    kinds.push_back(std::move(drive));
  }
  return {};
}

}  // namespace

Status addConditions(const PaperBenchOptions& options, const BenchDrive& base,
                     std::vector<BenchDrive>& kinds) {
  Status status = sweep(
      "--light", options.light, base,
      [](double lux, BenchDrive& drive) -> Status {
        if (!(lux >= 1.0 && lux <= 5000.0)) {
          return Error{fmt::format("bench: --light {:g}: lights lie between 1 and 5000 lux", lux)};
        }
        drive.spec.lux = lux;
        drive.condition = fmt::format("{:g} lux", lux);
        drive.name += fmt::format("_lux{:g}", lux);
        return {};
      },
      kinds);
  if (!status) return status;
  status = sweep(
      "--occupancy", options.occupancy, base,
      [](double share, BenchDrive& drive) -> Status {
        if (share < 0.0 || share > 1.0) {
          return Error{fmt::format("bench: --occupancy {:g}: a share lies between 0 and 1", share)};
        }
        drive.spec.occupancy = share;
        drive.condition = fmt::format("{:g} % taken", 100.0 * share);
        drive.name += fmt::format("_taken{:g}", share);
        return {};
      },
      kinds);
  if (status) status = sweepAgents(options.agents, base, kinds);
  if (!status) return status;
  return sweepCalibration(options.calib_error, base, kinds);
}

}  // namespace parkade::cli
