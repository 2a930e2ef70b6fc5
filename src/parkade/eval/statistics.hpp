// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace parkade {

/// Describes a list of errors; all but count are NaN where the list is empty.
struct Statistics {
  std::size_t count = 0;
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< sqrt(mean of the squares)
  double mean = std::numeric_limits<double>::quiet_NaN();
  double median = std::numeric_limits<double>::quiet_NaN();  ///< the 0.5 quantile
  double std = std::numeric_limits<double>::quiet_NaN();     ///< of the list itself (divides by n)
  double min = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();  ///< the 0.95 quantile
  double max = std::numeric_limits<double>::quiet_NaN();
};

Statistics describe(const std::vector<double>& values);

/// The p quantile (0 to 1), linear between the two nearest of the sorted values; NaN if empty.
double quantile(std::vector<double> values, double p);

}  // namespace parkade
