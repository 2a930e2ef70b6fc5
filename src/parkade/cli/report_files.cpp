// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/report_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"

namespace parkade::cli {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> parts;
  std::stringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

}  // namespace

std::string reportText(const std::string& path) {
  const Result<std::string> text = readFile(path);
  return text ? *text : "";
}

Json reportJson(const std::string& path) {
  Json json = Json::parse(reportText(path), nullptr, false);
  return json.is_object() ? json : Json::object();
}

std::string reportPng(const Result<cv::Mat>& picture) {
  if (!picture) return "";
  ImageEncoding png;
  png.png = true;
  png.png_level = 9;
  const Result<std::string> bytes = encodeImage(*picture, png);
  return bytes ? *bytes : "";
}

double reportNumber(const Json& json, const std::string& pointer) {
  const Json::json_pointer at(pointer);
  return json.contains(at) && json[at].is_number() ? json[at].get<double>() : std::nan("");
}

svg::Points groundPoints(const Trajectory& poses) {
  svg::Points points;
  for (const StampedPose& pose : poses) {
    points.emplace_back(pose.T_world_body.translation().head<2>());
  }
  return points;
}

HealthTable::HealthTable(const std::string& path) {
  std::stringstream lines(reportText(path));
  std::string line;
  if (std::getline(lines, line)) header_ = cellsOf(line);
  while (std::getline(lines, line)) {
    const std::vector<std::string> row = cellsOf(line);
    if (row.size() == header_.size()) rows_.push_back(row);
  }
}

svg::Points HealthTable::over(const std::string& column) const {
  svg::Points points;
  const auto at = std::find(header_.begin(), header_.end(), column);
  if (at == header_.end()) return points;
  const std::size_t index = static_cast<std::size_t>(at - header_.begin());
  for (const auto& row : rows_) {
    if (row[1] == "initialising") continue;
    const double t = std::strtod(row[0].c_str(), nullptr);
    const double start = std::strtod(rows_.front()[0].c_str(), nullptr);
    points.emplace_back(t - start, std::strtod(row[index].c_str(), nullptr));
  }
  return points;
}

}  // namespace parkade::cli
