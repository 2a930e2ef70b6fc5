// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <map>
#include <string>

#include "parkade/types/text_format.hpp"

namespace parkade {

/// Which of several readings of a text is right: the one with the most weight.
class Votes {
 public:
  void add(const std::string& text, double weight) {
    if (!text.empty()) weights_[text] += weight;
  }
  void add(const Votes& other) {
    for (const auto& [text, weight] : other.weights_) weights_[text] += weight;
  }
  /// Empty where nothing was read.
  [[nodiscard]] std::string best() const {
    std::string text;
    double most = 0.0;
    for (const auto& [candidate, weight] : weights_) {
      if (weight <= most) continue;
      most = weight;
      text = candidate;
    }
    return text;
  }
  /// The same of a zone marker's text, where others tell how such texts are made up: what is called
  /// otherwise than they are gives way to any other, and is not told.
  [[nodiscard]] std::string best(const TextFormat& format) const {
    Votes fitting;
    for (const auto& [candidate, weight] : weights_) {
      if (!format.isStray(candidate)) fitting.add(candidate, weight);
    }
    return fitting.best();
  }

 private:
  std::map<std::string, double> weights_;
};

/// Gate for a squared Mahalanobis distance of 4 degrees of freedom: 1 - exp(-x/2) (1 + x/2) = p,
/// solved by Newton's method.
inline double chiSquareGate4(double probability) {
  double x = 8.0;
  for (int i = 0; i < 60; ++i) {
    const double value = 1.0 - std::exp(-0.5 * x) * (1.0 + 0.5 * x) - probability;
    const double slope = 0.25 * x * std::exp(-0.5 * x);
    const double next = x - value / slope;
    x = next > 0.0 ? next : 0.5 * x;
    if (std::abs(value) < 1e-14) break;
  }
  return x;
}

}  // namespace parkade
