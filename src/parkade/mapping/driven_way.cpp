// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/driven_way.hpp"

#include <algorithm>

namespace parkade {

void DrivenWay::add(const Eigen::Vector2d& p, std::int64_t anchor) {
  constexpr double kStep = 1.0;  // m
  if (places_.empty() || (p - places_.back().p).norm() >= kStep) places_.push_back({p, anchor});
}

void DrivenWay::moveWithAnchors(const std::function<SE2(std::int64_t)>& correction) {
  for (Place& place : places_) place.p = correction(place.anchor) * place.p;
}

bool DrivenWay::passed(const Eigen::Vector2d& p, double reach) const {
  return std::any_of(places_.begin(), places_.end(),
                     [&](const Place& place) { return (place.p - p).norm() < reach; });
}

}  // namespace parkade
