// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "parkade/types/text_format.hpp"
#include "parkade/types/text_reading.hpp"

namespace parkade {

/// Which text several readings of one marker or number agree on: logarithms of its likelihood ratio
/// to a text that no reading knows, added up. A reading may be wrong altogether, so that a text
/// which one of them does not list loses only so much; and it may be a part of the text, where
/// something hid the rest or a face's edge was missed. docs/math/zone_markers.md, eqs. (3) and (4).
class TextEvidence {
 public:
  /// The readings of one face, best first. A face that is probably plain says nothing of the
  /// marker.
  void add(const std::vector<TextReading>& readings) {
    Face face;
    for (const TextReading& reading : readings) {
      if (reading.text.empty()) {
        face.none += reading.probability;
      } else if (reading.probability > kNegligible) {
        face.readings.push_back({reading.text, weigh(reading)});
      }
    }
    if (face.readings.empty()) return;
    for (const TextReading& reading : face.readings) {
      whole_[reading.text] += ratio(kWhole * reading.probability, face);
    }
    faces_.push_back(std::move(face));
    if (faces_.size() > kFaces) faces_.pop_front();
  }

  void add(const TextEvidence& other) {
    for (const auto& [text, value] : other.whole_) whole_[text] += value;
    for (const Face& face : other.faces_) faces_.push_back(face);
    while (faces_.size() > kFaces) faces_.pop_front();
  }

  /// Logarithm of a text's likelihood ratio.
  [[nodiscard]] double support(const std::string& text) const { return evidenceFor(text); }

  /// Whether a face that reads so bears another text: both are sure of theirs, and the face's is no
  /// part of this one's, nor this one's of it.
  [[nodiscard]] bool contradicts(const std::vector<TextReading>& readings) const {
    constexpr double kSureFace = 0.9;
    constexpr double kSure = 0.95;
    const auto other = std::find_if(readings.begin(), readings.end(), [](const TextReading& r) {
      return !r.text.empty() && r.probability > kSureFace;
    });
    if (other == readings.end()) return false;
    const TextReading own = best();
    return own.probability > kSure && own.text.find(other->text) == std::string::npos &&
           other->text.find(own.text) == std::string::npos;
  }

  /// The best text and its probability; empty and 0 where nothing was read. format: how the
  /// garage's other markers are called.
  [[nodiscard]] TextReading best(const TextFormat& format = {}) const {
    constexpr double kNone = 2.0;  // of all texts that no reading knows
    constexpr std::size_t kCandidates = 8;
    std::vector<std::pair<double, const std::string*>> candidates;
    for (const auto& [text, value] : whole_) candidates.emplace_back(value, &text);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    candidates.resize(std::min(candidates.size(), kCandidates));
    TextReading result;
    double most = 0.0;
    for (auto& [value, text] : candidates) {
      value = evidenceFor(*text) + format.logPrior(*text);
      if (value <= most) continue;
      most = value;
      result.text = *text;
    }
    if (result.text.empty()) return result;
    double sum = std::exp(kNone - most);
    for (const auto& [value, text] : candidates) sum += std::exp(value - most);
    result.probability = 1.0 / sum;
    return result;
  }

 private:
  struct Face {
    std::vector<TextReading> readings;  ///< weighed
    double none = 0.0;                  ///< probability that it is plain
  };
  static constexpr double kWhole = 0.7;     // share of readings that are of the whole text
  static constexpr double kPart = 0.15;     // of a part of it
  static constexpr double kWrong = 0.05;    // wrong altogether
  static constexpr double kAnyText = 0.02;  // what such a reading gives to any one text
  static constexpr double kNegligible = 0.01;
  static constexpr std::size_t kFaces = 40;  // the latest that are kept

  /// Its probability over what a reading that knows nothing gives to texts of that length, 1 of
  /// three characters and more. Noise and edges look like "1" far oftener than like "B12".
  static double weigh(const TextReading& reading) {
    constexpr double kOne = 0.04;
    constexpr double kTwo = 0.25;
    const std::size_t length = reading.text.size();
    return reading.probability * (length == 1 ? kOne : length == 2 ? kTwo : 1.0);
  }
  static double ratio(double probability, const Face& face) {
    return std::log1p(probability / (kWrong * kAnyText + face.none));
  }
  [[nodiscard]] double evidenceFor(const std::string& text) const {
    double sum = 0.0;
    for (const Face& face : faces_) {
      double probability = 0.0;
      for (const TextReading& reading : face.readings) {
        if (reading.text == text) {
          probability += kWhole * reading.probability;
        } else if (text.find(reading.text) != std::string::npos) {
          probability += kPart * reading.probability;
        }
      }
      sum += ratio(probability, face);
    }
    return sum;
  }

  std::map<std::string, double> whole_;  ///< evidence without parts: picks the candidates
  std::deque<Face> faces_;
};

}  // namespace parkade
