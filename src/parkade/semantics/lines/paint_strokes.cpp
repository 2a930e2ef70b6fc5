// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/paint_strokes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "parkade/core/median.hpp"
#include "parkade/types/semantic_class.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {
namespace {

// Pieces of paint of one class, connected over edges and corners of pixels.
class Pieces {
 public:
  explicit Pieces(const cv::Mat& labels) : ids_(labels.size(), CV_32SC1, cv::Scalar(kNone)) {
    for (int v = 0; v < labels.rows; ++v) {
      for (int u = 0; u < labels.cols; ++u) {
        const auto c = static_cast<SemanticClass>(labels.at<std::uint8_t>(v, u));
        if (isPaint(c) && id(v, u) == kNone) fill(labels, v, u);
      }
    }
  }
  // The largest piece of another class that each one touches, or kNone.
  [[nodiscard]] std::vector<int> largestNeighbours() const {
    std::vector<int> largest(areas_.size(), kNone);
    const auto meet = [&](int a, int b) {
      int& known = largest[static_cast<std::size_t>(a)];
      if (known == kNone || area(b) > area(known)) known = b;
    };
    for (int v = 0; v < ids_.rows; ++v) {
      for (int u = 0; u < ids_.cols; ++u) {
        const int a = id(v, u);
        if (a == kNone) continue;
        for (const auto& [dv, du] : kHalf) {
          if (!inside(v + dv, u + du)) continue;
          const int b = id(v + dv, u + du);
          if (b == kNone || b == a) continue;
          meet(a, b);
          meet(b, a);
        }
      }
    }
    return largest;
  }
  [[nodiscard]] int count() const { return static_cast<int>(areas_.size()); }
  [[nodiscard]] int area(int piece) const { return areas_[static_cast<std::size_t>(piece)]; }
  [[nodiscard]] std::uint8_t label(int piece) const {
    return labels_[static_cast<std::size_t>(piece)];
  }
  [[nodiscard]] int id(int v, int u) const { return ids_.at<int>(v, u); }

  static constexpr int kNone = -1;

 private:
  // Half of the eight neighbours: each pair is met once.
  static constexpr std::array<std::array<int, 2>, 4> kHalf = {{{0, 1}, {1, -1}, {1, 0}, {1, 1}}};

  [[nodiscard]] bool inside(int v, int u) const {
    return v >= 0 && u >= 0 && v < ids_.rows && u < ids_.cols;
  }
  void fill(const cv::Mat& labels, int v0, int u0) {
    const int piece = count();
    const std::uint8_t label = labels.at<std::uint8_t>(v0, u0);
    int area = 0;
    std::vector<std::array<int, 2>> open = {{v0, u0}};
    ids_.at<int>(v0, u0) = piece;
    while (!open.empty()) {
      const auto [v, u] = open.back();
      open.pop_back();
      ++area;
      for (int dv = -1; dv <= 1; ++dv) {
        for (int du = -1; du <= 1; ++du) {
          if (!inside(v + dv, u + du) || id(v + dv, u + du) != kNone) continue;
          if (labels.at<std::uint8_t>(v + dv, u + du) != label) continue;
          ids_.at<int>(v + dv, u + du) = piece;
          open.push_back({v + dv, u + du});
        }
      }
    }
    areas_.push_back(area);
    labels_.push_back(label);
  }

  cv::Mat ids_;
  std::vector<int> areas_;
  std::vector<std::uint8_t> labels_;
};

// Pixels in a row through (v, u) that are marked, in a direction and against it, as a length in px.
double runThrough(const cv::Mat& marked, int v, int u, int dv, int du) {
  int count = 1;
  for (const int sign : {-1, 1}) {
    int y = v + sign * dv;
    int x = u + sign * du;
    while (y >= 0 && x >= 0 && y < marked.rows && x < marked.cols &&
           marked.at<std::uint8_t>(y, x) != 0) {
      ++count;
      y += sign * dv;
      x += sign * du;
    }
  }
  return dv != 0 && du != 0 ? count * M_SQRT2 : count;
}

// The least of the runs through a pixel: how thick the paint is there.
double thicknessAt(const cv::Mat& marked, int v, int u) {
  return std::min({runThrough(marked, v, u, 0, 1), runThrough(marked, v, u, 1, 0),
                   runThrough(marked, v, u, 1, 1), runThrough(marked, v, u, 1, -1)});
}

// Strokes of one width everywhere, but where they meet; an arrow's head is thicker than its shaft.
bool isPlainStroke(const cv::Mat& marked, const std::vector<cv::Point>& pixels, double pixel) {
  constexpr double kWidest = 0.26;   // m
  constexpr double kThicker = 1.6;   // times the usual
  constexpr double kMeeting = 0.12;  // share of the paint
  std::vector<double> thickness;
  for (const cv::Point& p : pixels) thickness.push_back(thicknessAt(marked, p.y, p.x));
  constexpr double kLeast = 3.0;  // px: thinner strokes' widths waver
  const double usual = std::max(kLeast, median(thickness));
  if (usual * pixel > kWidest) return false;
  const auto thick = std::count_if(thickness.begin(), thickness.end(),
                                   [usual](double t) { return t > kThicker * usual; });
  return static_cast<double>(thick) <= kMeeting * static_cast<double>(thickness.size());
}

// Paint that hangs together, some of it of a class that may be mistaken for slot line.
struct DoubtedPiece {
  std::vector<cv::Point> pixels;  // of the paint
  int doubted = 0;                // of them of that class
  double below = 0.0;             // how far slot line lies below that class, summed over those

  void becomes(int label, cv::Mat& labels) const {
    for (const cv::Point& p : pixels) labels.at<std::uint8_t>(p) = static_cast<std::uint8_t>(label);
  }
};

// What hangs together in area; paint: its pixels that are paint.
std::vector<DoubtedPiece> doubtedPieces(const cv::Mat& area, const cv::Mat& paint,
                                        const cv::Mat& labels, int doubted,
                                        const cv::Mat& slot_line) {
  cv::Mat piece_of;
  const int count = cv::connectedComponents(area, piece_of, 8, CV_32S);
  std::vector<DoubtedPiece> pieces(static_cast<std::size_t>(count));
  for (int v = 0; v < labels.rows; ++v) {
    for (int u = 0; u < labels.cols; ++u) {
      if (paint.at<std::uint8_t>(v, u) == 0) continue;
      DoubtedPiece& piece = pieces[static_cast<std::size_t>(piece_of.at<int>(v, u))];
      piece.pixels.emplace_back(u, v);
      if (labels.at<std::uint8_t>(v, u) != doubted) continue;
      ++piece.doubted;
      piece.below += (255.0 - slot_line.at<std::uint8_t>(v, u)) / kEvidencePerLogOdds;
    }
  }
  return pieces;
}

}  // namespace

void tellStrokesFromArrows(const cv::Mat& slot_line, double metres_per_px, cv::Mat& labels) {
  constexpr auto kArrow = static_cast<int>(SemanticClass::kArrow);
  constexpr auto kSlot = static_cast<int>(SemanticClass::kSlotLine);
  constexpr int kLeast = 20;          // px of arrow
  constexpr double kDoubtful = 4.5;   // log-odds, on average
  constexpr double kShare = 0.1;      // of slot line in what hangs together
  constexpr double kGap = 0.16;       // m of floor within what hangs together
  constexpr double kBothWays = 0.45;  // m that a T or L measures at least
  const cv::Mat arrow = labels == kArrow;
  if (slot_line.empty() || cv::countNonZero(arrow) < kLeast) return;
  const cv::Mat marked = arrow | (labels == kSlot);
  const int reach = std::max(1, static_cast<int>(std::lround(0.5 * kGap / metres_per_px)));
  cv::Mat near;
  cv::dilate(marked, near, cv::Mat::ones(2 * reach + 1, 2 * reach + 1, CV_8UC1));
  const std::vector<DoubtedPiece> pieces = doubtedPieces(near, marked, labels, kArrow, slot_line);
  for (const DoubtedPiece& piece : pieces) {
    if (piece.doubted < kLeast || piece.below > kDoubtful * piece.doubted) continue;
    const cv::Size2f box = cv::minAreaRect(piece.pixels).size;
    const bool both_ways = std::min(box.width, box.height) * metres_per_px >= kBothWays;
    const int slots = static_cast<int>(piece.pixels.size()) - piece.doubted;
    const bool meets = slots >= kShare * static_cast<double>(piece.pixels.size());
    if ((!both_ways && !meets) || !isPlainStroke(marked, piece.pixels, metres_per_px)) continue;
    piece.becomes(kSlot, labels);
  }
}

void tellSlotsFromLanes(const cv::Mat& slot_line, double metres_per_px, cv::Mat& labels) {
  constexpr auto kLane = static_cast<int>(SemanticClass::kLaneLine);
  constexpr auto kSlot = static_cast<int>(SemanticClass::kSlotLine);
  constexpr int kLeast = 8;           // px of lane line
  constexpr int kTouch = 4;           // px of them beside a slot's line
  constexpr double kDoubtful = 4.0;   // log-odds, on average, where they touch
  constexpr double kDoubtfulT = 3.0;  // the same of what has a T's or an L's shape
  constexpr double kBothWays = 0.35;  // m that such measure at least
  constexpr double kWidest = 0.9;     // m: larger ones turn a corner of the aisle
  if (slot_line.empty()) return;
  const cv::Mat lane = labels == kLane;
  if (cv::countNonZero(lane) == 0) return;
  cv::Mat near;
  cv::dilate(labels == kSlot, near, cv::Mat::ones(5, 5, CV_8UC1));
  for (const DoubtedPiece& piece : doubtedPieces(lane, lane, labels, kLane, slot_line)) {
    if (piece.doubted < kLeast) continue;
    const double below = piece.below / piece.doubted;
    if (below > kDoubtful) continue;
    const cv::Size2f box = cv::minAreaRect(piece.pixels).size;
    const double narrow = std::min(box.width, box.height) * metres_per_px;
    const bool t_shaped = narrow > kBothWays && narrow < kWidest && below < kDoubtfulT &&
                          isPlainStroke(lane, piece.pixels, metres_per_px);
    const auto touching =
        std::count_if(piece.pixels.begin(), piece.pixels.end(),
                      [&near](const cv::Point& p) { return near.at<std::uint8_t>(p) != 0; });
    if (!t_shaped && touching < kTouch) continue;
    piece.becomes(kSlot, labels);
  }
}

void uniteStrokes(cv::Mat& labels, double metres_per_px) {
  constexpr double kLargest = 0.1;  // m^2 of a piece that may be mistaken
  constexpr int kTimes = 2;
  const Pieces pieces(labels);
  const std::vector<int> neighbours = pieces.largestNeighbours();
  std::vector<std::uint8_t> told(static_cast<std::size_t>(pieces.count()));
  for (int i = 0; i < pieces.count(); ++i) {
    const int other = neighbours[static_cast<std::size_t>(i)];
    const bool mistaken = other != Pieces::kNone &&
                          pieces.area(i) * metres_per_px * metres_per_px <= kLargest &&
                          pieces.area(other) >= kTimes * pieces.area(i);
    told[static_cast<std::size_t>(i)] = pieces.label(mistaken ? other : i);
  }
  for (int v = 0; v < labels.rows; ++v) {
    for (int u = 0; u < labels.cols; ++u) {
      const int i = pieces.id(v, u);
      if (i != Pieces::kNone) labels.at<std::uint8_t>(v, u) = told[static_cast<std::size_t>(i)];
    }
  }
}

}  // namespace parkade
