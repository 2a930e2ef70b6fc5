// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/label_confusion.hpp"

#include <algorithm>
#include <limits>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

std::size_t indexOf(SemanticClass semantic_class) {
  return static_cast<std::size_t>(semantic_class);
}

}  // namespace

void LabelConfusion::add(const cv::Mat& truth, const cv::Mat& found, const cv::Mat& mask) {
  PARKADE_CHECK(truth.type() == CV_8UC1 && found.type() == CV_8UC1, "labels of types {} and {}",
                truth.type(), found.type());
  PARKADE_CHECK(truth.size() == found.size() && (mask.empty() || mask.size() == truth.size()),
                "labels of {} x {} and {} x {}", truth.cols, truth.rows, found.cols, found.rows);
  for (int v = 0; v < truth.rows; ++v) {
    const std::uint8_t* t = truth.ptr<std::uint8_t>(v);
    const std::uint8_t* f = found.ptr<std::uint8_t>(v);
    const std::uint8_t* m = mask.empty() ? nullptr : mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < truth.cols; ++u) {
      if (m != nullptr && m[u] == 0) continue;
      PARKADE_CHECK(t[u] < kNumSemanticClasses && f[u] < kNumSemanticClasses, "labels {} and {}",
                    t[u], f[u]);
      ++counts_[t[u]][f[u]];
    }
  }
}

void LabelConfusion::add(const LabelConfusion& other) {
  for (std::size_t t = 0; t < counts_.size(); ++t) {
    for (std::size_t f = 0; f < counts_.size(); ++f) counts_[t][f] += other.counts_[t][f];
  }
}

std::int64_t LabelConfusion::count(SemanticClass truth, SemanticClass found) const {
  return counts_[indexOf(truth)][indexOf(found)];
}

std::int64_t LabelConfusion::truePixels(SemanticClass truth) const {
  std::int64_t sum = 0;
  for (const std::int64_t n : counts_[indexOf(truth)]) sum += n;
  return sum;
}

double LabelConfusion::iou(SemanticClass semantic_class) const {
  return iou(std::vector<SemanticClass>{semantic_class});
}

double LabelConfusion::iou(const std::vector<SemanticClass>& classes) const {
  std::array<bool, kNumSemanticClasses> inside{};
  for (const SemanticClass one : classes) inside[indexOf(one)] = true;
  std::int64_t both = 0;
  std::int64_t either = 0;
  std::int64_t occurs = 0;
  for (std::size_t t = 0; t < counts_.size(); ++t) {
    for (std::size_t f = 0; f < counts_.size(); ++f) {
      if (inside[t]) occurs += counts_[t][f];
      if (inside[t] && inside[f]) both += counts_[t][f];
      if (inside[t] || inside[f]) either += counts_[t][f];
    }
  }
  return occurs == 0 ? std::numeric_limits<double>::quiet_NaN()
                     : static_cast<double>(both) / static_cast<double>(either);
}

double LabelConfusion::meanIou(const std::vector<SemanticClass>& classes) const {
  double sum = 0.0;
  int count = 0;
  for (const SemanticClass one : classes) {
    if (truePixels(one) == 0) continue;
    sum += iou(one);
    ++count;
  }
  return count == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / count;
}

}  // namespace parkade
