// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/slots/slot_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "parkade/geometry/planar.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;

constexpr double kAcross = 0.04;  // m between the lines that are tried
constexpr double kAlong = 0.08;   // m between samples of one

// The evidence of lines beside a slot: its mean along each that its sides' direction allows.
class RowScan {
 public:
  // From origin along u (unit); inward: along the lines, into the slots.
  RowScan(const BevLabels& labels, const Vector2d& origin, const Vector2d& u,
          const Vector2d& inward, double length)
      : labels_(labels), origin_(origin), u_(u), inward_(inward) {
    for (std::size_t c = 0; c < hides_.size(); ++c) {
      hides_[c] = hidesFloor(static_cast<SemanticClass>(c));
    }
    constexpr double kFrom = 0.1;   // m behind the entrance
    constexpr double kTo = 4.0;     // farther in, cars and the picture's edge hide most
    constexpr double kLeast = 0.6;  // m to see
    const int count = static_cast<int>(length / kAcross) + 1;
    for (int i = 0; i < count; ++i) lines_.push_back(meanAlong(i, kFrom, kTo, kLeast));
    for (int i = 0; i < count; ++i) contrasts_.push_back(contrastAt(i));
  }

  struct Peak {
    double at = 0.0;        // m along u
    double contrast = 0.0;  // log-odds
    double seen = 0.0;      // m
  };
  [[nodiscard]] std::vector<Peak> peaks(double min_contrast) const {
    constexpr int kApart = 6;
    std::vector<Peak> found;
    for (int i = 0; i < count(); ++i) {
      const double contrast = contrasts_[static_cast<std::size_t>(i)];
      if (contrast < min_contrast) continue;
      const auto first = contrasts_.begin() + std::max(0, i - kApart);
      const auto last = contrasts_.begin() + std::min(count(), i + kApart + 1);
      if (*std::max_element(first, last) > contrast || goesOnAhead(i, contrast)) continue;
      found.push_back({i * kAcross, contrast, lines_[static_cast<std::size_t>(i)]->seen});
    }
    return found;
  }

 private:
  static constexpr double kNone = -1e3;  // contrast of what is not seen

  struct Mean {
    double evidence = 0.0;
    double seen = 0.0;  // m
  };
  [[nodiscard]] int count() const { return static_cast<int>(lines_.size()); }

  // Over what is seen of the i-th line between two distances from the entrance; equation (2).
  [[nodiscard]] std::optional<Mean> meanAlong(int i, double from, double to, double least) const {
    const BevGeometry& g = labels_.geometry;
    const Vector2d begin = g.toPixel(origin_ + i * kAcross * u_ + from * inward_);
    const Vector2d step = -kAlong / g.metres_per_px * Vector2d(inward_.y(), inward_.x());
    const int count = static_cast<int>((to - from) / kAlong);
    int sum = 0;
    int n = 0;
    for (int k = 0; k < count; ++k) {
      const int u = static_cast<int>(std::floor(begin.x() + k * step.x() + 0.5));
      const int v = static_cast<int>(std::floor(begin.y() + k * step.y() + 0.5));
      if (u < 0 || v < 0 || u >= labels_.labels.cols || v >= labels_.labels.rows) continue;
      if (hides_[labels_.labels.ptr<std::uint8_t>(v)[u]]) continue;
      sum += labels_.slot_line.ptr<std::uint8_t>(v)[u];
      ++n;
    }
    if (n * kAlong < least) return std::nullopt;
    return Mean{(static_cast<double>(sum) / n - 255.0) / kEvidencePerLogOdds, n * kAlong};
  }

  // docs/math/slots.md, equation (3).
  [[nodiscard]] double contrastAt(int i) const {
    constexpr int kNear = 5;
    constexpr int kFar = 9;
    constexpr int kEnough = 3;
    if (i < 1 || i + 1 >= count()) return kNone;
    double middle = 0.0;
    for (int k = i - 1; k <= i + 1; ++k) {
      const std::optional<Mean>& line = lines_[static_cast<std::size_t>(k)];
      if (!line) return kNone;
      middle += line->evidence / 3.0;
    }
    double beside = kNone;
    for (const int sign : {-1, 1}) {
      double sum = 0.0;
      int n = 0;
      for (int k = kNear; k <= kFar; ++k) {
        const int j = i + sign * k;
        if (j < 0 || j >= count() || !lines_[static_cast<std::size_t>(j)]) continue;
        sum += lines_[static_cast<std::size_t>(j)]->evidence;
        ++n;
      }
      if (n >= kEnough) beside = std::max(beside, sum / n);
    }
    return beside == kNone ? kNone : middle - beside;
  }

  // Whether the line is seen to go on in front of the entrance.
  [[nodiscard]] bool goesOnAhead(int i, double contrast) const {
    constexpr int kBeside = 7;
    constexpr double kShare = 0.5;
    const auto mean = [this](int k) { return meanAlong(k, -1.2, -0.3, 0.3); };
    const std::optional<Mean> here = mean(i);
    const std::optional<Mean> before = mean(i - kBeside);
    const std::optional<Mean> behind = mean(i + kBeside);
    if (!here || !before || !behind) return false;
    return here->evidence - std::max(before->evidence, behind->evidence) > kShare * contrast;
  }

  const BevLabels& labels_;
  std::array<bool, 256> hides_{};
  Vector2d origin_;
  Vector2d u_;
  Vector2d inward_;
  std::vector<std::optional<Mean>> lines_;
  std::vector<double> contrasts_;
};

// Whether a slot lies beside a mark, in a direction along its entrance.
bool liesBeside(const SlotCandidate& slot, const SlotMark& mark, const Vector2d& u) {
  constexpr double kApart = 4.0;  // m
  constexpr double kNearest = 0.3;
  constexpr double kFarthest = 3.5;
  const Vector2d d = 0.5 * (slot.left->p + slot.right->p) - mark.p;
  return d.norm() < kApart && d.dot(u) > kNearest && d.dot(u) < kFarthest &&
         slot.inward.dot(mark.inward) > 0.5;
}

// Along the entrance that begins at a mark: as the line that meets it there, or square.
Vector2d entranceAlong(const SlotMark& mark) {
  constexpr double kShort = 0.5;  // m: such know their direction badly
  const Vector2d square(-mark.inward.y(), mark.inward.x());
  if (mark.across_length <= kShort) return square;
  return mark.across.dot(square) > 0.0 ? mark.across : Vector2d(-mark.across);
}

// Whether another mark stands for the same side line, at the same entrance.
bool isSame(const SlotMark& a, const SlotMark& b, const Vector2d& u) {
  constexpr double kAside = 0.3;  // m
  constexpr double kApart = 0.6;
  return std::abs((a.p - b.p).dot(u)) < kAside && (a.p - b.p).norm() < kApart &&
         std::abs(a.inward.dot(b.inward)) > kParallelSides;
}

SlotMark faintMark(const SlotMark& from, const Vector2d& p, const RowScan::Peak& peak,
                   double pixel) {
  constexpr double kClear = 3.0;  // log-odds: such a line counts in full
  SlotMark mark;
  mark.p = p;
  mark.width = from.width;
  mark.visible = peak.seen * std::min(1.0, peak.contrast / kClear);
  mark.sigma_along = 0.08;  // m: where the row's entrance lies, not this one's
  mark.sigma_aside = pixel;
  return mark;
}

// Of a side line of its own, unless that is among the marks or the others found.
void addUnknown(SlotMark mark, const Vector2d& u, const std::vector<SlotMark>& marks,
                std::vector<SlotMark>& found) {
  const auto known = [&](const SlotMark& other) {
    return !other.isSideless() && isSame(mark, other, u);
  };
  if (std::any_of(marks.begin(), marks.end(), known) ||
      std::any_of(found.begin(), found.end(), known)) {
    return;
  }
  mark.side = 1;
  for (const SlotMark& other : marks) mark.side = std::max(mark.side, other.side + 1);
  for (const SlotMark& other : found) mark.side = std::max(mark.side, other.side + 1);
  found.push_back(mark);
}

}  // namespace

std::vector<SlotMark> findFaintMarks(const BevLabels& labels,
                                     const std::vector<const SlotCandidate*>& slots,
                                     const std::vector<SlotMark>& marks, double min_contrast) {
  constexpr double kBegin = 0.3;  // m beside a slot
  constexpr double kWidths = 2.0;
  constexpr double kPillar = 3.0;  // m between two slots; along slanted rows it is long
  std::vector<SlotMark> faint;
  if (labels.slot_line.empty()) return faint;
  const double pixel = labels.geometry.metres_per_px;
  for (const SlotCandidate* slot : slots) {
    if (slot->shape == SlotShape::kParallel) continue;
    const double width = slot->front().norm();
    for (const double sign : {-1.0, 1.0}) {
      const SlotMark& from = sign > 0.0 ? *slot->right : *slot->left;
      const Vector2d u = sign * slot->front().normalized();
      const Vector2d origin = from.p + kBegin * u;
      const RowScan scan(labels, origin, u, slot->inward, kWidths * width + kPillar);
      for (const RowScan::Peak& peak : scan.peaks(min_contrast)) {
        SlotMark mark = faintMark(from, origin + peak.at * u, peak, pixel);
        mark.inward = slot->inward;
        mark.row_width = width;
        addUnknown(mark, u, marks, faint);
      }
    }
  }
  return faint;
}

std::vector<SlotMark> findLoneMarks(const BevLabels& labels,
                                    const std::vector<const SlotCandidate*>& slots,
                                    const std::vector<SlotMark>& marks, double min_contrast) {
  constexpr double kLeastSeen = 0.8;  // m of the side that is seen
  constexpr double kBegin = 1.6;      // m from it
  constexpr double kNarrowest = 2.2;
  constexpr double kWidest = 2.8;
  std::vector<SlotMark> lone;
  if (labels.slot_line.empty()) return lone;
  for (const SlotMark& from : marks) {
    if (from.isSideless() || from.isFaint() || from.visible < kLeastSeen) continue;
    for (const double sign : {-1.0, 1.0}) {
      const Vector2d u = sign * entranceAlong(from);
      const auto beside = [&](const SlotCandidate* slot) { return liesBeside(*slot, from, u); };
      if (std::any_of(slots.begin(), slots.end(), beside)) continue;
      const double widest = kWidest / std::max(0.3, std::abs(cross(u, from.inward)));
      const Vector2d origin = from.p + kBegin * u;
      const RowScan scan(labels, origin, u, from.inward, widest - kBegin + 0.6);
      for (const RowScan::Peak& peak : scan.peaks(min_contrast)) {
        const double width = kBegin + peak.at;
        if (width < kNarrowest || width > widest) continue;
        SlotMark mark = faintMark(from, origin + peak.at * u, peak, labels.geometry.metres_per_px);
        mark.inward = from.inward;
        mark.row_width = width;
        mark.is_lone = true;
        addUnknown(mark, u, marks, lone);
      }
    }
  }
  return lone;
}

}  // namespace parkade
