// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/mapping/frame_evidence.hpp"

namespace parkade {

struct LocalMapOptions {
  double size_m = 30.0;
  double resolution_m = 0.05;
  EvidenceOptions evidence;

  void visit(OptionVisitor& v) {
    v.field("size_m", size_m, "m", "Side of the square that moves with the car.", 5.0, 200.0);
    v.field("resolution_m", resolution_m, "m", "Side of a cell.", 0.01, 1.0);
    v.group("evidence", evidence);
  }
};

/// The five layers around the car, for a planner, at frame rate: a square of cells that moves with
/// the car as a ring buffer. Cells are those of a LayeredGrid of the same resolution; what leaves
/// the square is forgotten.
class LocalMap {
 public:
  explicit LocalMap(const LocalMapOptions& options);

  /// Enters one frame set. T_map_vehicle is the levelled vehicle in any frame that jumps little:
  /// odom, best. new_view: false where the vehicle stands as in the frame before: layers 2 and 5
  /// alone.
  void update(const PackedLabels& labels, TimeNs t_ns, const SE2& T_map_vehicle,
              bool new_view = true);

  [[nodiscard]] int cells() const { return cells_; }  ///< along a side
  [[nodiscard]] double resolution() const { return resolution_; }
  /// Lowest cell of the square, in both axes.
  [[nodiscard]] const Eigen::Vector2i& lowest() const { return lowest_; }
  [[nodiscard]] bool contains(const Eigen::Vector2i& cell) const;
  /// Unknown outside the square.
  [[nodiscard]] GridCell at(GridLayer layer, const Eigen::Vector2i& cell) const;
  [[nodiscard]] TimeNs time() const { return t_ns_; }

 private:
  [[nodiscard]] std::size_t indexOf(int i, int j) const {
    const int x = ((i % cells_) + cells_) % cells_;
    const int y = ((j % cells_) + cells_) % cells_;
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(cells_) +
           static_cast<std::size_t>(x);
  }
  void moveTo(const Eigen::Vector2i& lowest);
  void forget(int i, int j);
  void fadeDynamic(TimeNs t_ns);
  std::vector<GridCell>& layer(GridLayer l) { return layers_[static_cast<std::size_t>(l)]; }

  double resolution_;
  int cells_;
  double half_life_s_;
  EvidenceKernel kernel_;
  Eigen::Vector2i lowest_ = Eigen::Vector2i::Zero();
  bool started_ = false;
  TimeNs t_ns_ = 0;
  std::array<std::vector<GridCell>, kNumGridLayers> layers_;
};

}  // namespace parkade
