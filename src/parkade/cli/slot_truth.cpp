// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/slot_truth.hpp"

#include "parkade/geometry/so3.hpp"
#include "parkade/semantics/label_probe.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade::cli {

using Eigen::Vector2d;

std::vector<TrueSlot> trueSlots(const SemanticSampler& sampler, const SemanticSample& sample,
                                const BevLabels& truth, double reach) {
  const sim::Garage& garage = sampler.simulation().garage();
  const SO3 tilt = levelFrom(sample.true_attitude).rotation();
  const SE3 T_vehicle_world = sample.T_world_vehicle.inverse();
  const BevGeometry& g = truth.geometry;
  const LabelProbe probe(truth);
  std::vector<TrueSlot> slots;
  for (const sim::Slot& s : garage.slots) {
    TrueSlot one;
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector2d& c = s.corners[i];
      const Eigen::Vector3d p_vehicle =
          T_vehicle_world * Eigen::Vector3d(c.x(), c.y(), garage.floorHeight(c));
      one.slot.corners[i] = (tilt * p_vehicle).head<2>();
    }
    const auto& c = one.slot.corners;
    if ((0.5 * (c[0] + c[1]) - g.center).norm() > 1.5 * reach) continue;
    one.slot.shape = static_cast<SlotShape>(s.type);
    one.slot.marking = static_cast<SlotMarking>(s.marking);
    one.occupied = s.occupied;
    constexpr double kSide = 0.7;  // m of each side line that must be in sight
    constexpr double kHidden = 0.1;
    const auto clear = [&](const Vector2d& from, const Vector2d& to) {
      return probe.along(from, to).hidden <= kHidden;
    };
    const Vector2d left = kSide * (c[3] - c[0]).normalized();
    const Vector2d right = kSide * (c[2] - c[1]).normalized();
    const auto worn = [&](const Vector2d& from, const Vector2d& to) {
      return probe.along(from, to, 0.05).paint < 0.5;
    };
    one.counts = (c[0] - g.center).norm() < reach && (c[1] - g.center).norm() < reach &&
                 clear(c[0], c[1]) && clear(c[0], c[0] + left) && clear(c[1], c[1] + right) &&
                 // What lies in front of the corner tells that the line ends there.
                 clear(c[0], c[0] - 0.3 * left) && clear(c[1], c[1] - 0.3 * right) &&
                 !worn(c[0], c[0] + left) && !worn(c[1], c[1] + right);
    slots.push_back(one);
  }
  return slots;
}

}  // namespace parkade::cli
