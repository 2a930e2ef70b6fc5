// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/statistics.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

double quantileOfSorted(const std::vector<double>& sorted, double p) {
  const double position = p * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

Statistics describe(const std::vector<double>& values) {
  Statistics s;
  s.count = values.size();
  if (values.empty()) return s;
  const double n = static_cast<double>(values.size());
  double sum = 0.0;
  double sum_of_squares = 0.0;
  for (const double value : values) {
    sum += value;
    sum_of_squares += value * value;
  }
  s.mean = sum / n;
  s.rmse = std::sqrt(sum_of_squares / n);
  double sum_of_deviations = 0.0;
  for (const double value : values) sum_of_deviations += (value - s.mean) * (value - s.mean);
  s.std = std::sqrt(sum_of_deviations / n);
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  s.min = sorted.front();
  s.max = sorted.back();
  s.median = quantileOfSorted(sorted, 0.5);
  s.p95 = quantileOfSorted(sorted, 0.95);
  return s;
}

double quantile(std::vector<double> values, double p) {
  PARKADE_CHECK(p >= 0.0 && p <= 1.0, "p = {}", p);
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return quantileOfSorted(values, p);
}

}  // namespace parkade
