// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_parting.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "parkade/core/check.hpp"
#include "parkade/semantics/texts/zone_text_share.hpp"

namespace parkade {
namespace {

using Parting = std::vector<FaceLooks>;

// Calls visit(look) for all of them.
template <typename Visit>
void forEachLook(const std::vector<Parting>& partings, const Visit& visit) {
  for (const Parting& faces : partings) {
    for (const FaceLooks& looks : faces) {
      PARKADE_CHECK(!looks.empty(), "a face that nobody looked at");
      for (const FaceLook& look : looks) {
        PARKADE_CHECK(!look.readings.empty(), "a look without readings");
        visit(look);
      }
    }
  }
}

std::set<std::string> candidatesOf(const std::vector<Parting>& partings) {
  constexpr double kNegligible = 0.02;
  std::set<std::string> candidates;
  forEachLook(partings, [&](const FaceLook& look) {
    for (const TextReading& reading : look.readings) {
      if (reading.text.empty() || reading.probability < kNegligible) continue;
      candidates.insert(reading.text);
      const std::size_t period = periodOf(reading.text);
      if (period == 0) continue;
      candidates.insert(reading.text.substr(0, period));
      candidates.insert(reading.text.substr(reading.text.size() - period));
    }
  });
  return candidates;
}

double plainOf(const FaceLook& look) {
  double none = 0.0;
  for (const TextReading& reading : look.readings) {
    if (reading.text.empty()) none += reading.probability;
  }
  return none;
}

// A text and what speaks for it.
struct Candidate {
  std::string text;
  double score = 0.0;  // logarithm
  double most = -1.0;  // of one face
  std::size_t parting = 0;
  std::vector<int> down;
  double probability = 0.0;  // that a face of that parting shows it
};

Candidate weigh(const std::string& text, const std::vector<Parting>& partings) {
  constexpr double kWrong = 0.02;  // of a parting's faces, whatever is written there
  const double odds = nameOdds(text);
  Candidate candidate;
  candidate.text = text;
  candidate.score = std::log(odds);
  for (std::size_t k = 0; k < partings.size(); ++k) {
    double most = 0.0;
    double none = 1.0;
    std::vector<int> down;
    for (const FaceLooks& looks : partings[k]) {
      double share = -1.0;
      down.push_back(0);
      for (const FaceLook& look : looks) {
        const double here = look.odds * shareOf(text, look.letters);
        if (here <= share) continue;
        share = here;
        down.back() = look.down;
      }
      most = std::max(most, share);
      none *= 1.0 - share;
    }
    candidate.score += std::log(kWrong + most);
    if (most <= candidate.most) continue;
    candidate.most = most;
    candidate.parting = k;
    candidate.down = std::move(down);
    candidate.probability = odds * (1.0 - none);
  }
  return candidate;
}

}  // namespace

SightText tellText(const std::vector<Parting>& partings) {
  PARKADE_CHECK(!partings.empty(), "nothing was read");
  constexpr std::size_t kReadings = 5;
  std::vector<Candidate> candidates;
  for (const std::string& text : candidatesOf(partings)) {
    candidates.push_back(weigh(text, partings));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  SightText told;
  if (!candidates.empty()) {
    told.parting = candidates.front().parting;
    told.down = candidates.front().down;
  } else {
    told.down.assign(partings.front().size(), 0);
  }
  candidates.resize(std::min(kReadings, candidates.size()));
  double plain = 1.0;
  forEachLook(partings, [&](const FaceLook& look) { plain = std::min(plain, plainOf(look)); });
  // What faces show of all texts together is shared out by what speaks for each of them.
  double shown = 0.0;
  double weights = 0.0;
  const auto weightOf = [&](const Candidate& c) {
    return std::exp(c.score - candidates.front().score);
  };
  for (const Candidate& c : candidates) {
    shown += c.probability;
    weights += weightOf(c);
  }
  const double scale = 1.0 / std::max(1.0, plain + shown);
  for (const Candidate& c : candidates) {
    told.readings.push_back({c.text, scale * shown * weightOf(c) / weights});
  }
  const TextReading none{"", scale * plain};
  const auto place =
      std::find_if(told.readings.begin(), told.readings.end(),
                   [&](const TextReading& r) { return r.probability < none.probability; });
  told.readings.insert(place, none);
  return told;
}

bool isSettled(const Parting& faces) {
  constexpr double kSure = 0.9;
  std::string text;
  for (const FaceLooks& looks : faces) {
    const TextReading& best = looks.front().readings.front();
    if (best.probability < kSure) continue;
    text = best.text;
    const std::string half = text.substr(0, text.size() / 2);
    if (half + half == text && nameOdds(half) == 1.0) text = half;
    break;
  }
  if (text.empty() || nameOdds(text) < 1.0) return false;
  return std::all_of(faces.begin(), faces.end(), [&](const FaceLooks& looks) {
    const std::string& read = looks.front().readings.front().text;
    return read == text || read == text + text;
  });
}

}  // namespace parkade
