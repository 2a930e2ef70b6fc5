// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/paint_strokes.hpp"

#include <array>
#include <cstdint>
#include <vector>

#include "parkade/semantics/marking_pieces.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {
namespace {

bool isPaint(std::uint8_t label) {
  const auto c = static_cast<SemanticClass>(label);
  return c != SemanticClass::kFloor && c != SemanticClass::kWheelStop && !hidesGround(c);
}

// Pieces of paint of one class, connected over edges and corners of pixels.
class Pieces {
 public:
  explicit Pieces(const cv::Mat& labels) : ids_(labels.size(), CV_32SC1, cv::Scalar(kNone)) {
    for (int v = 0; v < labels.rows; ++v) {
      for (int u = 0; u < labels.cols; ++u) {
        if (isPaint(labels.at<std::uint8_t>(v, u)) && id(v, u) == kNone) fill(labels, v, u);
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

}  // namespace

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
