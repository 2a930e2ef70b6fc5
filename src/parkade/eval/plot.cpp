// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/plot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "parkade/eval/svg.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kPlotWidth = 1280.0;
constexpr double kHeight = 820.0;
constexpr double kSimplifyPx = 0.3;
// Below this coverage the reference is cut to the estimate's time: the estimate would be a speck.
constexpr double kLeastCoverage = 0.2;
// Rounding errors are not blown up to the height of the picture; m or deg.
constexpr double kLeastErrorAxis = 1e-3;

constexpr const char* kPlotStyle =
    "text{font-family:'DejaVu Sans',Verdana,sans-serif;font-size:12px;fill:#333}\n"
    ".title{font-size:17px;font-weight:bold;fill:#111}\n"
    ".head{font-size:13px;font-weight:bold;fill:#222}\n"
    ".m{text-anchor:middle}.e{text-anchor:end}.s{text-anchor:start}\n"
    ".mean{text-anchor:end;fill:#b3560a;stroke:#fff;stroke-width:4px;paint-order:stroke}\n"
    "path,polyline{fill:none}\n"
    ".grid{stroke:#e4e4e4;stroke-width:1}\n"
    ".frame{stroke:#8a8a8a;stroke-width:1;fill:none}\n"
    ".ref{stroke:#b4b4b4;stroke-width:4.5;stroke-linejoin:round;stroke-linecap:round}\n"
    ".est{stroke:#1660b5;stroke-width:1.5;stroke-linejoin:round;stroke-linecap:round}\n"
    ".rms{stroke:#d9730d;stroke-width:1.3;stroke-dasharray:6 4}\n"
    ".start{fill:#2a9d3a;stroke:#fff;stroke-width:1.5}\n"
    ".end{fill:#111;stroke:#fff;stroke-width:1.5}\n"
    ".worst{stroke:#c8102e;stroke-width:2.5}\n";

struct Panel {
  double left;
  double top;
  double width;
  double height;

  [[nodiscard]] Vector2d corner() const { return {left, top}; }
  [[nodiscard]] Vector2d size() const { return {width, height}; }
  [[nodiscard]] double right() const { return left + width; }
  [[nodiscard]] double bottom() const { return top + height; }
};

constexpr Panel kTopView{78.0, 118.0, 560.0, 640.0};
constexpr Panel kErrorBox{738.0, 118.0, 512.0, 176.0};
constexpr Panel kRotationBox{738.0, 350.0, 512.0, 176.0};
constexpr Panel kProfileBox{738.0, 582.0, 512.0, 176.0};

// Which coordinates go right, up, and into the height profile.
struct View {
  int right = 0;
  int up = 1;
  int height = 2;
};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double size() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
};

Range rangeOf(const Trajectory& trajectory, int coordinate) {
  Range range;
  for (const auto& pose : trajectory) range.add(pose.T_world_body.translation()[coordinate]);
  return range;
}

View chooseView(PlotPlane plane, const Trajectory& reference) {
  if (plane == PlotPlane::kAuto) {
    const bool flat_in_y = rangeOf(reference, 1).size() < 0.25 * rangeOf(reference, 2).size();
    plane = flat_in_y ? PlotPlane::kXz : PlotPlane::kXy;
  }
  if (plane == PlotPlane::kXz) return {0, 2, 1};
  if (plane == PlotPlane::kYz) return {1, 2, 0};
  return {0, 1, 2};
}

const char* axisName(int coordinate) {
  constexpr const char* kNames[] = {"x", "y", "z"};
  return kNames[coordinate];
}

std::string brief(double value) {
  return std::abs(value) < 1e-9 ? "0" : fmt::format("{:.4g}", value);
}

// The last two parts of a path say enough for a title.
std::string shortName(const std::string& path) {
  const auto last = path.find_last_of('/', path.size() > 1 ? path.size() - 2 : 0);
  const auto before =
      last == std::string::npos || last == 0 ? last : path.find_last_of('/', last - 1);
  const bool is_short = before == std::string::npos || last == 0;
  return svg::shorten(is_short ? path : path.substr(before + 1), 50);
}

Trajectory cut(const Trajectory& trajectory, TimeNs begin, TimeNs end) {
  Trajectory result;
  for (const auto& pose : trajectory) {
    if (pose.t_ns >= begin && pose.t_ns <= end) result.push_back(pose);
  }
  return result;
}

// Calls draw(points) for every stretch of the trajectory without a hole.
template <class ToPoint, class Draw>
void eachStretch(const Trajectory& trajectory, double max_gap_s, const ToPoint& to_point,
                 const Draw& draw) {
  const TimeNs longest = longestStep(trajectory, max_gap_s);
  svg::Points points;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    if (i > 0 && trajectory[i].t_ns - trajectory[i - 1].t_ns > longest) {
      draw(points);
      points.clear();
    }
    points.push_back(to_point(i));
  }
  draw(points);
}

// One picture of one evaluation.
class Plot {
 public:
  Plot(const Evaluation& evaluation, const Trajectory& reference, const EvaluationLabels& labels,
       PlotPlane plane)
      : e_(evaluation),
        labels_(labels),
        reference_(evaluation.pairs.coverage >= kLeastCoverage
                       ? reference
                       : cut(reference, evaluation.estimate.front().t_ns,
                             evaluation.estimate.back().t_ns)),
        view_(chooseView(plane, evaluation.pairs.reference)),
        svg_(kPlotWidth, kHeight, fmt::format("{} against {}", labels.estimate, labels.reference),
             kPlotStyle) {
    start_ns_ = e_.estimate.front().t_ns;
    TimeNs end_ns = e_.estimate.back().t_ns;
    if (!reference_.empty()) {
      start_ns_ = std::min(start_ns_, reference_.front().t_ns);
      end_ns = std::max(end_ns, reference_.back().t_ns);
    }
    end_time_ = std::max(time(end_ns), 1e-3);
    const auto& errors = e_.absolute.translation;
    worst_ =
        static_cast<std::size_t>(std::max_element(errors.begin(), errors.end()) - errors.begin());
  }

  std::string draw() {
    header();
    topView();
    errorOverTime(kErrorBox, "Position error (m)", e_.absolute.translation, e_.ape.rmse, true);
    errorOverTime(kRotationBox, "Rotation error (deg)", e_.absolute.rotation_deg,
                  e_.ape_rotation_deg.rmse, false);
    profile();
    return svg_.str();
  }

 private:
  // Seconds from the start, or the number of the pose.
  [[nodiscard]] double time(TimeNs t_ns) const {
    return labels_.by_index ? static_cast<double>(t_ns) / static_cast<double>(labels_.index_step_ns)
                            : toSeconds(t_ns - start_ns_);
  }

  void header() {
    svg_.text(
        {28, 34},
        fmt::format("{} against {}", shortName(labels_.estimate), shortName(labels_.reference)),
        "title");
    std::string line =
        fmt::format("APE rmse {} m, {} deg", brief(e_.ape.rmse), brief(e_.ape_rotation_deg.rmse));
    if (e_.rpe.count > 0) {
      line += fmt::format(" \u2022 RPE rmse {} m over {:g} {}", brief(e_.rpe.rmse),
                          e_.options.rpe.delta,
                          e_.options.rpe.unit == "f" ? "frames" : e_.options.rpe.unit);
    }
    if (e_.drift.segments > 0) line += fmt::format(" \u2022 drift {:.3g} %", e_.drift.percent);
    line += fmt::format(" \u2022 {} poses matched, coverage {:.1f} % \u2022 alignment {}",
                        e_.pairs.size(), 100.0 * e_.pairs.coverage, e_.options.align);
    if (e_.options.align == "sim3") line += fmt::format(", scale {:.4f}", e_.alignment.scale);
    svg_.text({28, 58}, line, "s");
  }

  void frame(const Panel& box, const svg::Axis& x, const svg::Axis& y, int x_ticks, int y_ticks) {
    const auto horizontal = svg::ticks(x.low, x.high, x_ticks);
    for (const double value : horizontal.values) {
      const double px = x.pixel(value);
      svg_.line({px, box.top}, {px, box.bottom()}, "grid");
      svg_.text({px, box.bottom() + 17}, fmt::format("{:.{}f}", value, horizontal.decimals), "m");
    }
    const auto vertical = svg::ticks(y.low, y.high, y_ticks);
    for (const double value : vertical.values) {
      const double px = y.pixel(value);
      svg_.line({box.left, px}, {box.right(), px}, "grid");
      svg_.text({box.left - 7, px + 4}, fmt::format("{:.{}f}", value, vertical.decimals), "e");
    }
    svg_.rectangle(box.corner(), box.size(), "frame");
  }

  [[nodiscard]] Vector2d onMap(const SE3& T, const svg::Axis& x, const svg::Axis& y) const {
    return {x.pixel(T.translation()[view_.right]), y.pixel(T.translation()[view_.up])};
  }

  void topView() {
    Range x_range = rangeOf(e_.estimate, view_.right);
    Range y_range = rangeOf(e_.estimate, view_.up);
    for (const auto& pose : reference_) {
      x_range.add(pose.T_world_body.translation()[view_.right]);
      y_range.add(pose.T_world_body.translation()[view_.up]);
    }
    // Equal axes: the same metres per pixel both ways, with a margin of 5 %.
    const double m_per_px = std::max(
        {1.1 * x_range.size() / kTopView.width, 1.1 * y_range.size() / kTopView.height, 1e-6});
    const double half_width = 0.5 * kTopView.width * m_per_px;
    const double half_height = 0.5 * kTopView.height * m_per_px;
    const svg::Axis x{x_range.middle() - half_width, x_range.middle() + half_width, kTopView.left,
                      kTopView.right()};
    const svg::Axis y{y_range.middle() - half_height, y_range.middle() + half_height,
                      kTopView.bottom(), kTopView.top};
    frame(kTopView, x, y, 6, 7);
    svg_.text({kTopView.left + 0.5 * kTopView.width, kTopView.bottom() + 38},
              fmt::format("{} (m)", axisName(view_.right)), "m");
    svg_.text({kTopView.left - 52, kTopView.top + 0.5 * kTopView.height},
              fmt::format("{} (m)", axisName(view_.up)), "m", true);

    svg_.beginClip(kTopView.corner(), kTopView.size());
    const double gap_s = e_.options.association.max_gap_s;
    const auto drawMap = [&](const Trajectory& trajectory, const char* css_class) {
      eachStretch(
          trajectory, gap_s, [&](std::size_t i) { return onMap(trajectory[i].T_world_body, x, y); },
          [&](const svg::Points& points) {
            svg_.polyline(svg::simplify(points, kSimplifyPx), css_class);
          });
    };
    drawMap(reference_, "ref");
    drawMap(e_.estimate, "est");
    svg_.circle(onMap(e_.estimate.front().T_world_body, x, y), 6, "start");
    svg_.rectangle(onMap(e_.estimate.back().T_world_body, x, y) - Vector2d(5, 5), {10, 10}, "end");
    svg_.cross(onMap(e_.pairs.estimate[worst_].T_world_body, x, y), 6, "worst");
    svg_.endClip();
    legend();
  }

  void legend() {
    const double y = kTopView.top - 22;
    double x = kTopView.left;
    const auto entry = [&](const char* name, double width, const auto& mark) {
      mark(x);
      svg_.text({x + width + 6, y + 4}, name, "s");
      x += width + 24 + 7.3 * static_cast<double>(std::char_traits<char>::length(name));
    };
    entry("reference", 26, [&](double left) { svg_.line({left, y}, {left + 26, y}, "ref"); });
    entry("estimate", 26, [&](double left) { svg_.line({left, y}, {left + 26, y}, "est"); });
    entry("start", 12, [&](double left) { svg_.circle({left + 6, y}, 6, "start"); });
    entry("end", 12, [&](double left) { svg_.rectangle({left + 1, y - 5}, {10, 10}, "end"); });
    entry("largest error", 12, [&](double left) { svg_.cross({left + 6, y}, 6, "worst"); });
  }

  [[nodiscard]] svg::Axis timeAxis(const Panel& box) const {
    return {labels_.by_index ? time(start_ns_) : 0.0, end_time_, box.left, box.right()};
  }

  void timeCaption(const Panel& box) {
    svg_.text({box.left + 0.5 * box.width, box.bottom() + 38},
              labels_.by_index ? "number of the pose" : "time from the start (s)", "m");
  }

  void errorOverTime(const Panel& box, const char* title, const std::vector<double>& errors,
                     double rmse, bool mark_worst) {
    const double largest = *std::max_element(errors.begin(), errors.end());
    const svg::Axis x = timeAxis(box);
    const svg::Axis y{0.0, svg::roundUp(std::max(1.05 * largest, kLeastErrorAxis)), box.bottom(),
                      box.top};
    frame(box, x, y, 6, 4);
    svg_.text({box.left, box.top - 9}, title, "head");
    const Trajectory& poses = e_.pairs.estimate;
    svg_.beginClip(box.corner(), box.size());
    const auto point = [&](std::size_t i) {
      return Vector2d(x.pixel(time(poses[i].t_ns)), y.pixel(errors[i]));
    };
    eachStretch(poses, e_.options.association.max_gap_s, point, [&](const svg::Points& points) {
      svg_.polyline(svg::simplify(svg::thinColumns(points), kSimplifyPx), "est");
    });
    svg_.line({box.left, y.pixel(rmse)}, {box.right(), y.pixel(rmse)}, "rms");
    if (mark_worst) svg_.cross(point(worst_), 5, "worst");
    svg_.endClip();
    svg_.text({box.right(), box.top - 9},
              fmt::format("rmse {} \u2022 max {}", brief(rmse), brief(largest)), "mean");
  }

  void profile() {
    const Panel& box = kProfileBox;
    Range range = rangeOf(e_.estimate, view_.height);
    for (const auto& pose : reference_) range.add(pose.T_world_body.translation()[view_.height]);
    // A flat floor stays flat: noise below a few centimetres is not blown up.
    const double half = std::max(0.55 * range.size(), 0.05);
    const svg::Axis x = timeAxis(box);
    const svg::Axis y{range.middle() - half, range.middle() + half, box.bottom(), box.top};
    frame(box, x, y, 6, 4);
    svg_.text({box.left, box.top - 9},
              fmt::format("Height: {} over time (m)", axisName(view_.height)), "head");
    timeCaption(box);
    svg_.beginClip(box.corner(), box.size());
    const auto drawProfile = [&](const Trajectory& trajectory, const char* css_class) {
      eachStretch(
          trajectory, e_.options.association.max_gap_s,
          [&](std::size_t i) {
            return Vector2d(x.pixel(time(trajectory[i].t_ns)),
                            y.pixel(trajectory[i].T_world_body.translation()[view_.height]));
          },
          [&](const svg::Points& points) {
            svg_.polyline(svg::simplify(svg::thinColumns(points), kSimplifyPx), css_class);
          });
    };
    drawProfile(reference_, "ref");
    drawProfile(e_.estimate, "est");
    svg_.endClip();
  }

  const Evaluation& e_;
  const EvaluationLabels& labels_;
  Trajectory reference_;
  View view_;
  svg::Document svg_;
  TimeNs start_ns_ = 0;
  double end_time_ = 1.0;
  std::size_t worst_ = 0;
};

}  // namespace

std::string evaluationSvg(const Evaluation& evaluation, const Trajectory& reference,
                          const EvaluationLabels& labels, PlotPlane plane) {
  return Plot(evaluation, reference, labels, plane).draw();
}

}  // namespace parkade
