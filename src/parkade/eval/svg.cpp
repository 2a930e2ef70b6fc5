// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/svg.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/markup.hpp"

namespace parkade::svg {
namespace {

// A tenth of a pixel, without a trailing zero.
std::string number(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

double distanceToSegment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                         const Eigen::Vector2d& b) {
  const Eigen::Vector2d d = b - a;
  const double length2 = d.squaredNorm();
  const double s = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a - s * d).norm();
}

// Drops points nearer than a distance to the last one kept: bounds the work of what follows.
Points dropNear(const Points& points, double distance) {
  Points kept;
  for (const auto& p : points) {
    if (kept.empty() || (p - kept.back()).norm() >= distance) kept.push_back(p);
  }
  if (kept.back() != points.back()) kept.push_back(points.back());
  return kept;
}

}  // namespace

Document::Document(double width, double height, std::string_view title, std::string_view style) {
  const std::string w = number(width);
  const std::string h = number(height);
  body_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" "
      "viewBox=\"0 0 {} {}\" role=\"img\">\n<title>{}</title>\n<style>\n{}</style>\n"
      "<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n",
      w, h, w, h, escapedMarkup(title), style, w, h);
}

void Document::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                    std::string_view css_class) {
  body_ += fmt::format("<path class=\"{}\" d=\"M{} {}L{} {}\"/>\n", css_class, number(a.x()),
                       number(a.y()), number(b.x()), number(b.y()));
}

void Document::polyline(const Points& points, std::string_view css_class) {
  if (points.size() < 2) return;
  body_ += fmt::format("<polyline class=\"{}\" points=\"", css_class);
  for (const auto& p : points) {
    body_ += number(p.x());
    body_ += ',';
    body_ += number(p.y());
    body_ += ' ';
  }
  body_.back() = '"';
  body_ += "/>\n";
}

void Document::rectangle(const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                         std::string_view css_class) {
  body_ +=
      fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", css_class,
                  number(corner.x()), number(corner.y()), number(size.x()), number(size.y()));
}

void Document::circle(const Eigen::Vector2d& centre, double radius, std::string_view css_class) {
  body_ += fmt::format("<circle class=\"{}\" cx=\"{}\" cy=\"{}\" r=\"{}\"/>\n", css_class,
                       number(centre.x()), number(centre.y()), number(radius));
}

void Document::cross(const Eigen::Vector2d& centre, double radius, std::string_view css_class) {
  const Eigen::Vector2d down(radius, radius);
  const Eigen::Vector2d up(radius, -radius);
  line(centre - down, centre + down, css_class);
  line(centre - up, centre + up, css_class);
}

void Document::text(const Eigen::Vector2d& position, std::string_view text,
                    std::string_view css_class, bool vertical) {
  const std::string x = number(position.x());
  const std::string y = number(position.y());
  const std::string turn =
      vertical ? fmt::format(" transform=\"rotate(-90 {} {})\"", x, y) : std::string();
  body_ += fmt::format("<text class=\"{}\" x=\"{}\" y=\"{}\"{}>{}</text>\n", css_class, x, y, turn,
                       escapedMarkup(text));
}

void Document::image(const Eigen::Vector2d& corner, const Eigen::Vector2d& size,
                     std::string_view address) {
  body_ += fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
      "href=\"{}\"/>\n",
      number(corner.x()), number(corner.y()), number(size.x()), number(size.y()),
      escapedMarkup(address));
}

void Document::beginClip(const Eigen::Vector2d& corner, const Eigen::Vector2d& size) {
  ++clips_;
  body_ += fmt::format(
      "<clipPath id=\"clip{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>\n"
      "<g clip-path=\"url(#clip{})\">\n",
      clips_, number(corner.x()), number(corner.y()), number(size.x()), number(size.y()), clips_);
}

void Document::endClip() {
  body_ += "</g>\n";
}

Ticks ticks(double low, double high, int about) {
  PARKADE_CHECK(low < high && about > 0, "ticks from {} to {}, about {}", low, high, about);
  const double raw = (high - low) / about;
  int exponent = static_cast<int>(std::floor(std::log10(raw)));
  const double mantissa = raw / std::pow(10.0, exponent);
  double factor = 1.0;
  if (mantissa > 7.0) {
    ++exponent;
  } else if (mantissa > 3.5) {
    factor = 5.0;
  } else if (mantissa > 1.5) {
    factor = 2.0;
  }
  const double step = factor * std::pow(10.0, exponent);
  Ticks result;
  result.decimals = std::max(0, -exponent);
  // Multiples, not sums: 0.1 added ten times is not 1.
  const double slack = 1e-9;
  for (double k = std::ceil(low / step - slack); k <= high / step + slack; ++k) {
    result.values.push_back(k == 0.0 ? 0.0 : k * step);
  }
  return result;
}

double roundUp(double value) {
  PARKADE_CHECK(value > 0.0, "value = {}", value);
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (factor * power >= value) return factor * power;
  }
  return 10.0 * power;
}

Points simplify(const Points& points, double tolerance) {
  if (points.size() < 3) return points;
  const Points thin = dropNear(points, tolerance);
  std::vector<bool> keep(thin.size(), false);
  keep.front() = true;
  keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, thin.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t split = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distanceToSegment(thin[i], thin[first], thin[last]);
      if (distance > farthest) {
        farthest = distance;
        split = i;
      }
    }
    if (split == 0) continue;
    keep[split] = true;
    open.emplace_back(first, split);
    open.emplace_back(split, last);
  }
  Points result;
  for (std::size_t i = 0; i < thin.size(); ++i) {
    if (keep[i]) result.push_back(thin[i]);
  }
  return result;
}

Points thinColumns(const Points& points) {
  Points result;
  std::size_t begin = 0;
  while (begin < points.size()) {
    const double column = std::floor(points[begin].x());
    std::size_t end = begin;
    std::size_t lowest = begin;
    std::size_t highest = begin;
    for (; end < points.size() && std::floor(points[end].x()) == column; ++end) {
      if (points[end].y() < points[lowest].y()) lowest = end;
      if (points[end].y() > points[highest].y()) highest = end;
    }
    std::vector<std::size_t> chosen = {begin, std::min(lowest, highest), std::max(lowest, highest),
                                       end - 1};
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    for (const std::size_t i : chosen) result.push_back(points[i]);
    begin = end;
  }
  return result;
}

std::string shorten(std::string_view text, std::size_t max_characters) {
  if (text.size() <= max_characters) return std::string(text);
  const std::size_t head = max_characters / 2;
  const std::size_t tail = max_characters - head - 1;
  return std::string(text.substr(0, head)) + "\u2026" +
         std::string(text.substr(text.size() - tail));
}

}  // namespace parkade::svg
