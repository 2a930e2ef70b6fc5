// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/semantics/markings/marking_objects.hpp"
#include "parkade/semantics/standing/object_agents.hpp"
#include "parkade/semantics/standing/object_contacts.hpp"
#include "parkade/semantics/standing/object_pillars.hpp"

namespace parkade {

struct ObjectOptions {
  MarkingOptions markings;
  PillarOptions pillars;
  AgentOptions agents;

  void visit(OptionVisitor& v) {
    v.group("markings", markings);
    v.group("pillars", pillars);
    v.group("agents", agents);
  }
};

/// What one picture shows beside lines and slots.
struct FoundObjects {
  std::vector<ObjectObservation> objects;
  std::vector<AgentDetection> agents;
};

/// Finds objects in the labels of bird's-eye pictures of one geometry, seen by the same cameras.
class ObjectExtractor {
 public:
  ObjectExtractor(const BevGeometry& geometry, const BevViews& views,
                  const ObjectOptions& options = {})
      : options_(options), views_(views), finder_(geometry, views), markings_(options.markings) {}

  /// slots: of the same picture. attitude_sigma (rad): of the pitch and roll that the picture was
  /// levelled with. The labels must have the geometry's size (checked).
  [[nodiscard]] FoundObjects extract(const BevLabels& labels,
                                     const std::vector<SlotObservation>& slots,
                                     double attitude_sigma) const {
    FoundObjects found;
    found.objects = markings_.extract(labels, views_, attitude_sigma);
    for (ObjectObservation& pillar :
         findPillars(finder_, labels, views_, attitude_sigma, options_.pillars)) {
      found.objects.push_back(std::move(pillar));
    }
    found.agents = findAgents(finder_, labels, slots, views_, attitude_sigma, options_.agents);
    return found;
  }

 private:
  ObjectOptions options_;
  BevViews views_;
  ContactFinder finder_;
  MarkingExtractor markings_;
};

}  // namespace parkade
