// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "parkade/eval/charts.hpp"
#include "parkade/eval/html_page.hpp"
#include "parkade/mapping/parking_map.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade::cli {

/// A run's folder as the figures of a page need it. What a figure lacks is said in a line in its
/// place.
struct ReportedRun {
  std::string folder;
  std::string method;
  Trajectory way;                 ///< as known at each instant
  std::optional<ParkingMap> map;  ///< where the run made one
};

/// Reads the folder; an empty way where it has no trajectory.
ReportedRun readReportedRun(const std::string& folder);

/// The way on the map, and the slots with their numbers or ids and their state.
void addMapFigures(const ReportedRun& run, HtmlPage& page);
/// Each layer alone (the paper's Fig. 6).
void addLayerFigures(const ReportedRun& run, HtmlPage& page);
/// The map around the car half way, and where that lies in the whole one (the paper's Fig. 7).
void addLocalMapFigures(const ReportedRun& run, HtmlPage& page);
/// Tracks on the cameras' pictures, the stitched one without and with features (the paper's Figs. 3
/// to 5).
void addCameraFigures(const ReportedRun& run, HtmlPage& page);

}  // namespace parkade::cli
