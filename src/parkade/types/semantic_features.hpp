// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/ground_relief.hpp"
#include "parkade/types/semantic_class.hpp"
#include "parkade/types/text_reading.hpp"

// What the semantics room says of one frame set. All positions are in the levelled vehicle frame of
// bev_image.hpp (x forward, y left, z up from the ground under the rear axle), in metres;
// covariances are of what is measured in that frame and hold the errors of pitch, roll and height
// as well.

namespace parkade {

/// Steps of BevLabels' evidence (slot_line, paint) that a log-odds of one takes.
constexpr double kEvidencePerLogOdds = 25.0;

/// The class of every pixel of a bird's-eye picture.
struct BevLabels {
  TimeNs t_ns = 0;
  BevGeometry geometry;
  cv::Mat labels;      ///< CV_8UC1: SemanticClass; kUnknown where nothing is seen
  cv::Mat confidence;  ///< CV_8UC1: probability of that class, 255 = 1
  /// CV_8UC1, or empty: the evidence of a slot line, whatever the label. 255 where the network says
  /// one; less by kEvidencePerLogOdds for each by which it holds another class likelier; at least
  /// 0.
  cv::Mat slot_line;
  cv::Mat paint;  ///< the same of any paint (isPaint)
};

/// A point on the middle of a painted line, measured to a fraction of a pixel across the line.
struct LinePoint {
  Eigen::Vector2d p_level = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  ///< unit, across the line
  double sigma = 0.0;                                 ///< m, along the normal
  SemanticClass semantic_class = SemanticClass::kSlotLine;
};

/// A straight piece of painted line.
struct LineSegment {
  Eigen::Vector2d begin = Eigen::Vector2d::Zero();
  Eigen::Vector2d end = Eigen::Vector2d::Zero();
  double width = 0.0;          ///< m
  double sigma_offset = 0.0;   ///< m, across, at the middle
  double sigma_heading = 0.0;  ///< rad
  SemanticClass semantic_class = SemanticClass::kSlotLine;
};

enum class SlotShape : std::uint8_t { kPerpendicular = 0, kParallel = 1, kSlanted = 2 };

/// How a slot is painted: all around, or with the entrance side open.
enum class SlotMarking : std::uint8_t { kClosed = 0, kT = 1, kL = 2, kOpen = 3 };

/// A slot as one bird's-eye picture shows it.
struct SlotObservation {
  /// Entrance left, entrance right (as a driver entering nose first sees them), rear right, rear
  /// left; on the middle of the painted lines.
  std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                            Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  Eigen::Matrix4d entrance_covariance = Eigen::Matrix4d::Zero();  ///< of corners 0 and 1, m^2
  bool rear_seen = false;  ///< corners 2 and 3 were measured, not completed from the depth
  SlotShape shape = SlotShape::kPerpendicular;
  SlotMarking marking = SlotMarking::kClosed;
  double probability_free = 0.5;
  /// Share of its middle that lies behind its entrance as the cameras see it: elsewhere a
  /// neighbour's car may stand before it, and its smear pass for one in the slot.
  double seen_over_entrance = 1.0;
  double confidence = 0.0;  ///< that it is a slot, 0 to 1
  /// Readings of the number painted in it, most probable first; empty where none was read.
  std::vector<TextReading> number;
  Eigen::Vector2d number_place = Eigen::Vector2d::Zero();  ///< its middle, where it was read
};

/// Anything else with a place: arrow, limit, stop line, crossing, bump, pillar, zone marker, sign.
struct ObjectObservation {
  SemanticClass semantic_class = SemanticClass::kUnknown;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m^2, of position
  double heading = 0.0;        ///< rad: direction of travel it speaks to, or its face's normal
  double sigma_heading = 0.0;  ///< rad; 0 where the object has no heading
  std::string text;            ///< "B12", "10", "straight_left", "EXIT"
  std::vector<Eigen::Vector2d> outline;  ///< on the ground, counter-clockwise; may be empty
  double confidence = 0.0;
};

/// A vehicle or a person, tracked over frames.
struct MovingObservation {
  std::uint64_t id = 0;
  SemanticClass semantic_class = SemanticClass::kVehicle;
  Eigen::Vector2d contact = Eigen::Vector2d::Zero();  ///< nearest ground point, or between the feet
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  ///< over the ground, m/s
  Eigen::Vector2d size = Eigen::Vector2d::Zero();      ///< length and width, m
  double heading = 0.0;
  bool moving = false;
};

/// A key point that surely lies above the floor, near the car.
struct RaisedPoint {
  std::uint64_t id = 0;  ///< of its landmark
  /// Levelled vehicle frame, m.
  Eigen::Vector3d p_level = Eigen::Vector3d::Zero();
};

/// All semantic features of one frame set.
struct SemanticFrame {
  BevLabels labels;
  /// CV_8UC1 of the labels' size, or empty: kSmear where a label is what a picture draws of
  /// something upright behind its foot, and says nothing of the ground there; kBehindEdge where it
  /// may be its foot, or floor that it hides; else 0.
  cv::Mat smear;
  static constexpr std::uint8_t kSmear = 255;
  static constexpr std::uint8_t kBehindEdge = 128;
  GroundAttitude attitude;      ///< that the picture was levelled with
  GroundRelief relief;          ///< and the floor over its plane
  double attitude_sigma = 0.0;  ///< rad, of its pitch and roll
  /// rad: how far the cameras, all together, had been turned about the car's z from where the
  /// calibration says, when the picture was stitched.
  double rig_turn = 0.0;
  std::vector<LinePoint> line_points;
  std::vector<LineSegment> line_segments;
  std::vector<SlotObservation> slots;
  std::vector<ObjectObservation> objects;
  std::vector<MovingObservation> moving;
  std::vector<RaisedPoint> raised;
};

}  // namespace parkade
