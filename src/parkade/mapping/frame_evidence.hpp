// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/layered_grid.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// How much one bird's-eye picture says of the cells that it shows. docs/math/grid.md, eq. (4).
struct EvidenceOptions {
  double full_range_m = 4.0;
  double range_m = 8.5;
  double gain = 0.5;
  double bare_share = 0.2;
  double dynamic_gain = 1.0;
  double dynamic_half_life_s = 0.7;

  void visit(OptionVisitor& v) {
    v.field("full_range_m", full_range_m, "m", "Ground up to here from the car has full weight.",
            0.5, 100.0);
    v.field("range_m", range_m, "m", "Ground beyond is not entered.", 1.0, 100.0);
    v.field("gain", gain, "ratio",
            "Share of a picture's log-odds that is new: pictures of one place repeat their errors.",
            0.01, 1.0);
    v.field("bare_share", bare_share, "ratio",
            "Of that, what bare floor counts against paint: worn paint is missed in many pictures.",
            0.01, 1.0);
    v.field("dynamic_gain", dynamic_gain, "ratio", "The same for what moves.", 0.01, 1.0);
    v.field("dynamic_half_life_s", dynamic_half_life_s, "s",
            "Time in which log-odds of the dynamic layer halve.", 0.05, 60.0);
  }
};

/// Adds evidence in steps of GridCell::kStep; addEvidence() for whole steps, without rounding.
inline void addSteps(GridCell& cell, SemanticClass semantic_class, int steps) {
  constexpr int kLimit = 112;  // 7.0
  if (steps == 0) return;
  if (cell.semantic_class == semantic_class) {
    cell.log_odds = static_cast<std::int8_t>(std::min(kLimit, cell.log_odds + steps));
  } else if (!cell.known()) {
    cell.semantic_class = semantic_class;
    cell.log_odds = static_cast<std::int8_t>(std::min(kLimit, steps));
  } else {
    const int left = cell.log_odds - steps;
    if (left < 0) cell.semantic_class = semantic_class;
    cell.log_odds = static_cast<std::int8_t>(std::min(kLimit, std::abs(left)));
  }
}

/// One picture's labels packed for maps: 5 bits of class, 3 bits of confidence, one byte a pixel.
/// What a map is made of, so that it can be made again when poses are corrected.
struct PackedLabels {
  BevGeometry geometry;
  std::vector<std::uint8_t> pixels;  ///< row by row; 0: nothing known
  /// Outlines of what moves, in the levelled vehicle frame; vehicle pixels inside are dynamic.
  struct Box {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();
    Eigen::Vector2d half_size = Eigen::Vector2d::Zero();
    double heading = 0.0;
  };
  std::vector<Box> moving;

  static constexpr int kConfidenceLevels = 8;
  static SemanticClass classOf(std::uint8_t pixel) {
    return static_cast<SemanticClass>(pixel & 0x1F);
  }
  static int levelOf(std::uint8_t pixel) { return pixel >> 5; }
  [[nodiscard]] bool isMoving(const Eigen::Vector2d& p_level) const;
  /// m from a point of the levelled vehicle frame to the picture's nearest border.
  [[nodiscard]] double toBorder(const Eigen::Vector2d& p_level) const;
};

/// Floor where the network holds paint nearly as likely is packed as less sure, but not beside what
/// it labels as paint, whose blurred edge that is.
PackedLabels packLabels(const SemanticFrame& frame);

/// Which layers a class speaks of.
enum class LayerRole : std::uint8_t {
  kNone,        ///< says nothing of any layer
  kGround,      ///< floor without paint
  kLine,        ///< layer 1; ground elsewhere
  kRoadMarker,  ///< layer 3; ground elsewhere
  kStructure,   ///< layer 4
  kVehicle,     ///< layer 2, or 5 where it moves
  kPerson,      ///< layer 5
};
LayerRole roleOf(SemanticClass semantic_class);

/// What a pixel says, in steps of GridCell::kStep.
struct EvidenceSteps {
  int seen = 0;     ///< for what it shows
  int bare = 0;     ///< for floor without paint
  int dynamic = 0;  ///< in layer 5
};

/// Enters packed pictures in grids: every cell that a picture shows, once, with the evidence of the
/// pixel nearest to its middle.
class EvidenceKernel {
 public:
  explicit EvidenceKernel(const EvidenceOptions& options);

  /// Calls cell(i, j, semantic_class, steps, p_level) for every visible cell of a grid of this
  /// resolution; j (y) is the outer loop. T_map_vehicle: the levelled vehicle.
  template <class Visit>
  void forEachCell(const PackedLabels& labels, const SE2& T_map_vehicle, double resolution,
                   const Visit& cell) const;

 private:
  static constexpr int kWeights = 16;
  /// By confidence level and weight by distance.
  std::array<std::array<EvidenceSteps, kWeights + 1>, PackedLabels::kConfidenceLevels> steps_{};
  double full_range_;
  double range_;
};

template <class Visit>
void EvidenceKernel::forEachCell(const PackedLabels& labels, const SE2& T_map_vehicle,
                                 double resolution, const Visit& cell) const {
  const BevGeometry& g = labels.geometry;
  const SE2 T_vehicle_map = T_map_vehicle.inverse();
  const Eigen::Matrix2d R = resolution * T_vehicle_map.rotationMatrix();
  // The picture's corners bound the rows and columns of cells.
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e12);
  Eigen::Vector2d high = -low;
  for (const double u : {-0.5, g.width_px - 0.5}) {
    for (const double v : {-0.5, g.height_px - 0.5}) {
      const Eigen::Vector2d p = (T_map_vehicle * g.toGround({u, v})) / resolution;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  const int i0 = static_cast<int>(std::floor(low.x()));
  const int i1 = static_cast<int>(std::floor(high.x()));
  const int j0 = static_cast<int>(std::floor(low.y()));
  const int j1 = static_cast<int>(std::floor(high.y()));
  const double to_px = 1.0 / g.metres_per_px;
  const double u0 = 0.5 * (g.width_px - 1) + 0.5;  // + 0.5: truncation then rounds
  const double v0 = 0.5 * (g.height_px - 1) + 0.5;
  const double range2 = range_ * range_;
  const double full2 = full_range_ * full_range_;
  for (int j = j0; j <= j1; ++j) {
    Eigen::Vector2d p =
        T_vehicle_map * (resolution * Eigen::Vector2d(i0 + 0.5, j + 0.5)) - R.col(0);
    for (int i = i0; i <= i1; ++i) {
      p += R.col(0);
      const double u = u0 - (p.y() - g.center.y()) * to_px;
      const double v = v0 - (p.x() - g.center.x()) * to_px;
      if (u < 0.0 || v < 0.0 || u >= g.width_px || v >= g.height_px) continue;
      const std::uint8_t pixel =
          labels.pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(g.width_px) +
                        static_cast<std::size_t>(u)];
      if (pixel == 0) continue;
      const double distance2 = p.squaredNorm();
      if (distance2 >= range2) continue;
      int weight = kWeights;
      if (distance2 > full2) {
        weight =
            static_cast<int>(kWeights * (range_ - std::sqrt(distance2)) / (range_ - full_range_));
      }
      const EvidenceSteps& steps = steps_[static_cast<std::size_t>(PackedLabels::levelOf(pixel))]
                                         [static_cast<std::size_t>(weight)];
      if (steps.seen > 0) cell(i, j, PackedLabels::classOf(pixel), steps, p);
    }
  }
}

}  // namespace parkade
