// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/core/options.hpp"
#include "parkade/fusion/odometry.hpp"
#include "parkade/localization/compass.hpp"
#include "parkade/localization/loop_closure.hpp"
#include "parkade/localization/map_search.hpp"
#include "parkade/localization/registration.hpp"
#include "parkade/localization/row_compass.hpp"
#include "parkade/mapping/global_map.hpp"
#include "parkade/mapping/local_map.hpp"
#include "parkade/mapping/objects/object_registry.hpp"
#include "parkade/mapping/slots/slot_registry.hpp"

namespace parkade {

/// How a drive is cut into submaps, and how frames register to them (docs/math/registration.md).
struct SubmapOptions {
  double length_m = 5.0;
  double rotation_deg = 60.0;
  double frame_distance_m = 0.25;
  double min_age_m = 3.0;
  double revisit_age_m = 30.0;
  double register_distance_m = 1.0;
  double passage_sigma_m = 0.0153;
  double sigma_m = 0.008;
  double sigma_deg = 0.048;
  double doubling_distance_m = 5.0;
  double gate_probability = 0.999;
  double height_sigma_m = 0.0153;
  int max_anchors = 160;

  void visit(OptionVisitor& v) {
    v.field("length_m", length_m, "m", "A submap holds this much of the drive.", 1.0, 50.0);
    v.field("rotation_deg", rotation_deg, "deg", "Or ends after such a turn.", 5.0, 360.0);
    v.field("frame_distance_m", frame_distance_m, "m", "Between frames that enter a submap.", 0.0,
            5.0);
    v.field("min_age_m", min_age_m, "m",
            "Frames register to submaps that ended this far back, which they did not build.", 0.0,
            100.0);
    v.field("revisit_age_m", revisit_age_m, "m", "A submap that ended earlier is a revisit.", 5.0,
            1000.0);
    v.field("register_distance_m", register_distance_m, "m", "Between frames that are registered.",
            0.1, 50.0);
    v.field("passage_sigma_m", passage_sigma_m, "m",
            "Frames register to submaps of their own passage only where the odometry since then is "
            "less sure than this.",
            0.0, 1.0);
    v.field("sigma_m", sigma_m, "m",
            "Error that registrations to a submap share (calibration, levelling, labels), where "
            "the frame lies on it.",
            0.0, 1.0);
    v.field("sigma_deg", sigma_deg, "deg", "The same of their heading.", 0.0, 5.0);
    v.field("doubling_distance_m", doubling_distance_m, "m",
            "Both are twice as large where the frame's middle is so far from the submap's, and "
            "grow with the square.",
            0.1, 1000.0);
    v.field("gate_probability", gate_probability, "probability",
            "Registrations that are kept, of those that are right.", 0.5, 0.999999);
    v.field("height_sigma_m", height_sigma_m, "m",
            "How well heights agree where the car comes back to a place.", 0.001, 1.0);
    v.field("max_anchors", max_anchors, "count",
            "Past poses that are corrected; older ones stay as they are.", 4, 2000);
  }
};

/// How a drive finds itself in a saved map and holds to it.
struct SavedMapOptions {
  double gathered_m = 30.0;
  double least_m = 6.0;
  double every_m = 2.0;
  double agree_m = 0.3;
  double agree_deg = 1.0;
  double found_sigma_m = 0.2;
  double found_sigma_deg = 1.0;
  double told_sigma_m = 0.1;
  double give_up_m = 15.0;
  double sigma_m = 0.02;
  double sigma_deg = 0.1;
  MapSearchOptions search;

  void visit(OptionVisitor& v) {
    v.field("gathered_m", gathered_m, "m", "What was seen over this much of the way is looked for.",
            1.0, 500.0);
    v.field("least_m", least_m, "m", "Nor before so much of it.", 0.0, 500.0);
    v.field("every_m", every_m, "m", "Way between two searches.", 0.1, 100.0);
    v.field("agree_m", agree_m, "m", "Two searches one after the other that agree to this find it.",
            0.01, 5.0);
    v.field("agree_deg", agree_deg, "deg", "The same of the heading.", 0.01, 20.0);
    v.field("found_sigma_m", found_sigma_m, "m",
            "How well a search knows the place; the frames after it tell it better.", 0.0, 2.0);
    v.field("found_sigma_deg", found_sigma_deg, "deg", "The same of the heading.", 0.0, 20.0);
    v.field("told_sigma_m", told_sigma_m, "m",
            "Poses are given out once the place is known to this.", 0.01, 5.0);
    v.field("give_up_m", give_up_m, "m",
            "A place that no frame has confirmed over this much of the way is searched anew.", 1.0,
            1000.0);
    v.field("sigma_m", sigma_m, "m",
            "Error that registrations to one place of the map share: its own, there.", 0.0, 1.0);
    v.field("sigma_deg", sigma_deg, "deg", "The same of their heading.", 0.0, 5.0);
    v.group("search", search);
  }
};

struct FusedMapperOptions {
  OdometryNoiseOptions odometry;
  SubmapOptions submaps;
  RegistrationOptions registration;
  LoopOptions loop;
  CompassOptions compass;
  RowCompassOptions rows;
  SavedMapOptions saved_map;
  LocalMapOptions local_map;
  GlobalMapOptions global_map;
  SlotRegistryOptions slots;
  ObjectRegistryOptions objects;

  void visit(OptionVisitor& v) {
    v.group("odometry", odometry);
    v.group("submaps", submaps);
    v.group("registration", registration);
    v.group("loop", loop);
    v.group("compass", compass);
    v.group("rows", rows);
    v.group("saved_map", saved_map);
    v.group("local_map", local_map);
    v.group("global_map", global_map);
    v.group("slots", slots);
    v.group("objects", objects);
  }
};

}  // namespace parkade
