// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/semantic_garages.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <numeric>
#include <variant>

#include "parkade/camera/rig.hpp"
#include "parkade/core/random.hpp"
#include "parkade/io/file.hpp"
#include "parkade/sim/drive/rig_presets.hpp"

namespace parkade::cli {
namespace {

bool readNumber(const std::string& text, int& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size() && value >= 0;
}

// Every camera of a preset turned, moved and refocused a little: another car's rig.
void varyRig(Random random, Rig& rig) {
  constexpr double kTurn = 2.0 * M_PI / 180.0;  // rad, standard deviation about each axis
  constexpr double kStep = 0.05;                // m
  constexpr double kFocal = 0.05;
  const double raised = random.normal(0.0, 0.06);
  for (RigCamera& camera : rig.cameras) {
    const Eigen::Vector3d turn(random.normal(0.0, kTurn), random.normal(0.0, kTurn),
                               random.normal(0.0, kTurn));
    Eigen::Vector3d place = camera.T_vehicle_cam.translation();
    // Along the body and in height; sideways would put a camera into the body.
    place += Eigen::Vector3d(0.0, 0.0, raised + random.normal(0.0, kStep));
    camera.T_vehicle_cam = SE3(camera.T_vehicle_cam.rotation() * SO3::exp(turn), place);
    const double focal = 1.0 + std::clamp(random.normal(0.0, kFocal), -0.12, 0.12);
    if (const auto* fisheye = std::get_if<PinholeEquidistant>(&camera.camera.model())) {
      PinholeEquidistant::Parameters parameters = fisheye->parameters();
      parameters.fx *= focal;
      parameters.fy *= focal;
      camera.camera =
          Camera(PinholeEquidistant(parameters), camera.camera.width(), camera.camera.height());
    }
  }
}

}  // namespace

Result<std::vector<int>> parseGarages(const std::string& text) {
  const std::string kPrefix = "random:";
  constexpr int kMostGarages = 100'000;
  constexpr int kLastSeed = 1'000'000'000;  // SimSpec's
  const Error wrong{
      fmt::format("--garages {}: expected random:N, or random:FIRST-LAST with garage seeds", text)};
  const Error too_many{fmt::format("--garages {}: at most {} garages, with seeds to {}", text,
                                   kMostGarages, kLastSeed)};
  if (text.rfind(kPrefix, 0) != 0) return wrong;
  const std::string rest = text.substr(kPrefix.size());
  const std::size_t dash = rest.find('-');
  int first = kFirstTestSeed;
  int count = 0;
  if (dash == std::string::npos) {
    if (!readNumber(rest, count) || count < 1) return wrong;
  } else {
    int last = 0;
    if (!readNumber(rest.substr(0, dash), first) || !readNumber(rest.substr(dash + 1), last) ||
        last < first) {
      return wrong;
    }
    if (last > kLastSeed) return too_many;
    count = last - first + 1;
  }
  if (count > kMostGarages) return too_many;
  std::vector<int> seeds(static_cast<std::size_t>(count));
  std::iota(seeds.begin(), seeds.end(), first);
  return seeds;
}

Result<sim::SimSpec> drawConditions(int garage_seed, const std::string& folder) {
  Result<sim::SimSpec> spec = sim::defaultSpec("random", "random");
  if (!spec) return spec.error();
  const Random source(static_cast<std::uint64_t>(garage_seed));
  Random random = source.fork("semantic conditions");
  spec->garage_seed = garage_seed;
  spec->seed = garage_seed + 1;
  spec->lux = std::pow(10.0, random.uniform(1.0, 3.0));
  spec->occupancy = random.uniform(0.2, 0.95);
  spec->cars = random.integer(0, 5);
  spec->people = random.integer(2, 12);
  Result<Rig> rig = sim::loadRig(random.chance(0.7) ? "avp6" : "avm4");
  if (!rig) return rig.error();
  varyRig(source.fork("rig"), *rig);
  const std::string rigs = joinPath(folder, "rigs");
  Status status = makeFolders(rigs);
  spec->rig = joinPath(rigs, fmt::format("{}.yaml", garage_seed));
  if (status) status = writeRig(*rig, spec->rig);
  if (!status) return status.error();
  return spec;
}

}  // namespace parkade::cli
