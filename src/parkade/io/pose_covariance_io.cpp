// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/pose_covariance_io.hpp"

#include <fmt/core.h>

#include <array>

#include "parkade/io/csv.hpp"
#include "parkade/io/file.hpp"

namespace parkade {
namespace {

constexpr std::array<const char*, 6> kNames = {"x", "y", "z", "rx", "ry", "rz"};
constexpr std::size_t kColumns = 22;

PoseCovariances readRows(CsvReader& csv) {
  PoseCovariances rows;
  while (csv.nextRow()) {
    if (csv.count() != kColumns) {
      csv.fail(fmt::format("{} columns: expected the stamp and the 21 numbers of the covariance",
                           csv.count()));
    }
    StampedPoseCovariance row;
    row.t_ns = csv.nanoseconds(0, "t [ns]");
    if (!rows.empty() && row.t_ns <= rows.back().t_ns) {
      csv.fail(0, "t [ns]", "stamps must increase");
    }
    std::size_t column = 1;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j, ++column) {
        row.covariance(i, j) = row.covariance(j, i) = csv.number(column, "covariance");
      }
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

Status writePoseCovariances(const std::string& path, const PoseCovariances& covariances) {
  std::string text = "#t [ns]";
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = i; j < 6; ++j) text += fmt::format(",{}*{}", kNames[i], kNames[j]);
  }
  text += "\n";
  for (const StampedPoseCovariance& row : covariances) {
    text += std::to_string(row.t_ns);
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) text += fmt::format(",{:.9g}", row.covariance(i, j));
    }
    text += "\n";
  }
  return writeFileAtomic(path, text);
}

Result<PoseCovariances> readPoseCovariances(const std::string& path) {
  return parseCsvFile<PoseCovariances>(path, CsvReader::Separator::kComma, readRows);
}

}  // namespace parkade
