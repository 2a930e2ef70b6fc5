// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_text_parting.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

constexpr double kSure = 0.9;
constexpr double kLikely = 0.3;

TextReading surest(const FaceReadings& faces) {
  TextReading best;
  for (const auto& readings : faces) {
    PARKADE_CHECK(!readings.empty(), "a face without readings");
    const TextReading text = bestTextOf(readings);
    if (text.probability > best.probability) best = text;
  }
  return best;
}

// "A1A1", "1A1" and "A1A".
bool repeats(const std::string& text) {
  for (std::size_t period = 2; period < text.size(); ++period) {
    const std::size_t again = text.size() - period;
    if (text.compare(period, again, text, 0, again) == 0) return true;
  }
  return false;
}

// "A11" and "AA1": a face's text twice, of which letters went lost.
bool isTwice(const std::string& whole, const std::string& text) {
  if (text.size() < 2 || whole.size() <= text.size()) return false;
  const std::string twice = text + text;
  std::size_t at = 0;
  for (std::size_t i = 0; i < twice.size() && at < whole.size(); ++i) {
    if (twice[i] == whole[at]) ++at;
  }
  return at == whole.size();
}

bool agree(const FaceReadings& faces) {
  return faces.size() == 2 && !faces[0].front().text.empty() &&
         faces[0].front().text == faces[1].front().text;
}

// Whether a face shows an end of the text alone.
bool isCut(const std::string& whole, const FaceReadings& faces) {
  return std::any_of(faces.begin(), faces.end(), [&](const auto& readings) {
    const std::string& text = readings.front().text;
    if (text.empty() || text.size() >= whole.size()) return false;
    return whole.starts_with(text) || whole.ends_with(text);
  });
}

}  // namespace

std::vector<TextReading> onceEach(const std::vector<TextReading>& readings) {
  std::vector<TextReading> out;
  for (TextReading reading : readings) {
    const std::size_t half = reading.text.size() / 2;
    if (half >= 2 && reading.text.size() == 2 * half &&
        reading.text.compare(0, half, reading.text, half, half) == 0) {
      reading.text.resize(half);
    }
    const auto same = std::find_if(out.begin(), out.end(), [&](const TextReading& other) {
      return other.text == reading.text;
    });
    if (same == out.end()) {
      out.push_back(std::move(reading));
    } else {
      same->probability += reading.probability;
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const TextReading& a, const TextReading& b) {
    return a.probability > b.probability;
  });
  return out;
}

bool isSettled(const FaceReadings& faces, bool one_face) {
  const TextReading text = surest(faces);
  if (text.probability < kSure) return false;
  return one_face ? !repeats(text.text) : agree(faces);
}

bool showsOneFace(const FaceReadings& one, const FaceReadings& two, bool likelier_one) {
  const TextReading whole = surest(one);
  const TextReading side = surest(two);
  if (agree(two) && side.probability >= kLikely) return false;
  if (whole.probability >= kLikely) {
    const bool twice = repeats(whole.text) || isTwice(whole.text, side.text);
    if (twice && side.probability >= kLikely) return false;
    if (isCut(whole.text, two)) return true;
  }
  if (whole.probability == side.probability) return likelier_one;
  return whole.probability > side.probability;
}

}  // namespace parkade
