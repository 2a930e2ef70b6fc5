// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/charts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kChartWidth = 480.0;
constexpr double kTop = 34.0;  // below the title
constexpr double kLegendLine = 20.0;
constexpr int kColours = 7;

constexpr const char* kChartStyle =
    "text{font-family:'DejaVu Sans',Verdana,sans-serif;font-size:12px;fill:#333}\n"
    ".title{font-size:14px;font-weight:bold;fill:#111}\n"
    ".m{text-anchor:middle}.e{text-anchor:end}.s{text-anchor:start}\n"
    ".tag{font-size:7px;text-anchor:middle;fill:#111;stroke:#fff;stroke-width:1.5px;"
    "paint-order:stroke}\n"
    "path,polyline{fill:none;stroke-linejoin:round;stroke-linecap:round}\n"
    ".grid{stroke:#e4e4e4;stroke-width:1}.frame{stroke:#8a8a8a;stroke-width:1;fill:none}\n"
    ".ref{stroke:#7d7d7d;stroke-width:5;stroke-opacity:.65}\n"
    ".l0{stroke:#1660b5}.l1{stroke:#d9730d}.l2{stroke:#2a9d3a}.l3{stroke:#c8102e}\n"
    ".l4{stroke:#8e44ad}.l5{stroke:#0b8a8f}.l6{stroke:#8a6d1a}\n"
    ".l0,.l1,.l2,.l3,.l4,.l5,.l6{stroke-width:1.8}\n"
    ".bar{fill:#6fa3d8}.mark{stroke:#1c2430;stroke-width:2}\n";

struct Box {
  double left;
  double top;
  double width;
  double height;
  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
};

void drawFrame(svg::Document& out, const Box& box, const svg::Axis& x, const svg::Axis& y,
               bool grid) {
  const svg::Ticks across = svg::ticks(x.low, x.high, 5);
  for (const double value : across.values) {
    const double px = x.pixel(value);
    if (grid) out.line({px, box.top}, {px, box.bottom()}, "grid");
    out.text({px, box.bottom() + 16}, fmt::format("{:.{}f}", value, across.decimals), "m");
  }
  const svg::Ticks up = svg::ticks(y.low, y.high, 5);
  for (const double value : up.values) {
    const double px = y.pixel(value);
    if (grid) out.line({box.left, px}, {box.right(), px}, "grid");
    out.text({box.left - 5, px + 4}, fmt::format("{:.{}f}", value, up.decimals), "e");
  }
  out.rectangle({box.left, box.top}, {box.width, box.height}, "frame");
}

std::vector<std::string> classesOf(const std::vector<ChartLine>& lines) {
  std::vector<std::string> classes;
  int next = 0;
  for (const ChartLine& line : lines) {
    classes.push_back(line.reference ? "ref" : fmt::format("l{}", next++ % kColours));
  }
  return classes;
}

// Names beside strokes, wrapped; gives the height. Without a document it only measures.
double drawLegend(svg::Document* out, const std::vector<ChartLine>& lines, double top) {
  const std::vector<std::string> classes = classesOf(lines);
  double x = 8.0;
  double y = top + 12.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const double width = 34.0 + 7.6 * static_cast<double>(lines[i].name.size());
    if (x + width > kChartWidth && x > 8.0) {
      x = 8.0;
      y += kLegendLine;
    }
    if (out != nullptr) {
      out->line({x, y - 4}, {x + 20, y - 4}, classes[i]);
      out->text({x + 26, y}, lines[i].name, "s");
    }
    x += width + 6.0;
  }
  return y - top + 8.0;
}

struct Bounds {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity());
  Vector2d high = Vector2d::Constant(-std::numeric_limits<double>::infinity());
  void add(const Vector2d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  [[nodiscard]] bool empty() const { return low.x() > high.x(); }
  [[nodiscard]] Vector2d size() const { return high - low; }
};

Bounds boundsOf(const std::vector<ChartLine>& lines) {
  Bounds bounds;
  for (const ChartLine& line : lines) {
    for (const Vector2d& p : line.points) bounds.add(p);
  }
  return bounds;
}

Bounds groundView(const std::optional<GroundPicture>& picture,
                  const std::vector<ChartLine>& lines) {
  Bounds view = boundsOf(lines);
  if (picture && (picture->whole || view.empty())) {
    view = {};
    view.add(picture->top_left);
    view.add(picture->top_left + Vector2d(picture->size.x(), -picture->size.y()));
    return view;
  }
  if (view.empty()) view.add(Vector2d::Zero());
  constexpr double kAround = 6.0;  // m
  view.low -= Vector2d::Constant(kAround);
  view.high += Vector2d::Constant(kAround);
  return view;
}

}  // namespace

std::string groundChart(const std::string& title, const std::optional<GroundPicture>& picture,
                        const std::vector<ChartLine>& lines,
                        const std::vector<GroundLabel>& labels) {
  const Bounds view = groundView(picture, lines);
  constexpr double kLeft = 40.0;
  constexpr double kTallest = 560.0;
  const double width = kChartWidth - kLeft - 8.0;
  const double height = std::clamp(width * view.size().y() / view.size().x(), 60.0, kTallest);
  const Box box{kLeft, kTop, width, height};
  const double m_per_px = std::max(view.size().x() / width, view.size().y() / height);
  const Vector2d middle = 0.5 * (view.low + view.high);
  const svg::Axis x{middle.x() - 0.5 * width * m_per_px, middle.x() + 0.5 * width * m_per_px,
                    box.left, box.right()};
  const svg::Axis y{middle.y() - 0.5 * height * m_per_px, middle.y() + 0.5 * height * m_per_px,
                    box.bottom(), box.top};
  const double legend = drawLegend(nullptr, lines, 0.0);
  svg::Document out(kChartWidth, box.bottom() + 24.0 + legend, title, kChartStyle);
  out.text({8, 20}, title, "title");
  if (!picture) drawFrame(out, box, x, y, true);
  out.beginClip({box.left, box.top}, {box.width, box.height});
  const auto at = [&](const Vector2d& p) { return Vector2d(x.pixel(p.x()), y.pixel(p.y())); };
  if (picture) out.image(at(picture->top_left), picture->size / m_per_px, picture->address);
  const std::vector<std::string> classes = classesOf(lines);
  for (const bool reference : {true, false}) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].reference != reference) continue;
      svg::Points points;
      for (const Vector2d& p : lines[i].points) points.push_back(at(p));
      out.polyline(svg::simplify(points, 0.2), classes[i]);
    }
  }
  for (const GroundLabel& label : labels) out.text(at(label.position), label.text, "tag");
  out.endClip();
  if (picture) drawFrame(out, box, x, y, false);
  drawLegend(&out, lines, box.bottom() + 22.0);
  return out.str();
}

std::string lineChart(const std::string& title, const std::string& x_name,
                      const std::vector<ChartLine>& lines) {
  const Box box{52.0, kTop, kChartWidth - 60.0, 210.0};
  Bounds bounds = boundsOf(lines);
  if (bounds.empty()) bounds.add(Vector2d::Zero());
  const svg::Axis x{bounds.low.x(), std::max(bounds.high.x(), bounds.low.x() + 1e-3), box.left,
                    box.right()};
  const svg::Axis y{0.0, svg::roundUp(std::max(1.05 * bounds.high.y(), 1e-3)), box.bottom(),
                    box.top};
  const double legend = drawLegend(nullptr, lines, 0.0);
  svg::Document out(kChartWidth, box.bottom() + 42.0 + legend, title, kChartStyle);
  out.text({8, 20}, title, "title");
  drawFrame(out, box, x, y, true);
  out.text({box.left + 0.5 * box.width, box.bottom() + 34}, x_name, "m");
  out.beginClip({box.left, box.top}, {box.width, box.height});
  const std::vector<std::string> classes = classesOf(lines);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    svg::Points points;
    for (const Vector2d& p : lines[i].points) points.push_back({x.pixel(p.x()), y.pixel(p.y())});
    out.polyline(svg::simplify(svg::thinColumns(points), 0.2), classes[i]);
  }
  out.endClip();
  drawLegend(&out, lines, box.bottom() + 40.0);
  return out.str();
}

std::string barChart(const std::string& title, const std::vector<ChartBar>& bars) {
  constexpr double kLeft = 120.0;
  constexpr double kRight = 92.0;  // for the texts
  constexpr double kPitch = 24.0;
  double largest = 1e-9;
  for (const ChartBar& bar : bars) largest = std::max({largest, bar.value, bar.mark});
  const double scale = (kChartWidth - kLeft - kRight) / largest;
  svg::Document out(kChartWidth, kTop + kPitch * static_cast<double>(bars.size()) + 8.0, title,
                    kChartStyle);
  out.text({8, 20}, title, "title");
  double y = kTop;
  for (const ChartBar& bar : bars) {
    out.text({kLeft - 6, y + 15}, svg::shorten(bar.name, 16), "e");
    out.rectangle({kLeft, y + 3}, {std::max(0.5, bar.value * scale), kPitch - 8}, "bar");
    double end = bar.value;
    if (bar.mark >= 0.0) {
      const double px = kLeft + bar.mark * scale;
      out.line({px, y + 2}, {px, y + kPitch - 4}, "mark");
      end = std::max(end, bar.mark);
    }
    out.text({kLeft + end * scale + 6, y + 15}, bar.text, "s");
    y += kPitch;
  }
  return out.str();
}

}  // namespace parkade
