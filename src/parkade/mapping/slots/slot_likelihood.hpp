// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/mapping/parking_map.hpp"
#include "parkade/mapping/slots/row_evidence.hpp"

namespace parkade::slot_rows {

/// What the layers' evidence says for there being a slot, as log-odds. How many of its lines a slot
/// shows is learnt from the slots that pictures told. docs/math/slots.md, equations (4) to (6).
class SlotLikelihood {
 public:
  /// Of a slot that was told.
  void learn(const SlotEvidence& evidence);

  [[nodiscard]] double side(const SlotEvidence::Line& line) const;
  [[nodiscard]] double entrance(const SlotEvidence::Line& line) const;
  [[nodiscard]] static double vehicle(const SlotEvidence& evidence);
  /// Of a number painted in it; 0 where there is none, cars may hide it.
  [[nodiscard]] double number(const SlotEvidence& evidence) const;
  /// Of a wheel stop in it, likewise.
  [[nodiscard]] double stop(const SlotEvidence& evidence) const;
  /// Of all that there is of a slot alone.
  [[nodiscard]] double whole(const SlotEvidence& evidence) const;
  /// Whether the slot would be free and in plain sight, and one of its sides is bare all the same.
  /// Never where the paint of the slots told is worn, nor where a number or a wheel stop is in it.
  [[nodiscard]] bool lacksSide(const SlotEvidence& evidence) const;
  /// Whether it would be free, and its sides and its entrance are bare as far as they are in sight;
  /// never, likewise, where paint is worn or a number or a wheel stop is in it.
  [[nodiscard]] bool lacksAllLines(const SlotEvidence& evidence) const;

 private:
  struct Lines {
    int all = 0;
    int shown = 0;
    double contrast = 0.0;  // sum
    void add(const SlotEvidence::Line& line);
    [[nodiscard]] double logOdds(const SlotEvidence::Line& line) const;
  };
  // Whether slots here have lines that can be missed, and the place nothing that hides them or that
  // stands in slots only.
  [[nodiscard]] bool isPaintedAndFree(const SlotEvidence& evidence) const;

  Lines sides_;
  Lines entrances_;
  int slots_ = 0;
  int numbered_ = 0;
  int with_stop_ = 0;
};

/// Whether the layers show what lies between the slots of a row and what a picture takes for one: a
/// pillar in it, or lane line along its entrance, and nothing of what slots hold.
bool isGapBetweenSlots(const SlotEvidence& evidence);

/// Whether the layers deny a slot: it is such a gap, or holds markings for who drives, lane lines,
/// other lines, a sign that is not in its middle or something that stands in it.
bool isDenied(const SlotEvidence& evidence);

/// Free or occupied, by the vehicles that the layers show in it; untouched where too little is
/// seen.
void setFree(const SlotEvidence& evidence, MapSlot& slot);

}  // namespace parkade::slot_rows
