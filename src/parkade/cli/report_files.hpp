// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/eval/svg.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade::cli {

// A run's files as its report reads them: what is missing or broken is empty.

std::string reportText(const std::string& path);
/// An object, empty where the file has none.
nlohmann::ordered_json reportJson(const std::string& path);
/// A picture as the bytes of a PNG, to stand in a page.
std::string reportPng(const Result<cv::Mat>& picture);
/// Not a number where there is none.
double reportNumber(const nlohmann::ordered_json& json, const std::string& pointer);

/// Positions on the ground.
svg::Points groundPoints(const Trajectory& poses);

/// Columns of health.csv over the time from its first row.
class HealthTable {
 public:
  explicit HealthTable(const std::string& path);
  /// Only rows with a pose.
  [[nodiscard]] svg::Points over(const std::string& column) const;

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace parkade::cli
