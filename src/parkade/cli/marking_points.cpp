// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/marking_points.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/semantics/bev_scale.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"
#include "parkade/semantics/drawing/draw_slots.hpp"
#include "parkade/semantics/lines/line_extraction.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"
#include "parkade/semantics/slots/slot_marks.hpp"

namespace parkade::cli {
namespace {

using Eigen::Vector2d;

constexpr double kAttitudeSigma = 0.01;  // rad: nobody levelled these pictures

struct Marked {
  std::string name;
  std::vector<Vector2d> points;  // px
};

// How many of the points found are right, and how many of the true ones are found.
struct Count {
  std::string name;
  int truth = 0;
  int told = 0;
  int right = 0;

  void add(const std::vector<Vector2d>& found, const std::vector<Vector2d>& points, double radius) {
    std::vector<bool> taken(points.size(), false);
    truth += static_cast<int>(points.size());
    told += static_cast<int>(found.size());
    for (const Vector2d& p : found) {
      std::size_t best = points.size();
      double nearest = radius;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const double distance = (points[i] - p).norm();
        if (taken[i] || distance > nearest) continue;
        nearest = distance;
        best = i;
      }
      if (best == points.size()) continue;
      taken[best] = true;
      ++right;
    }
  }
  [[nodiscard]] double recall() const { return truth > 0 ? 1.0 * right / truth : 0.0; }
  [[nodiscard]] double precision() const { return told > 0 ? 1.0 * right / told : 0.0; }
};

Result<std::vector<Marked>> readAnnotations(const std::string& path) {
  const Result<std::string> text = readFile(path);
  if (!text) return text.error();
  std::vector<Marked> pictures;
  std::istringstream lines(*text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    Marked one;
    if (!(words >> one.name)) continue;
    for (std::string box; words >> box;) {
      double x0 = 0.0, y0 = 0.0, x1 = 0.0, y1 = 0.0;
      int kind = 0;
      int read = 0;
      if (std::sscanf(box.c_str(), "%lf,%lf,%lf,%lf,%d%n", &x0, &y0, &x1, &y1, &kind, &read) != 5 ||
          read != static_cast<int>(box.size())) {
        return Error{fmt::format("{}:{}: '{}' is no box x0,y0,x1,y1,class", path, number, box)};
      }
      if (kind == 0) one.points.emplace_back(0.5 * (x0 + x1), 0.5 * (y0 + y1));
    }
    pictures.push_back(std::move(one));
  }
  if (pictures.empty()) return Error{fmt::format("{}: names no picture", path)};
  return pictures;
}

void addDistinct(const Vector2d& p, double radius, std::vector<Vector2d>& points) {
  const bool known = std::any_of(points.begin(), points.end(), [&](const Vector2d& other) {
    return (other - p).norm() <= radius;
  });
  if (!known) points.push_back(p);
}

// A square around each true point, a cross on each one found.
void addStrokes(const std::vector<Vector2d>& points, bool square, const BevGeometry& geometry,
                std::vector<LineSegment>& strokes) {
  const double r = square ? 10.0 : 5.0;  // px
  const std::array<Vector2d, 4> around = {Vector2d(-r, -r), Vector2d(r, -r), Vector2d(r, r),
                                          Vector2d(-r, r)};
  for (const Vector2d& p : points) {
    for (std::size_t i = 0; i < 4; ++i) {
      LineSegment stroke;
      stroke.begin = geometry.toGround(p + around[i]);
      stroke.end = geometry.toGround(p + (square ? around[(i + 1) % 4] : Vector2d::Zero()));
      strokes.push_back(stroke);
    }
  }
}

class Scorer {
 public:
  Scorer(const MarkingPointOptions& options, SegmentationNetwork network)
      : options_(options), network_(std::move(network)) {}

  Status add(const Marked& marked) {
    const std::string path = joinPath(options_.folder, marked.name);
    const Result<cv::Mat> image = readImage(path, false);
    if (!image) return image.error();
    const Result<cv::Mat> light = readImage(path, true);
    if (!light) return light.error();
    BevImage whole;
    whole.image = *image;
    whole.geometry = {image->cols, image->rows, options_.width_m / image->cols, Vector2d::Zero()};
    constexpr int kBlack = 8;  // the own car, with the traces of JPEG
    whole.valid = *light >= kBlack;
    BevImage grey = whole;
    grey.image = *light;
    const Result<Found> found = find(whole, grey);
    if (!found) return found.error();
    corners_.add(found->corners, marked.points, options_.radius_px);
    meetings_.add(found->meetings, marked.points, options_.radius_px);
    all_.add(found->all, marked.points, options_.radius_px);
    ++pictures_;
    return options_.pictures ? draw(whole, marked, *found) : Status();
  }

  [[nodiscard]] Status finish() const {
    nlohmann::json metrics;
    nlohmann::json& points = metrics["marking_points"];
    points["pictures"] = pictures_;
    points["radius_px"] = options_.radius_px;
    fmt::print("Marking points within {:.0f} px, {} pictures\n", options_.radius_px, pictures_);
    fmt::print("{:<26} {:>6} {:>6} {:>6} {:>8} {:>10}\n", "", "true", "told", "right", "recall",
               "precision");
    for (const Count* one : {&corners_, &meetings_, &all_}) {
      fmt::print("{:<26} {:>6} {:>6} {:>6} {:>8.3f} {:>10.3f}\n", one->name, one->truth, one->told,
                 one->right, one->recall(), one->precision());
      points[one->name] = {{"true", one->truth},
                           {"told", one->told},
                           {"right", one->right},
                           {"recall", one->recall()},
                           {"precision", one->precision()}};
    }
    return writeFileAtomic(joinPath(options_.out, "metrics.json"), metrics.dump(2) + "\n");
  }

 private:
  struct Found {
    std::vector<SlotObservation> slots;
    std::vector<Vector2d> corners;   // px, of the slots' entrances
    std::vector<Vector2d> meetings;  // px, of slot lines
    std::vector<Vector2d> all;       // px, both and open ends
    cv::Mat labels;                  // at the network's scale
  };

  Result<Found> find(const BevImage& whole, const BevImage& grey) {
    // At the network's scale, at which a run draws features.
    const double scale = network_.classMap().metres_per_px;
    const BevImage bev = scale > 0.0 ? rescaled(whole, scale) : whole;
    const Result<BevLabels> labels = network_.segment(bev);
    if (!labels) return labels.error();
    const Lines lines = extractLines(bev, *labels, kAttitudeSigma);
    const BevViews views = BevViews::fromMiddle(bev.geometry);
    const auto addTo = [&](std::vector<Vector2d>& points, const Vector2d& ground) {
      addDistinct(whole.geometry.toPixel(ground), options_.radius_px, points);
    };
    Found found;
    found.labels = labels->labels;
    found.slots = extractSlots(bev, *labels, lines.segments, views, {kAttitudeSigma, 0.01});
    for (const SlotObservation& slot : found.slots) {
      for (std::size_t k = 0; k < 2; ++k) addTo(found.corners, slot.corners[k]);
    }
    found.all = found.corners;
    const cv::Mat light = rescaled(grey, bev.geometry.metres_per_px).image;
    for (const SlotMark& mark : findSlotMarks(light, LabelProbe(*labels), lines.segments)) {
      if (mark.is_bar) continue;  // no line meets it in sight
      if (!mark.across.isZero() && !mark.is_front_end) addTo(found.meetings, mark.p);
      addTo(found.all, mark.p);
    }
    return found;
  }

  [[nodiscard]] Status draw(const BevImage& whole, const Marked& marked, const Found& found) const {
    std::vector<LineSegment> strokes;
    addStrokes(marked.points, true, whole.geometry, strokes);
    addStrokes(found.meetings, false, whole.geometry, strokes);
    const cv::Mat picture =
        drawSlots(drawLabels(whole.image, found.labels, 0.5), whole.geometry, found.slots, strokes);
    return writeImage(joinPath(options_.out, "pictures/" + marked.name), picture,
                      {.png = false, .jpeg_quality = 90});
  }

  const MarkingPointOptions& options_;
  SegmentationNetwork network_;
  int pictures_ = 0;
  Count corners_{"corners of slots"};
  Count meetings_{"where lines meet"};
  Count all_{"corners and ends of lines"};
};

}  // namespace

Status scoreMarkingPoints(const MarkingPointOptions& options) {
  const Result<std::vector<Marked>> pictures =
      readAnnotations(joinPath(options.folder, "annotations.txt"));
  if (!pictures) return pictures.error();
  Result<SegmentationNetwork> network =
      SegmentationNetwork::loadOrOwn(options.bev_network, kBevNetwork);
  if (!network) return network.error();
  const Status made =
      makeFolders(options.pictures ? joinPath(options.out, "pictures") : options.out);
  if (!made) return made;
  Scorer scorer(options, std::move(network).value());
  for (const Marked& one : *pictures) {
    const Status status = scorer.add(one);
    if (!status) return status;
  }
  return scorer.finish();
}

}  // namespace parkade::cli
