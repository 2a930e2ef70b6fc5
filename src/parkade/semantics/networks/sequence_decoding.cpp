// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/sequence_decoding.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

/// Probability of a prefix, by whether the last step was blank.
struct Prefix {
  double blank = 0.0;
  double letter = 0.0;
  [[nodiscard]] double total() const { return blank + letter; }
};

std::vector<double> softmaxOf(const cv::Mat& logits, int step) {
  std::vector<double> p(static_cast<std::size_t>(logits.rows));
  double most = logits.at<float>(0, step);
  for (int c = 1; c < logits.rows; ++c) most = std::max<double>(most, logits.at<float>(c, step));
  double sum = 0.0;
  for (int c = 0; c < logits.rows; ++c) {
    p[static_cast<std::size_t>(c)] = std::exp(logits.at<float>(c, step) - most);
    sum += p[static_cast<std::size_t>(c)];
  }
  for (double& value : p) value /= sum;
  return p;
}

using Beam = std::map<std::string, Prefix>;

// The best prefixes; of equal ones the first in the alphabet's order.
Beam best(const Beam& all, int count) {
  std::vector<std::pair<double, const Beam::value_type*>> order;
  for (const auto& entry : all) order.emplace_back(entry.second.total(), &entry);
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  Beam kept;
  for (std::size_t i = 0; i < order.size() && i < static_cast<std::size_t>(count); ++i) {
    kept.insert(*order[i].second);
  }
  return kept;
}

}  // namespace

std::vector<TextReading> decodeSequence(const cv::Mat& logits, const std::string& alphabet,
                                        int beam, int count) {
  PARKADE_CHECK(logits.type() == CV_32F && logits.rows == static_cast<int>(alphabet.size()) + 1,
                "{} rows of logits for an alphabet of {} letters", logits.rows, alphabet.size());
  constexpr double kNegligible = 1e-4;  // letters less probable than this open no branch
  Beam prefixes = {{"", {1.0, 0.0}}};
  for (int step = 0; step < logits.cols; ++step) {
    const std::vector<double> p = softmaxOf(logits, step);
    Beam next;
    for (const auto& [text, now] : prefixes) {
      Prefix& same = next[text];
      same.blank += now.total() * p[0];
      for (std::size_t c = 0; c < alphabet.size(); ++c) {
        const bool again = !text.empty() && text.back() == alphabet[c];
        // A repeated letter without a blank between is the same one, drawn out.
        if (again) next[text].letter += now.letter * p[c + 1];
        if (p[c + 1] < kNegligible) continue;
        next[text + alphabet[c]].letter += (again ? now.blank : now.total()) * p[c + 1];
      }
    }
    prefixes = best(next, beam);
  }
  std::vector<TextReading> readings;
  for (const auto& [text, prefix] : prefixes) readings.push_back({text, prefix.total()});
  std::stable_sort(
      readings.begin(), readings.end(),
      [](const TextReading& a, const TextReading& b) { return a.probability > b.probability; });
  readings.resize(std::min(readings.size(), static_cast<std::size_t>(count)));
  return readings;
}

}  // namespace parkade
