// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/lines/line_chains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "parkade/semantics/markings/marking_pieces.hpp"

namespace parkade {
namespace {

constexpr int kMaxGap = 4;            // rows that a line may miss
constexpr std::size_t kFitReach = 6;  // runs on each side of a local fit

bool isLine(std::uint8_t label) {
  return label == static_cast<std::uint8_t>(SemanticClass::kSlotLine) ||
         label == static_cast<std::uint8_t>(SemanticClass::kLaneLine) ||
         label == static_cast<std::uint8_t>(SemanticClass::kStopLine);
}

// A chain that may still grow, with where it is expected.
struct Growing {
  LineChain chain;
  double slope = 0.0;
  double width = 0.0;

  [[nodiscard]] double mismatch(const LineRun& run) const {
    const LineRun& last = chain.runs.back();
    const int gap = run.row - last.row;
    if (std::abs(run.width - width) > std::max(2.0, 0.4 * width)) return 1e9;
    const bool known = chain.runs.size() >= 5;
    const double expected = last.center + (known ? slope * gap : 0.0);
    const double allowed = known ? 1.0 + 0.3 * gap : 0.8 + 1.1 * gap;
    const double off = std::abs(run.center - expected);
    return off <= allowed ? off : 1e9;
  }
  void add(const LineRun& run) {
    chain.runs.push_back(run);
    const auto n = static_cast<double>(std::min<std::size_t>(chain.runs.size(), 10));
    width += (run.width - width) / n;
    double center = 0.0;
    chain.fitAround(chain.runs.size() - 1, center, slope);
  }
};

std::vector<std::pair<LineRun, SemanticClass>> runsOf(const cv::Mat& labels, int row,
                                                      double max_run) {
  std::vector<std::pair<LineRun, SemanticClass>> runs;
  const std::uint8_t* label = labels.ptr<std::uint8_t>(row);
  for (int u = 0; u < labels.cols;) {
    if (!isLine(label[u])) {
      ++u;
      continue;
    }
    const int begin = u;
    while (u < labels.cols && label[u] == label[begin]) ++u;
    if (u - begin > max_run) continue;
    LineRun run;
    run.row = row;
    run.center = 0.5 * (begin + u - 1);
    run.width = u - begin;
    run.hidden = begin == 0 || u == labels.cols ||
                 hidesFloor(static_cast<SemanticClass>(label[begin - 1])) ||
                 hidesFloor(static_cast<SemanticClass>(label[u]));
    runs.emplace_back(run, static_cast<SemanticClass>(label[begin]));
  }
  return runs;
}

}  // namespace

bool hidesFloor(SemanticClass semantic_class) {
  return hidesGround(semantic_class) || semantic_class == SemanticClass::kWheelStop;
}

void LineChain::fitAround(std::size_t index, double& center, double& slope) const {
  const std::size_t first = index > kFitReach ? index - kFitReach : 0;
  const std::size_t last = std::min(runs.size() - 1, index + kFitReach);
  double n = 0.0;
  double r = 0.0;
  double c = 0.0;
  double rr = 0.0;
  double rc = 0.0;
  for (std::size_t i = first; i <= last; ++i) {
    const double row = runs[i].row - runs[index].row;
    n += 1.0;
    r += row;
    c += runs[i].center;
    rr += row * row;
    rc += row * runs[i].center;
  }
  const double spread = n * rr - r * r;
  slope = spread > 0.0 ? (n * rc - r * c) / spread : 0.0;
  center = (c - slope * r) / n;
}

std::vector<LineChain> followLines(const cv::Mat& labels, double max_run) {
  std::vector<LineChain> chains;
  std::vector<Growing> growing;
  const auto finish = [&chains](Growing& one) {
    constexpr std::size_t kLeastRuns = 5;
    if (one.chain.runs.size() < kLeastRuns) return;
    const int length = one.chain.runs.back().row - one.chain.runs.front().row + 1;
    if (length >= 1.2 * one.width) chains.push_back(std::move(one.chain));
  };
  for (int row = 0; row < labels.rows; ++row) {
    for (const auto& [run, semantic_class] : runsOf(labels, row, max_run)) {
      Growing* best = nullptr;
      double best_off = 1e8;
      for (Growing& one : growing) {
        if (one.chain.semantic_class != semantic_class || one.chain.runs.back().row == row)
          continue;
        const double off = one.mismatch(run);
        if (off >= best_off) continue;
        best_off = off;
        best = &one;
      }
      if (best == nullptr) {
        growing.emplace_back();
        best = &growing.back();
        best->chain.semantic_class = semantic_class;
      }
      best->add(run);
    }
    const auto done = std::stable_partition(
        growing.begin(), growing.end(),
        [row](const Growing& one) { return row - one.chain.runs.back().row < kMaxGap; });
    std::for_each(done, growing.end(), finish);
    growing.erase(done, growing.end());
  }
  std::for_each(growing.begin(), growing.end(), finish);
  return chains;
}

}  // namespace parkade
