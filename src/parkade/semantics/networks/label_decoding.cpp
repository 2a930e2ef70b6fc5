// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/networks/label_decoding.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"
#include "parkade/core/isa_clones.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {
namespace {

// Keeps the larger of best and row, and which it was.
PARKADE_ISA_CLONES
void keepBest(const float* __restrict row, std::int32_t value, int width, float* __restrict best,
              std::int32_t* __restrict label) {
  for (int u = 0; u < width; ++u) {
    const bool larger = row[u] > best[u];
    label[u] = larger ? value : label[u];
    best[u] = larger ? row[u] : best[u];
  }
}

// Adds exp(row - best), whose argument is at most 0, within 0.1 %: 2^(x / ln 2), the power of the
// fraction by a cubic, the whole part put into the exponent.
PARKADE_ISA_CLONES
void addExponentials(const float* __restrict row, const float* __restrict best, int width,
                     float* __restrict total) {
  for (int u = 0; u < width; ++u) {
    const float x = row[u] - best[u];
    const float y = (x < -60.0F ? -60.0F : x) * 1.44269504F;
    const auto whole = static_cast<std::int32_t>(y - 1.0F);  // towards zero: y - 1 <= whole <= y
    const float part = y - static_cast<float>(whole);
    const float power = 1.0F + part * (0.6951F + part * (0.2276F + part * 0.0780F));
    total[u] += power * std::bit_cast<float>((whole + 127) << 23);
  }
}

// Evidence as in BevLabels: how far row lies below best. Keeps the larger.
PARKADE_ISA_CLONES
void keepEvidence(const float* __restrict row, const float* __restrict best, int width,
                  std::int32_t* __restrict evidence) {
  constexpr auto kStep = static_cast<float>(kEvidencePerLogOdds);
  for (int u = 0; u < width; ++u) {
    const float below = kStep * (best[u] - row[u]);
    const std::int32_t value =
        255 - static_cast<std::int32_t>((below < 255.0F ? below : 255.0F) + 0.5F);
    evidence[u] = value > evidence[u] ? value : evidence[u];
  }
}

bool isSlotLine(SemanticClass c) {
  return c == SemanticClass::kSlotLine;
}

// Rows of logits, one per channel, of a row of pixels.
class RowDecoder {
 public:
  explicit RowDecoder(int width) : best_(width), total_(width), label_(width), evidence_(width) {}

  // Into every stride-th pixel of a row of out, from column on.
  void decode(const std::vector<const float*>& rows, const std::vector<SemanticClass>& classes,
              DecodedLabels& out, int row, int column, int stride) {
    const int width = static_cast<int>(best_.size());
    std::copy_n(rows[0], width, best_.begin());
    std::fill(label_.begin(), label_.end(), static_cast<std::int32_t>(classes[0]));
    for (std::size_t c = 1; c < rows.size(); ++c) {
      keepBest(rows[c], static_cast<std::int32_t>(classes[c]), width, best_.data(), label_.data());
    }
    std::fill(total_.begin(), total_.end(), 0.0F);
    for (const float* logits : rows) addExponentials(logits, best_.data(), width, total_.data());
    std::uint8_t* const labels = out.labels.ptr<std::uint8_t>(row) + column;
    std::uint8_t* const confidence = out.confidence.ptr<std::uint8_t>(row) + column;
    for (int u = 0; u < width; ++u) {
      labels[u * stride] = static_cast<std::uint8_t>(label_[u]);
      confidence[u * stride] =
          static_cast<std::uint8_t>(std::min(255.0F, 255.0F / total_[u] + 0.5F));
    }
    const auto evidence = [&](bool (*of)(SemanticClass), cv::Mat& picture) {
      if (picture.empty()) return;
      std::fill(evidence_.begin(), evidence_.end(), 0);
      for (std::size_t c = 0; c < rows.size(); ++c) {
        if (of(classes[c])) keepEvidence(rows[c], best_.data(), width, evidence_.data());
      }
      std::uint8_t* const at = picture.ptr<std::uint8_t>(row) + column;
      for (int u = 0; u < width; ++u) at[u * stride] = static_cast<std::uint8_t>(evidence_[u]);
    };
    evidence(isSlotLine, out.slot_line);
    evidence(isPaint, out.paint);
  }

 private:
  std::vector<float> best_;
  std::vector<float> total_;
  std::vector<std::int32_t> label_;
  std::vector<std::int32_t> evidence_;
};

}  // namespace

DecodedLabels decodeLogits(const cv::Mat& logits, const std::vector<SemanticClass>& classes,
                           const cv::Size& size, bool no_unknown) {
  PARKADE_CHECK(logits.dims == 4 && logits.size[0] == 1 && logits.type() == CV_32F,
                "logits of {} dimensions", logits.dims);
  const std::size_t count = classes.size();
  std::vector<int> channels;
  std::vector<SemanticClass> meanings;
  for (std::size_t c = 0; c < count; ++c) {
    if (no_unknown && classes[c] == SemanticClass::kUnknown) continue;
    channels.push_back(static_cast<int>(c));
    meanings.push_back(classes[c]);
  }
  PARKADE_CHECK(!channels.empty(), "no class but unknown");
  const int height = logits.size[2];
  const int width = logits.size[3];
  DecodedLabels out;
  out.labels.create(size, CV_8UC1);
  out.confidence.create(size, CV_8UC1);
  if (std::any_of(classes.begin(), classes.end(), isSlotLine)) out.slot_line.create(size, CV_8UC1);
  if (std::any_of(classes.begin(), classes.end(), isPaint)) out.paint.create(size, CV_8UC1);
  const bool blocks = logits.size[1] == static_cast<int>(4 * count);
  PARKADE_CHECK(
      blocks ? size == cv::Size(2 * width, 2 * height) : logits.size[1] == static_cast<int>(count),
      "{} channels of {} x {} for {} classes and {} x {} px", logits.size[1], width, height, count,
      size.width, size.height);
  std::vector<const float*> rows(channels.size());
  if (blocks) {
    RowDecoder decoder(width);
    for (int v = 0; v < height; ++v) {
      for (int part = 0; part < 4; ++part) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          rows[i] =
              logits.ptr<float>(0, 4 * channels[i] + part) + static_cast<std::ptrdiff_t>(v) * width;
        }
        decoder.decode(rows, meanings, out, 2 * v + part / 2, part % 2, 2);
      }
    }
    return out;
  }
  std::vector<cv::Mat> planes(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const cv::Mat plane(height, width, CV_32F,
                        const_cast<float*>(logits.ptr<float>(0, channels[i])));
    planes[i] = plane;
    if (plane.size() != size) cv::resize(plane, planes[i], size, 0, 0, cv::INTER_LINEAR);
  }
  RowDecoder decoder(size.width);
  for (int v = 0; v < size.height; ++v) {
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = planes[i].ptr<float>(v);
    decoder.decode(rows, meanings, out, v, 0, 1);
  }
  return out;
}

}  // namespace parkade
