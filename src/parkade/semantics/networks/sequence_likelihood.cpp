// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/sequence_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

/// Probability of a prefix, by whether the last step was blank.
struct Prefix {
  double blank = 0.0;
  double letter = 0.0;
  [[nodiscard]] double total() const { return blank + letter; }
};

using Beam = std::map<std::string, Prefix>;

// The best prefixes; of equal ones the first in the alphabet's order.
Beam bestOf(const Beam& all, int count) {
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

/// A prefix of the beam with one letter more.
struct Longer {
  double probability = 0.0;
  const std::string* from = nullptr;
  char letter = 0;
  // Of equal ones the first in the alphabet's order.
  bool operator<(const Longer& other) const {
    if (probability != other.probability) return probability > other.probability;
    return std::tie(*from, letter) < std::tie(*other.from, other.letter);
  }
};

// Adds it to the text that the beam holds already; false where that is none.
bool addTo(const Beam& prefixes, const Longer& longer, Beam& next) {
  for (const auto& [text, now] : prefixes) {
    if (text.size() != longer.from->size() + 1 || text.back() != longer.letter ||
        !text.starts_with(*longer.from)) {
      continue;
    }
    next[text].letter += longer.probability;
    return true;
  }
  return false;
}

bool isAny(char c) {
  return c == kAnyCapital || c == kAnyDigit;
}

}  // namespace

SequenceLikelihood::SequenceLikelihood(const cv::Mat& logits, std::string alphabet)
    : alphabet_(std::move(alphabet)) {
  const int channels = static_cast<int>(alphabet_.size()) + 1;
  PARKADE_CHECK(logits.type() == CV_32F && logits.rows == channels,
                "{} rows of logits for an alphabet of {} letters", logits.rows, alphabet_.size());
  p_ = cv::Mat(logits.cols, channels + 2, CV_64F, cv::Scalar(0.0));
  for (int step = 0; step < logits.cols; ++step) {
    auto* const p = p_.ptr<double>(step);
    double most = logits.at<float>(0, step);
    for (int c = 1; c < channels; ++c) most = std::max<double>(most, logits.at<float>(c, step));
    double sum = 0.0;
    for (int c = 0; c < channels; ++c) sum += p[c] = std::exp(logits.at<float>(c, step) - most);
    for (int c = 0; c < channels; ++c) {
      p[c] /= sum;
      if (c == 0) continue;
      const char letter = alphabet_[static_cast<std::size_t>(c - 1)];
      if (letter >= 'A' && letter <= 'Z') p[channels] += p[c];
      if (letter >= '0' && letter <= '9') p[channels + 1] += p[c];
    }
  }
}

int SequenceLikelihood::channelOf(char c) const {
  if (isAny(c)) return p_.cols - (c == kAnyCapital ? 2 : 1);
  const std::size_t at = alphabet_.find(c);
  return at == std::string::npos ? -1 : static_cast<int>(at) + 1;
}

std::vector<double> SequenceLikelihood::ofPrefixes(const std::string& pattern) const {
  const std::size_t length = pattern.size();
  std::vector<int> channels(length);
  std::vector<double> skips(length, 0.0);  // 1: may follow the one before without a blank between
  for (std::size_t m = 0; m < length; ++m) {
    channels[m] = channelOf(pattern[m]);
    if (m > 0 && (isAny(pattern[m]) || pattern[m] != pattern[m - 1])) skips[m] = 1.0;
  }
  // Probability of m characters, by whether the last step was blank or the last of them.
  std::vector<double> blank(length + 1, 0.0);
  std::vector<double> letter(length + 1, 0.0);
  blank[0] = 1.0;
  for (int step = 0; step < p_.rows; ++step) {
    const auto* const p = p_.ptr<double>(step);
    for (std::size_t m = length; m > 0; --m) {
      const int channel = channels[m - 1];
      blank[m] = (blank[m] + letter[m]) * p[0];
      letter[m] = (letter[m] + blank[m - 1] + skips[m - 1] * letter[m - 1]) *
                  (channel < 0 ? 0.0 : p[channel]);
    }
    blank[0] *= p[0];
  }
  for (std::size_t m = 0; m <= length; ++m) blank[m] += letter[m];
  return blank;
}

std::vector<TextReading> SequenceLikelihood::best(int beam, int count) const {
  constexpr double kNegligible = 1e-3;  // letters less probable than this open no branch
  Beam prefixes = {{"", {1.0, 0.0}}};
  for (int step = 0; step < p_.rows; ++step) {
    const auto* const p = p_.ptr<double>(step);
    Beam next;
    std::vector<Longer> longer;
    for (const auto& [text, now] : prefixes) {
      Prefix& same = next[text];
      same.blank += now.total() * p[0];
      for (std::size_t c = 0; c < alphabet_.size(); ++c) {
        const bool again = !text.empty() && text.back() == alphabet_[c];
        // A repeated letter without a blank between is the same one, drawn out.
        if (again) same.letter += now.letter * p[c + 1];
        if (p[c + 1] < kNegligible) continue;
        longer.push_back({(again ? now.blank : now.total()) * p[c + 1], &text, alphabet_[c]});
      }
    }
    // Of those that are new no more than fill the beam can stay.
    std::erase_if(longer, [&](const Longer& l) { return addTo(prefixes, l, next); });
    const auto kept = longer.begin() + std::min<std::ptrdiff_t>(beam, std::ssize(longer));
    std::partial_sort(longer.begin(), kept, longer.end());
    for (auto l = longer.begin(); l != kept; ++l)
      next[*l->from + l->letter].letter = l->probability;
    prefixes = bestOf(next, beam);
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
