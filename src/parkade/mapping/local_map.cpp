// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/local_map.hpp"

#include "parkade/mapping/layer_update.hpp"

namespace parkade {

LocalMap::LocalMap(const LocalMapOptions& options)
    : resolution_(options.resolution_m),
      cells_(static_cast<int>(std::ceil(options.size_m / options.resolution_m))),
      half_life_s_(options.evidence.dynamic_half_life_s),
      kernel_(options.evidence) {
  const auto count = static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_);
  for (std::vector<GridCell>& cells : layers_) cells.resize(count);
}

bool LocalMap::contains(const Eigen::Vector2i& cell) const {
  const Eigen::Vector2i from = cell - lowest_;
  return from.minCoeff() >= 0 && from.maxCoeff() < cells_;
}

GridCell LocalMap::at(GridLayer l, const Eigen::Vector2i& cell) const {
  if (!contains(cell)) return {};
  return layers_[static_cast<std::size_t>(l)][indexOf(cell.x(), cell.y())];
}

void LocalMap::forget(int i, int j) {
  const std::size_t at = indexOf(i, j);
  for (std::vector<GridCell>& cells : layers_) cells[at] = GridCell{};
}

void LocalMap::moveTo(const Eigen::Vector2i& lowest) {
  const Eigen::Vector2i step = lowest - lowest_;
  if (!started_ || step.cwiseAbs().maxCoeff() >= cells_) {
    for (std::vector<GridCell>& cells : layers_) std::fill(cells.begin(), cells.end(), GridCell{});
  } else {
    // Columns, then rows, that come in take the places of those that go.
    for (int k = 0; k < std::abs(step.x()); ++k) {
      const int i = step.x() > 0 ? lowest_.x() + cells_ + k : lowest_.x() - 1 - k;
      for (int j = lowest_.y(); j < lowest_.y() + cells_; ++j) forget(i, j);
    }
    for (int k = 0; k < std::abs(step.y()); ++k) {
      const int j = step.y() > 0 ? lowest_.y() + cells_ + k : lowest_.y() - 1 - k;
      for (int i = lowest.x(); i < lowest.x() + cells_; ++i) forget(i, j);
    }
  }
  lowest_ = lowest;
}

void LocalMap::fadeDynamic(TimeNs t_ns) {
  if (!started_ || t_ns <= t_ns_) return;
  const double factor = std::exp2(-toSeconds(t_ns - t_ns_) / half_life_s_);
  for (GridCell& cell : layer(GridLayer::kDynamic)) {
    if (!cell.known()) continue;
    cell.log_odds = static_cast<std::int8_t>(cell.log_odds * factor);
    if (cell.log_odds == 0) cell = GridCell{};
  }
}

void LocalMap::update(const PackedLabels& labels, TimeNs t_ns, const SE2& T_map_vehicle,
                      bool new_view) {
  const Eigen::Vector2d middle = (T_map_vehicle * labels.geometry.center) / resolution_ -
                                 Eigen::Vector2d::Constant(0.5 * cells_);
  moveTo({static_cast<int>(std::floor(middle.x())), static_cast<int>(std::floor(middle.y()))});
  fadeDynamic(t_ns);
  started_ = true;
  t_ns_ = t_ns;
  kernel_.forEachCell(labels, T_map_vehicle, resolution_,
                      [&](int i, int j, SemanticClass c, const EvidenceSteps& steps,
                          const Eigen::Vector2d& p_level) {
                        if (!contains({i, j})) return;
                        const std::size_t at = indexOf(i, j);
                        updateLayers(
                            labels, c, steps, p_level, new_view,
                            [&](GridLayer l) -> GridCell& { return layer(l)[at]; },
                            [&] { return layer(GridLayer::kDynamic)[at].known(); });
                      });
}

}  // namespace parkade
