// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/driven_way.hpp"

#include <algorithm>

namespace parkade {

void DrivenWay::add(const Eigen::Vector2d& p, std::int64_t anchor) {
  if (places_.empty() || (p - places_.back().p).norm() >= step_m_) places_.push_back({p, anchor});
}

void DrivenWay::moveWithAnchors(const std::function<SE2(std::int64_t)>& correction) {
  for (Place& place : places_) place.p = correction(place.anchor) * place.p;
}

bool DrivenWay::passed(const Eigen::Vector2d& p, double reach) const {
  return std::any_of(places_.begin(), places_.end(),
                     [&](const Place& place) { return (place.p - p).norm() < reach; });
}

std::vector<DrivenStep> DrivenWay::steps() const {
  constexpr double kLongest = 3.0;  // m
  std::vector<DrivenStep> steps;
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const DrivenStep step{places_[i - 1].p, places_[i].p};
    if ((step.to - step.from).norm() <= kLongest) steps.push_back(step);
  }
  return steps;
}

}  // namespace parkade
