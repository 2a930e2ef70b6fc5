// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/objects/marker_grid.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "parkade/core/units.hpp"
#include "parkade/geometry/planar.hpp"
#include "parkade/mapping/objects/marker_counts.hpp"
#include "parkade/mapping/votes.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

/// A text of letters and digits, one after the other.
struct GridName {
  std::string letters;
  std::string digits;
  std::string between;  // a dash, or nothing
  bool letters_first = true;

  [[nodiscard]] std::string text() const {
    return letters_first ? letters + between + digits : digits + between + letters;
  }
  [[nodiscard]] bool isLike(const GridName& other) const {
    return letters_first == other.letters_first && between == other.between;
  }
};

bool isLetter(char c) {
  return std::isupper(static_cast<unsigned char>(c)) != 0;
}

bool isDigit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::optional<GridName> parse(const std::string& text) {
  if (text.empty()) return std::nullopt;
  GridName name;
  name.letters_first = isLetter(text.front());
  auto at = text.begin();
  const auto take = [&](bool letters) {
    const auto end = std::find_if_not(at, text.end(), letters ? isLetter : isDigit);
    return std::string(std::exchange(at, end), end);
  };
  std::string& first = name.letters_first ? name.letters : name.digits;
  std::string& second = name.letters_first ? name.digits : name.letters;
  first = take(name.letters_first);
  if (at != text.end() && *at == '-') name.between = *at++;
  second = take(!name.letters_first);
  if (at != text.end() || first.empty() || second.empty()) return std::nullopt;
  return name;
}

struct Marker {
  Vector2d p;
  std::optional<GridName> name;
};

using Part = std::string GridName::*;

/// Of the lines on which markers share a part of their names: the direction (rad, 0 to pi) that
/// most pairs of them have; none where they have many.
std::optional<double> directionOf(const std::vector<Marker>& markers, Part shared) {
  constexpr std::size_t kBins = 90;
  constexpr double kWidth = M_PI / kBins;
  constexpr double kLeast = 4.0;  // pairs
  constexpr double kShare = 0.7;  // of them all
  std::array<double, kBins> pairs{};
  std::array<Vector2d, kBins> sums;  // of twice the angle
  sums.fill(Vector2d::Zero());
  double all = 0.0;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    for (std::size_t j = i + 1; j < markers.size(); ++j) {
      const auto& a = markers[i].name;
      const auto& b = markers[j].name;
      if (!a || !b || (*a).*shared != (*b).*shared) continue;
      const Vector2d d = markers[j].p - markers[i].p;
      const double angle = std::atan2(d.y(), d.x()) + (d.y() < 0.0 ? M_PI : 0.0);
      const std::size_t bin = static_cast<std::size_t>(angle / kWidth) % kBins;
      pairs[bin] += 1.0;
      sums[bin] += Vector2d(std::cos(2.0 * angle), std::sin(2.0 * angle));
      all += 1.0;
    }
  }
  double most = 0.0;
  Vector2d sum = Vector2d::Zero();
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const std::size_t before = (bin + kBins - 1) % kBins;
    const std::size_t after = (bin + 1) % kBins;
    const double count = pairs[before] + pairs[bin] + pairs[after];
    if (count <= most) continue;
    most = count;
    sum = sums[before] + sums[bin] + sums[after];
  }
  if (most < kLeast || most < kShare * all) return std::nullopt;
  const double twice = std::atan2(sum.y(), sum.x());
  return 0.5 * (twice < 0.0 ? twice + 2.0 * M_PI : twice);
}

// How far a marker lies off its line, m.
constexpr double kAside = 0.6;

/// Markers side by side on one line, named ones, and the digits that most of them share.
struct DigitLine {
  std::vector<Marker*> markers;
  std::string digits;
  double across = 0.0;  // m
};

// Lines whose markers agree on a number, two of them at least.
std::vector<DigitLine> digitLines(std::vector<Marker>& markers, const Vector2d& along) {
  constexpr double kShare = 0.7;
  constexpr std::size_t kLongest = 4;  // digits
  std::vector<Marker*> named;
  for (Marker& marker : markers) {
    if (marker.name) named.push_back(&marker);
  }
  const auto across = [&](const Marker* marker) { return cross(along, marker->p); };
  std::stable_sort(named.begin(), named.end(),
                   [&](const Marker* a, const Marker* b) { return across(a) < across(b); });
  std::vector<DigitLine> lines;
  for (Marker* marker : named) {
    if (lines.empty() || across(marker) - across(lines.back().markers.back()) > kAside) {
      lines.emplace_back();
    }
    lines.back().markers.push_back(marker);
  }
  for (DigitLine& line : lines) {
    Votes votes;
    for (const Marker* one : line.markers) votes.add(one->name->digits, 1.0);
    line.digits = votes.best();
    const auto bears = [&](const Marker* one) { return one->name->digits == line.digits; };
    line.across = across(*std::find_if(line.markers.begin(), line.markers.end(), bears));
    const auto most = std::count_if(line.markers.begin(), line.markers.end(), bears);
    const auto all = static_cast<double>(line.markers.size());
    if (most < 2 || static_cast<double>(most) < kShare * all) line.digits.clear();
  }
  std::erase_if(lines, [](const DigitLine& line) {
    return line.digits.empty() || line.digits.size() > kLongest;
  });
  return lines;
}

// A hidden stroke, or worn paint, may make all markers of a line be misread alike.
void mendLines(std::vector<Marker>& markers, double digits_run) {
  std::vector<DigitLine> lines =
      digitLines(markers, Vector2d(std::cos(digits_run), std::sin(digits_run)));
  std::vector<CountedLine> counted;
  for (const DigitLine& line : lines) counted.push_back({line.across, std::stoi(line.digits)});
  const std::vector<std::optional<int>> mended = mendedCounts(counted);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!mended[i]) continue;
    const bool padded = lines[i].digits.front() == '0';
    const std::string digits =
        fmt::format("{:0{}}", *mended[i], padded ? lines[i].digits.size() : 1);
    for (Marker* marker : lines[i].markers) {
      if (marker->name->digits == lines[i].digits) marker->name->digits = digits;
    }
  }
}

class NameGrid {
 public:
  NameGrid(const std::vector<Marker>& markers, double letters, double digits)
      : markers_(markers),
        along_letters_(std::cos(letters), std::sin(letters)),
        along_digits_(std::cos(digits), std::sin(digits)) {}

  [[nodiscard]] std::optional<std::string> lettersAt(std::size_t i) const {
    return agreed(i, along_letters_, &GridName::letters);
  }
  [[nodiscard]] std::optional<std::string> digitsAt(std::size_t i) const {
    return agreed(i, along_digits_, &GridName::digits);
  }

  // Whether markers whose lines tell both parts mostly bear them.
  [[nodiscard]] bool holds() const {
    constexpr int kLeast = 6;
    constexpr double kShare = 0.8;
    int told = 0;
    int right = 0;
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      const auto letters = lettersAt(i);
      const auto digits = digitsAt(i);
      if (!markers_[i].name || !letters || !digits) continue;
      ++told;
      right += markers_[i].name->letters == *letters && markers_[i].name->digits == *digits;
    }
    return told >= kLeast && right >= kShare * told;
  }

 private:
  // What the others next to a marker on its line agree on, two of them at least.
  [[nodiscard]] std::optional<std::string> agreed(std::size_t i, const Vector2d& along,
                                                  Part part) const {
    constexpr double kFar = 40.0;  // m
    constexpr std::size_t kMost = 4;
    std::vector<std::pair<double, const std::string*>> others;
    for (std::size_t j = 0; j < markers_.size(); ++j) {
      if (j == i || !markers_[j].name) continue;
      const Vector2d d = markers_[j].p - markers_[i].p;
      const double distance = std::abs(d.dot(along));
      if (std::abs(cross(d, along)) > kAside || distance > kFar) continue;
      others.emplace_back(distance, &((*markers_[j].name).*part));
    }
    std::stable_sort(others.begin(), others.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    others.resize(std::min(kMost, others.size()));
    if (others.size() < 2) return std::nullopt;
    const std::string& first = *others.front().second;
    const bool same = std::all_of(others.begin(), others.end(),
                                  [&](const auto& other) { return *other.second == first; });
    return same ? std::optional(first) : std::nullopt;
  }

  const std::vector<Marker>& markers_;
  Vector2d along_letters_;
  Vector2d along_digits_;
};

// Those parsed that are made up as most are.
std::vector<Marker> alike(const std::vector<NamedMarker>& named, GridName& usual) {
  std::vector<Marker> markers;
  for (const NamedMarker& one : named) markers.push_back({one.position, parse(one.text)});
  int most = 0;
  for (const Marker& one : markers) {
    if (!one.name) continue;
    const auto count =
        static_cast<int>(std::count_if(markers.begin(), markers.end(), [&](const Marker& other) {
          return other.name && other.name->isLike(*one.name);
        }));
    if (count <= most) continue;
    most = count;
    usual = *one.name;
  }
  for (Marker& one : markers) {
    if (one.name && !one.name->isLike(usual)) one.name.reset();
  }
  return markers;
}

}  // namespace

void nameByGrid(std::vector<NamedMarker>& named) {
  GridName usual;
  std::vector<Marker> markers = alike(named, usual);
  const auto letters_run = directionOf(markers, &GridName::letters);
  const auto digits_run = directionOf(markers, &GridName::digits);
  if (!letters_run || !digits_run) return;
  constexpr double kSquare = 10.0 * kDegree;
  if (std::abs(std::abs(*letters_run - *digits_run) - 0.5 * M_PI) > kSquare) return;
  const NameGrid grid(markers, *letters_run, *digits_run);
  if (!grid.holds()) return;
  mendLines(markers, *digits_run);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < named.size(); ++i) {
    const auto letters = grid.lettersAt(i);
    const auto digits = grid.digitsAt(i);
    const bool known = markers[i].name.has_value();
    GridName name = known ? *markers[i].name : usual;
    if (letters) name.letters = *letters;
    if (digits) name.digits = *digits;
    texts.push_back(known || (letters && digits) ? name.text() : named[i].text);
  }
  const std::vector<NamedMarker> before = named;
  for (std::size_t i = 0; i < named.size(); ++i) {
    bool given = false;
    for (std::size_t j = 0; j < named.size(); ++j) {
      given = given || (j != i && (before[j].text == texts[i] || texts[j] == texts[i]));
    }
    if (!given) named[i].text = texts[i];
  }
}

}  // namespace parkade
