// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/stroke_font.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace parkade::sim {
namespace {

// Strokes on a grid 4 wide and 6 high: pairs of digits x y, strokes parted by blanks. A stroke that
// begins with '~' is rounded at its inner points.
struct Glyph {
  char letter;
  const char* strokes;
};

constexpr std::array<Glyph, 45> kGlyphs = {{
    {'0', "~100105163645413010"},
    {'1', "052620 1030"},
    {'2', "~05163645440000 0040"},
    {'3', "~05163645443313 ~13334241301001"},
    {'4', "3036260141"},
    {'5', "460603 ~03334241301001"},
    {'6', "~453616050110304142331302"},
    {'7', "064610"},
    {'8', "~130405163645443313 ~130201103041423313"},
    {'9', "~011030414536160504133344"},
    {'A', "002640 1232"},
    {'B', "00063645443303 3342413000"},
    {'C', "~4536160501103041"},
    {'D', "00062645412000"},
    {'E', "46060040 0333"},
    {'F', "460600 0333"},
    {'G', "~4536160501103041 414323"},
    {'H', "0006 4046 0343"},
    {'I', "2026"},
    {'J', "~464130100102"},
    {'K', "0006 460340"},
    {'L', "060040"},
    {'M', "0006224640"},
    {'N', "00064046"},
    {'O', "~100105163645413010"},
    {'P', "00063645443303"},
    {'Q', "~100105163645413010 2240"},
    {'R', "00063645443303 2340"},
    {'S', "~453616050413334241301001"},
    {'T', "0646 2026"},
    {'U', "~060110304146"},
    {'V', "062046"},
    {'W', "0610243046"},
    {'X', "0046 0640"},
    {'Y', "062346 2320"},
    {'Z', "06460040"},
    {'-', "1333"},
    {'.', "2020"},
    {'/', "0046"},
    {'+', "0343 2125"},
    {':', "2121 2525"},
    {'<', "0343 250321"},
    {'>', "0343 254321"},
    {'^', "2026 042644"},
    {'|', "2026"},
}};

constexpr double kCellsWide = 4.0;
constexpr double kCellsHigh = 6.0;
constexpr double kAspect = 0.62;        // of a glyph's width to its height
constexpr double kGlyphSpacing = 0.24;  // between glyphs, share of the height
constexpr double kBlank = 0.5;          // of a blank's width

bool isNarrow(char letter) {
  return letter == 'I' || letter == '.' || letter == ':' || letter == '|';
}

double glyphWidth(char letter) {
  if (letter == ' ') return kBlank;
  return isNarrow(letter) ? 0.0 : kAspect;
}

const char* strokesOf(char letter) {
  const char upper =
      letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.letter == upper) return glyph.strokes;
  }
  return "";
}

/// Chaikin's corner cutting, the ends kept.
Polygon rounded(const Polygon& line) {
  Polygon out = line;
  for (int pass = 0; pass < 2; ++pass) {
    Polygon next = {out.front()};
    for (std::size_t i = 0; i + 1 < out.size(); ++i) {
      if (i > 0) next.push_back(0.75 * out[i] + 0.25 * out[i + 1]);
      if (i + 2 < out.size()) next.push_back(0.25 * out[i] + 0.75 * out[i + 1]);
    }
    next.push_back(out.back());
    out = std::move(next);
  }
  return out;
}

void addStroke(const Polygon& line, double width, std::vector<Polygon>& out) {
  constexpr int kDiscSides = 8;
  if (line.size() == 1 || (line.size() == 2 && line[0] == line[1])) {
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.6 * width);
    const Eigen::Vector2d a = line[0] - half;
    const Eigen::Vector2d b = line[0] + half;
    out.push_back({a, {b.x(), a.y()}, b, {a.x(), b.y()}});
    return;
  }
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (line[i] == line[i + 1]) continue;
    out.push_back(strip(line[i], line[i + 1], width));
  }
  for (const Eigen::Vector2d& p : line) {
    Polygon disc;
    for (int k = 0; k < kDiscSides; ++k) {
      const double angle = 2.0 * M_PI * (k + 0.5) / kDiscSides;
      disc.push_back(p + 0.5 * width / std::cos(M_PI / kDiscSides) *
                             Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    out.push_back(disc);
  }
}

void addGlyph(const char* strokes, double x, double height, double width, double stroke,
              std::vector<Polygon>& out) {
  // The centre lines stay half a stroke inside the letter's box.
  const double inner_width = std::max(width - stroke, 0.0);
  const double inner_height = height - stroke;
  Polygon line;
  bool round = false;
  const auto flush = [&] {
    if (!line.empty()) addStroke(round && line.size() > 2 ? rounded(line) : line, stroke, out);
    line.clear();
    round = false;
  };
  for (const char* p = strokes; *p != '\0'; ++p) {
    if (*p == ' ') {
      flush();
    } else if (*p == '~') {
      round = true;
    } else {
      const double gx = (p[0] - '0') / kCellsWide;
      const double gy = (p[1] - '0') / kCellsHigh;
      const double px = width > 0.0 ? 0.5 * stroke + gx * inner_width : (gx - 0.5) * stroke;
      const Eigen::Vector2d point(x + px, 0.5 * stroke + gy * inner_height);
      if (line.empty() || line.back() != point) line.push_back(point);
      ++p;
    }
  }
  flush();
}

}  // namespace

double textWidth(std::string_view text, double height, double weight) {
  double width = 0.0;
  for (const char letter : text) {
    width += std::max(glyphWidth(letter), isNarrow(letter) ? weight : 0.0) * height;
  }
  return width + kGlyphSpacing * height * static_cast<double>(text.empty() ? 0 : text.size() - 1);
}

std::vector<Polygon> textPolygons(std::string_view text, double height, double weight) {
  std::vector<Polygon> out;
  const double stroke = weight * height;
  double x = -0.5 * textWidth(text, height, weight);
  for (const char letter : text) {
    const double advance = std::max(glyphWidth(letter), isNarrow(letter) ? weight : 0.0) * height;
    const double offset = isNarrow(letter) ? 0.5 * advance : 0.0;
    addGlyph(strokesOf(letter), x + offset, height, isNarrow(letter) ? 0.0 : advance, stroke, out);
    x += advance + kGlyphSpacing * height;
  }
  return out;
}

}  // namespace parkade::sim
