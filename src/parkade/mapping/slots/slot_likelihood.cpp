// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/slots/slot_likelihood.hpp"

#include <algorithm>
#include <cmath>

namespace parkade::slot_rows {
namespace {

constexpr double kLeastSeen = 0.5;  // m of a line

bool shows(const SlotEvidence::Line& line) {
  constexpr double kShown = 0.1;
  return line.contrast() > kShown;
}

// Though so much of it (m) is seen.
bool isBare(const SlotEvidence::Line& line, double seen_m) {
  return line.seen_m > seen_m && !shows(line);
}

bool showsNumber(const SlotEvidence& evidence) {
  constexpr double kPaint = 0.02;  // m^2
  return evidence.number_m2 > kPaint;
}

bool showsStop(const SlotEvidence& evidence) {
  constexpr double kArea = 0.03;  // m^2
  return evidence.stop_m2 > kArea;
}

bool isPlain(const SlotEvidence::Line& line) {
  constexpr double kContrast = 0.6;
  constexpr double kSeen = 1.5;  // m
  return line.contrast() > kContrast && line.seen_m > kSeen;
}

// Lines on the three sides other than the entrance bound nothing else than a slot.
bool isBoundedAsSlots(const SlotEvidence& evidence) {
  return isPlain(evidence.left) && isPlain(evidence.right) && isPlain(evidence.rear);
}

// Of which a vehicle may hide most.
bool isPainted(const SlotEvidence::Line& line) {
  constexpr double kContrast = 0.5;
  constexpr double kPaint = 0.5;  // m
  return line.contrast() > kContrast && line.paint() > kPaint;
}

// A vehicle between two painted sides, or beside one where it, or its neighbour, hides the other.
// What the layers hold there beside it is painted on it or reads so: its smear lies on the ground
// from where the cameras look.
bool holdsVehicle(const SlotEvidence& evidence) {
  constexpr double kVehicle = 0.6;  // of its middle
  constexpr double kAll = 0.9;
  const int painted = (isPainted(evidence.left) ? 1 : 0) + (isPainted(evidence.right) ? 1 : 0);
  return evidence.vehicle_amid > (painted == 2 ? kVehicle : kAll) && painted > 0;
}

// An entrance between lane lines passes for one of them now and then. Numbers and wheel stops are
// in slots only.
bool isSlotAnyway(const SlotEvidence& evidence) {
  constexpr double kPaint = 0.1;  // m^2
  return evidence.number_m2 > kPaint || evidence.stop_m2 > kPaint || isBoundedAsSlots(evidence);
}

// Of what few places but slots show.
double logOddsOf(int showing, int slots) {
  constexpr double kElsewhere = 0.02;
  return std::max(0.0, std::log((showing + 1.0) / (slots + 2.0) / kElsewhere));
}

}  // namespace

void SlotLikelihood::Lines::add(const SlotEvidence::Line& line) {
  if (line.seen_m < kLeastSeen) return;
  ++all;
  if (shows(line)) ++shown;
  contrast += line.contrast();
}

double SlotLikelihood::Lines::logOdds(const SlotEvidence::Line& line) const {
  if (line.seen_m < kLeastSeen) return 0.0;
  constexpr double kByChance = 0.05;
  // The slots told are those whose lines show: of others' at least every second one does not.
  constexpr double kLeastMissed = 0.5;
  const double missed = std::max(kLeastMissed, (all - shown + 1.0) / (all + 3.0));
  return shows(line) ? std::log((1.0 - missed) / kByChance) : std::log(missed / (1.0 - kByChance));
}

void SlotLikelihood::learn(const SlotEvidence& evidence) {
  sides_.add(evidence.left);
  sides_.add(evidence.right);
  entrances_.add(evidence.entrance);
  ++slots_;
  if (showsNumber(evidence)) ++numbered_;
  if (showsStop(evidence)) ++with_stop_;
}

double SlotLikelihood::side(const SlotEvidence::Line& line) const {
  return sides_.logOdds(line);
}

double SlotLikelihood::entrance(const SlotEvidence::Line& line) const {
  return entrances_.logOdds(line);
}

double SlotLikelihood::vehicle(const SlotEvidence& evidence) {
  constexpr double kParked = 0.35;  // covered, of what is seen
  constexpr double kOften = 0.5;    // of slots hold a vehicle
  constexpr double kSeldom = 0.05;  // of other places
  if (evidence.seen < SlotEvidence::kLeastSeen) return 0.0;
  return evidence.vehicle > kParked ? std::log(kOften / kSeldom)
                                    : std::log((1.0 - kOften) / (1.0 - kSeldom));
}

double SlotLikelihood::number(const SlotEvidence& evidence) const {
  return showsNumber(evidence) ? logOddsOf(numbered_, slots_) : 0.0;
}

double SlotLikelihood::stop(const SlotEvidence& evidence) const {
  return showsStop(evidence) ? logOddsOf(with_stop_, slots_) : 0.0;
}

double SlotLikelihood::whole(const SlotEvidence& evidence) const {
  return side(evidence.left) + side(evidence.right) + entrance(evidence.entrance) +
         vehicle(evidence) + number(evidence) + stop(evidence);
}

bool SlotLikelihood::isPaintedAndFree(const SlotEvidence& evidence) const {
  constexpr double kWorn = 0.8;   // contrast of sides told, on average
  constexpr double kEmpty = 0.2;  // covered by vehicles at most
  return sides_.contrast >= kWorn * sides_.all && !showsNumber(evidence) && !showsStop(evidence) &&
         evidence.vehicle <= kEmpty;
}

bool SlotLikelihood::lacksAllLines(const SlotEvidence& evidence) const {
  constexpr double kSeen = 1.4;  // m of each
  return isPaintedAndFree(evidence) && isBare(evidence.entrance, kSeen) &&
         isBare(evidence.left, kSeen) && isBare(evidence.right, kSeen);
}

bool SlotLikelihood::lacksSide(const SlotEvidence& evidence) const {
  constexpr double kSeen = 0.9;     // of the slot
  constexpr double kPlainly = 3.0;  // m of a side in sight
  if (!isPaintedAndFree(evidence) || evidence.seen < kSeen) return false;
  return isBare(evidence.left, kPlainly) || isBare(evidence.right, kPlainly);
}

bool isGapBetweenSlots(const SlotEvidence& evidence) {
  constexpr double kVehicle = 0.3;  // of its middle: smears of those beside it reach so far
  constexpr double kLaneAhead = 0.3;
  constexpr double kStructure = 0.025;  // a pillar's foot
  if (isBoundedAsSlots(evidence) || showsNumber(evidence) || showsStop(evidence)) return false;
  return evidence.vehicle_amid < kVehicle &&
         (evidence.lane_ahead > kLaneAhead || evidence.structure_inside > kStructure);
}

bool isDenied(const SlotEvidence& evidence) {
  constexpr double kMarkers = 0.02;
  constexpr double kLanes = 0.02;
  constexpr double kLines = 0.03;
  constexpr double kStructure = 0.08;
  constexpr double kLaneAhead = 0.6;
  constexpr double kDivider = 0.7;
  constexpr double kSign = 0.6;  // m^2, larger than numbers
  constexpr double kAside = 0.15;
  if (evidence.number_m2 > kSign && evidence.number_aside > kAside) return true;
  const bool has_lane_ahead = evidence.lane_ahead > kLaneAhead && !isSlotAnyway(evidence);
  const bool holds_others =
      evidence.markers_inside > kMarkers || evidence.structure_inside > kStructure;
  return (holds_others && !holdsVehicle(evidence)) || evidence.lanes_inside > kLanes ||
         evidence.lines_inside > kLines || has_lane_ahead || evidence.divider > kDivider ||
         isGapBetweenSlots(evidence);
}

void setFree(const SlotEvidence& evidence, MapSlot& slot) {
  constexpr double kVehicle = 0.25;
  if (evidence.seen > SlotEvidence::kLeastSeen)
    slot.probability_free = evidence.vehicle_amid > kVehicle ? 0.1 : 0.9;
}

}  // namespace parkade::slot_rows
