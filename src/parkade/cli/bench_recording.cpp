// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/bench_recording.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "parkade/camera/rig.hpp"
#include "parkade/cli/sim_record.hpp"
#include "parkade/cli/sim_truth.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/sequence_writer.hpp"

namespace parkade::cli {
namespace {

namespace fs = std::filesystem;

bool isWhole(const std::string& folder) {
  return inspectSequence(folder).finished;
}

bool isOf(const sim::SimSpec& spec, const std::string& folder) {
  const Result<std::string> text = readFile(joinPath(folder, "spec.yaml"));
  return text && *text == specText(spec);
}

// The same files, pictures by link; without what tells the true rig beside rig.yaml.
void mirror(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const fs::directory_entry& entry : fs::directory_iterator(from)) {
    const fs::path target = to / entry.path().filename();
    if (entry.is_directory() && entry.path().filename() == "data") {
      fs::create_directory_symlink(fs::canonical(entry.path()), target);
    } else if (entry.is_directory()) {
      mirror(entry.path(), target);
    } else if (from.filename().string().rfind("cam", 0) != 0 ||
               entry.path().filename() != "sensor.yaml") {
      fs::copy_file(entry.path(), target);
    }
  }
}

Status tellRig(const sim::Simulation& simulation, const std::string& folder) {
  const std::string path = joinPath(folder, "rig.yaml");
  Result<Rig> rig = readRig(path);  // with its masks
  if (!rig) return rig.error();
  for (RigCamera& camera : rig->cameras) {
    for (const RigCamera& told : simulation.toldRig().cameras) {
      if (told.name == camera.name) camera.T_vehicle_cam = told.T_vehicle_cam;
    }
  }
  if (Status written = writeRig(*rig, path); !written) return written;
  return writeFileAtomic(joinPath(folder, "spec.yaml"), specText(simulation.spec()));
}

Status retell(const std::string& drawn, const sim::Simulation& simulation,
              const std::string& folder) {
  // Under another name until it is whole.
  const std::string part = folder + ".part";
  try {
    fs::remove_all(part);
    fs::remove_all(folder);
    mirror(drawn, part);
    if (Status told = tellRig(simulation, part); !told) return told;
    fs::rename(part, folder);
  } catch (const fs::filesystem_error& error) {
    return Error{fmt::format("bench: {}: {}", folder, error.what())};
  }
  return {};
}

bool isGiven(const PaperBenchOptions& options, const std::string& name) {
  return !options.sequences.empty() && isWhole(joinPath(options.sequences, name));
}

}  // namespace

std::vector<std::string> givenDrives(const PaperBenchOptions& options, const BenchPlan& plan) {
  std::vector<std::string> names;
  for (const BenchDrive& drive : plan.drives) {
    const bool retold = !drive.pictures_of.empty() && isGiven(options, drive.pictures_of);
    if (retold || isGiven(options, drive.name)) names.push_back(drive.name);
  }
  return names;
}

Result<std::string> provideSequence(const PaperBenchOptions& options, const BenchDrive& drive) {
  if (isGiven(options, drive.name)) return joinPath(options.sequences, drive.name);
  const std::string folder = joinPath(joinPath(options.out, "sequences"), drive.name);
  const bool same = isOf(drive.spec, folder);
  if (same && isWhole(folder)) return folder;
  const auto simulation = sim::Simulation::make(drive.spec);
  if (!simulation) return simulation.error();
  if (!drive.pictures_of.empty()) {
    BenchDrive drawn = drive;
    drawn.name = drive.pictures_of;
    drawn.pictures_of.clear();
    drawn.spec.calib_error_deg = drawn.spec.calib_error_cm = 0.0;
    const Result<std::string> pictures = provideSequence(options, drawn);
    if (!pictures) return pictures.error();
    if (Status told = retell(*pictures, **simulation, folder); !told) return told.error();
    return folder;
  }
  RecordOptions record;
  record.out = folder;
  record.resume = same;
  record.force = !same;
  const Status recorded = recordSequence(*simulation, record);
  if (!recorded) return recorded.error();
  return folder;
}

}  // namespace parkade::cli
