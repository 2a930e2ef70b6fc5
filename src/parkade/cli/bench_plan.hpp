// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/eval/bench_tables.hpp"
#include "parkade/sim/drive/spec.hpp"

namespace parkade::cli {

/// What the user asks of 'parkade bench'.
struct PaperBenchOptions {
  std::string out;
  std::string garages = "paper";
  std::string routes = "test1,test2,test3,test4,test5";
  std::string methods = "vis,vis1,semantic,avp-slam,fused";
  std::string sequences;              ///< folder with recordings to use; empty: OUT/sequences
  std::vector<std::string> imports;   ///< NAME=DIR with DIR/ROUTE.tum
  std::vector<std::string> variants;  ///< NAME=METHOD,option=value,...
  std::vector<std::string> settings;  ///< option=value for every method
  std::string light;                  ///< lux, with commas
  std::string occupancy;              ///< shares, with commas
  std::string agents;                 ///< CARS:PEOPLE, with commas
  std::string calib_error;            ///< DEG:CM, with commas; DEG alone: as many centimetres
  std::string cameras;                ///< "1..6"
  int seeds = 1;
  double duration_s = 0.0;
  bool fast = false;
  bool quick = false;
  bool again = false;
  int threads = 2;
};

/// One drive: a recording and what it is called.
struct BenchDrive {
  std::string name;  ///< of its folder, and of DIR/NAME.tum of imports: "test1", "random_5000"
  std::string garage;
  std::string route;
  std::string condition;
  sim::SimSpec spec;
  std::string pictures_of;  ///< the drive that it differs from by the rig told alone; or empty
};

/// One way to work on it: a method with its options, or trajectories made elsewhere.
struct BenchVariant {
  BenchMethod method;
  std::string run_method;             ///< of 'parkade run'; empty: imported
  int cameras = 0;                    ///< so many, evenly around; 0: all of the rig
  std::vector<std::string> settings;  ///< of --set
  std::string import_folder;
};

struct BenchPlan {
  std::vector<BenchDrive> drives;
  std::vector<BenchVariant> variants;
};

/// All drives and variants. Fails, and names the option, on what cannot be.
Result<BenchPlan> planBench(const PaperBenchOptions& options);

/// So many of the cameras, evenly spread over their order (rigs list them around the car, from the
/// front), as --cameras takes them; empty for 0.
std::string pickCameras(const std::vector<std::string>& names, int count);

/// What a variant's run is told with --cameras; empty where nothing, which stands for all, though
/// not for the method semantic.
std::string camerasOption(const BenchVariant& variant, const std::vector<std::string>& names);

/// What the tables were made with, for their reader; given: drives whose recordings were there, for
/// which how others were drawn says nothing.
std::string settingText(const PaperBenchOptions& options, const BenchPlan& plan,
                        const std::vector<std::string>& given);

}  // namespace parkade::cli
