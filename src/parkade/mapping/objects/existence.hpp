// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "parkade/core/options.hpp"

namespace parkade {

/// How likely things are to be found where they are, and where they are not.
struct ExistenceOptions {
  double detection = 0.4;
  double false_alarm = 0.1;
  double prior = 0.1;

  void visit(OptionVisitor& v) {
    v.field("detection", detection, "probability",
            "That a thing is observed in a picture that shows all of it.", 0.01, 0.99);
    v.field("false_alarm", false_alarm, "probability",
            "That it is observed there once more where it is not: errors repeat.", 0.001, 0.9);
    v.field("prior", prior, "probability", "That what was observed once exists.", 0.001, 0.9);
  }
};

/// Pictures that should have shown a thing: with and without it. docs/math/grid.md, eq. (5).
struct Existence {
  std::int64_t hits = 0;
  std::int64_t misses = 0;

  /// Log-odds that the thing exists.
  [[nodiscard]] double logOdds(const ExistenceOptions& o) const {
    return std::log(o.prior / (1.0 - o.prior)) +
           static_cast<double>(hits) * std::log(o.detection / o.false_alarm) +
           static_cast<double>(misses) * std::log((1.0 - o.detection) / (1.0 - o.false_alarm));
  }
  void add(const Existence& other) {
    hits += other.hits;
    misses += other.misses;
  }
};

}  // namespace parkade
