// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_parting.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

constexpr double kSure = 0.9;
constexpr double kLikely = 0.3;
constexpr double kNegligible = 0.03;

// What its letters are: letters L, digits D, others themselves.
std::string patternOf(const std::string& text) {
  std::string pattern = text;
  for (char& c : pattern) {
    if (c >= 'A' && c <= 'Z') c = 'L';
    if (c >= '0' && c <= '9') c = 'D';
  }
  return pattern;
}

bool isMixed(const std::string& pattern) {
  return pattern.find('L') != std::string::npos && pattern.find('D') != std::string::npos;
}

// "A1A1", "1A1" and "A1A", and as well "A1B2": by how many letters the pattern of letters and
// digits repeats itself; 0 where it does not. No marker is called so.
std::size_t periodOf(const std::string& text) {
  const std::string pattern = patternOf(text);
  if (!isMixed(pattern)) return 0;
  for (std::size_t period = 2; period < pattern.size(); ++period) {
    const std::size_t again = pattern.size() - period;
    if (pattern.compare(period, again, pattern, 0, again) == 0) return period;
  }
  return 0;
}

// "A11" and "AA1": a face's text twice, of which letters went lost.
bool isTwice(const std::string& whole, const std::string& text) {
  const std::string twice = text + text;
  std::size_t at = 0;
  for (std::size_t i = 0; i < twice.size() && at < whole.size(); ++i) {
    if (twice[i] == whole[at]) ++at;
  }
  return at == whole.size();
}

// How well a reading goes with a text that a patch shows once, twice, or once and in part again.
double agreement(const std::string& reading, const std::string& text) {
  constexpr double kInPart = 0.9;
  constexpr double kMisread = 0.5;  // the one beside
  constexpr double kLost = 0.5;
  if (reading == text || reading == text + text) return 1.0;
  if (text.size() < 2 || reading.size() <= text.size() || reading.size() > 2 * text.size()) {
    return 0.0;
  }
  const std::size_t more = reading.size() - text.size();
  double best = isTwice(reading, text) ? kLost : 0.0;
  if (!isMixed(patternOf(text))) return best;
  const auto consider = [&](const std::string& beside, const std::string& expected) {
    if (patternOf(beside) != patternOf(expected)) return;
    best = std::max(best, beside == expected ? kInPart : kMisread);
  };
  if (reading.starts_with(text)) consider(reading.substr(text.size()), text.substr(0, more));
  if (reading.ends_with(text)) consider(reading.substr(0, more), text.substr(text.size() - more));
  return best;
}

double support(const std::vector<TextReading>& face, const std::string& text) {
  double sum = 0.0;
  for (const TextReading& reading : face) {
    if (!reading.text.empty()) sum += reading.probability * agreement(reading.text, text);
  }
  return std::min(1.0, sum);
}

std::set<std::string> candidatesOf(const std::vector<FaceReadings>& partings) {
  std::set<std::string> candidates;
  for (const FaceReadings& faces : partings) {
    for (const auto& readings : faces) {
      PARKADE_CHECK(!readings.empty(), "a face without readings");
      for (const TextReading& reading : readings) {
        if (reading.text.empty() || reading.probability < kNegligible) continue;
        candidates.insert(reading.text);
        const std::size_t period = periodOf(reading.text);
        if (period == 0) continue;
        candidates.insert(reading.text.substr(0, period));
        candidates.insert(reading.text.substr(reading.text.size() - period));
      }
    }
  }
  return candidates;
}

// A text, how much speaks for it, and how much in each parting by itself.
struct Candidate {
  std::string text;
  double score = 0.0;
  double most = 0.0;  // of one parting
  std::size_t parting = 0;
  double probability = 0.0;  // that a face of that parting shows it
};

Candidate weigh(const std::string& text, const std::vector<FaceReadings>& partings) {
  constexpr double kOdd = 0.05;  // of markers whose name repeats itself
  Candidate candidate{text};
  for (std::size_t k = 0; k < partings.size(); ++k) {
    double most = 0.0;
    double none = 1.0;
    for (const auto& readings : partings[k]) {
      const double share = support(readings, text);
      most = std::max(most, share);
      none *= 1.0 - share;
    }
    candidate.score += most;
    if (most <= candidate.most) continue;
    candidate.most = most;
    candidate.parting = k;
    candidate.probability = 1.0 - none;
  }
  const double odds = periodOf(text) > 0 ? kOdd : 1.0;
  candidate.score *= odds;
  candidate.probability *= odds;
  return candidate;
}

// A side may show an end of the text alone, and be read more surely than the whole.
bool isEndOf(const std::string& part, const std::string& whole,
             const std::vector<FaceReadings>& partings) {
  if (part.size() >= whole.size() || periodOf(whole) > 0 || agreement(whole, part) > 0.0) {
    return false;
  }
  if (!whole.starts_with(part) && !whole.ends_with(part)) return false;
  double most = 0.0;
  for (const FaceReadings& faces : partings) {
    for (const auto& readings : faces) {
      for (const TextReading& reading : readings) {
        if (reading.text == whole) most = std::max(most, reading.probability);
      }
    }
  }
  return most >= kLikely;
}

double plainness(const std::vector<FaceReadings>& partings) {
  double least = 1.0;
  for (const FaceReadings& faces : partings) {
    for (const auto& readings : faces) {
      double none = 0.0;
      for (const TextReading& reading : readings) {
        if (reading.text.empty()) none += reading.probability;
      }
      least = std::min(least, none);
    }
  }
  return least;
}

}  // namespace

SightText tellText(const std::vector<FaceReadings>& partings) {
  PARKADE_CHECK(!partings.empty(), "nothing was read");
  constexpr std::size_t kReadings = 5;
  std::vector<Candidate> candidates;
  for (const std::string& text : candidatesOf(partings)) {
    candidates.push_back(weigh(text, partings));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  if (!candidates.empty()) {
    const std::string first = candidates.front().text;
    const auto whole =
        std::find_if(candidates.begin() + 1, candidates.end(),
                     [&](const Candidate& c) { return isEndOf(first, c.text, partings); });
    if (whole != candidates.end()) std::rotate(candidates.begin(), whole, whole + 1);
  }
  SightText told;
  if (!candidates.empty()) told.parting = candidates.front().parting;
  candidates.resize(std::min(kReadings, candidates.size()));
  const double plain = plainness(partings);
  double sum = plain;
  for (const Candidate& c : candidates) sum += c.probability;
  const double scale = 1.0 / std::max(1.0, sum);
  for (const Candidate& c : candidates) told.readings.push_back({c.text, scale * c.probability});
  const TextReading none{"", scale * plain};
  const auto place =
      std::find_if(told.readings.begin(), told.readings.end(),
                   [&](const TextReading& r) { return r.probability < none.probability; });
  told.readings.insert(place, none);
  return told;
}

bool isSettled(const FaceReadings& faces) {
  if (faces.empty()) return false;
  const std::string text = bestTextOf(tellText({faces}).readings).text;
  if (text.empty() || periodOf(text) > 0) return false;
  const auto shows = [&](const std::vector<TextReading>& readings, double least) {
    const TextReading& best = readings.front();
    return (best.text == text || best.text == text + text) && best.probability >= least;
  };
  const bool sure = std::any_of(faces.begin(), faces.end(),
                                [&](const auto& readings) { return shows(readings, kSure); });
  return sure && std::all_of(faces.begin(), faces.end(),
                             [&](const auto& readings) { return shows(readings, 0.0); });
}

}  // namespace parkade
