// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/core/options.hpp"

namespace parkade {

struct VioWindowOptions {
  int keyframes = 12;
  int recent_frames = 3;
  int max_iterations = 2;
  int max_landmarks = 800;
  double cauchy = 0.7;
  double outlier_sigma = 5.0;

  void visit(OptionVisitor& v) {
    v.field("keyframes", keyframes, "count", "Keyframes kept in the window.", 3, 40);
    v.field("recent_frames", recent_frames, "count",
            "Newest frames kept beside the keyframes, whether keyframes or not.", 2, 10);
    v.field("max_iterations", max_iterations, "count", "Gauss-Newton steps per frame set, at most.",
            1, 50);
    v.field("max_landmarks", max_landmarks, "count",
            "Landmarks in one solve over all cameras; bounds the time per frame set.", 20, 5000);
    v.field("cauchy", cauchy, "sigma",
            "Scale of the Cauchy loss of whitened reprojection errors: at it one counts half.", 0.1,
            100.0);
    v.field("outlier_sigma", outlier_sigma, "sigma",
            "Observations that miss their landmark by more after a solve are removed.", 1.0, 100.0);
  }
};

struct VioKeyframeOptions {
  double parallax_deg = 10.0;
  double min_overlap = 0.4;
  double max_interval_s = 1.0;
  double distance_m = 0.8;
  double rotation_deg = 8.0;

  void visit(OptionVisitor& v) {
    v.field("parallax_deg", parallax_deg, "deg",
            "Mean bearing change of the common features, rotation removed, that makes a keyframe.",
            0.05, 90.0);
    v.field("min_overlap", min_overlap, "ratio",
            "A frame that shares less of its features with the last keyframe becomes one.", 0.0,
            1.0);
    v.field("max_interval_s", max_interval_s, "s", "Longest time between keyframes in motion.",
            0.05, 60.0);
    v.field("distance_m", distance_m, "m", "Distance from the last keyframe that makes one.", 0.01,
            100.0);
    v.field("rotation_deg", rotation_deg, "deg", "Turn since the last keyframe that makes one.",
            0.1, 180.0);
  }
};

struct VioStandstillOptions {
  bool enable = true;
  double window_s = 0.5;
  double noise_tolerance = 2.0;
  double gyro_floor = 0.003;
  double accel_floor = 0.05;
  double max_disparity_px = 0.6;
  double max_shift_px = 0.05;
  double max_speed = 0.15;

  void visit(OptionVisitor& v) {
    v.field("enable", enable, "Detect rest and hold the car's pose there.");
    v.field("window_s", window_s, "s", "Stretch of IMU readings that must be quiet.", 0.1, 2.0);
    v.field("noise_tolerance", noise_tolerance, "ratio",
            "Spread of the readings that counts as quiet, over the sensor's white noise.", 1.0,
            100.0);
    v.field("gyro_floor", gyro_floor, "rad/s", "Added to the limit of the gyroscope's spread.", 0.0,
            1.0);
    v.field("accel_floor", accel_floor, "m/s^2",
            "Added to the limit of the accelerometer's spread.", 0.0, 10.0);
    v.field("max_disparity_px", max_disparity_px, "px",
            "Median motion of the features between frames that still counts as rest.", 0.0, 20.0);
    v.field("max_shift_px", max_shift_px, "px",
            "Median shift of a camera's features that still counts as rest; most cameras decide.",
            0.0, 20.0);
    v.field("max_speed", max_speed, "m/s",
            "Without images, a car comes to rest only below this estimated speed.", 0.0, 10.0);
  }
};

struct VioStartUpOptions {
  double min_span_s = 0.4;
  double max_span_s = 0.8;
  double bias_gyro_sigma = 0.05;
  double bias_accel_sigma = 0.2;

  void visit(OptionVisitor& v) {
    v.field("min_span_s", min_span_s, "s", "Images needed before a start in motion is tried.", 0.1,
            10.0);
    v.field("max_span_s", max_span_s, "s",
            "After this span the best start is taken even if its scale is uncertain.", 0.1, 30.0);
    v.field("bias_gyro_sigma", bias_gyro_sigma, "rad/s", "Turn-on bias of the gyroscope, 1 sigma.",
            1e-6, 1.0);
    v.field("bias_accel_sigma", bias_accel_sigma, "m/s^2",
            "Turn-on bias of the accelerometer, 1 sigma.", 1e-6, 10.0);
  }
};

struct VioCalibrationOptions {
  bool refine_extrinsics = true;
  bool learn_sigmas = true;
  bool refine_time_offset = true;
  bool refine_readout_time = true;
  double position_sigma = 0.005;
  double rotation_sigma_deg = 0.1;
  double time_sigma = 0.005;
  double readout_sigma = 0.015;

  void visit(OptionVisitor& v) {
    v.field("refine_extrinsics", refine_extrinsics,
            "Estimate where each camera sits while driving, from the calibration on.");
    v.field("refine_time_offset", refine_time_offset,
            "Estimate each camera's time offset to the IMU while driving.");
    v.field("refine_readout_time", refine_readout_time,
            "Estimate how long each rolling shutter takes while driving, where the rig tells one.");
    v.field("learn_sigmas", learn_sigmas,
            "Learn how wrong the calibration is from how far cameras turn out to be off; the "
            "sigmas are where that begins. Not where the rig tells them.");
    v.field("position_sigma", position_sigma, "m", "Error of the calibrated positions, 1 sigma.",
            1e-5, 1.0);
    v.field("rotation_sigma_deg", rotation_sigma_deg, "deg",
            "Error of the calibrated rotations about each axis, 1 sigma.", 1e-3, 10.0);
    v.field("time_sigma", time_sigma, "s", "Error of the calibrated time offsets, 1 sigma.", 1e-5,
            0.1);
    v.field("readout_sigma", readout_sigma, "s", "Error of the told readout times, 1 sigma.", 1e-6,
            0.1);
  }
};

struct VioOptions {
  VioWindowOptions window;
  VioKeyframeOptions keyframe;
  VioStandstillOptions standstill;
  VioStartUpOptions start_up;
  VioCalibrationOptions calibration;
  double gravity = 9.81;
  double imu_noise_factor = 2.0;
  double max_imu_gap_s = 0.1;
  double max_blind_s = 10.0;
  bool use_wheel = false;
  double wheel_sigma = 0.05;
  double wheel_max_age_s = 0.1;
  bool use_no_side_slip = true;
  double side_slip_sigma = 0.01;
  double side_slip_in_curves = 0.03;
  bool use_planar = false;
  double planar_sigma = 0.03;

  void visit(OptionVisitor& v) {
    v.group("window", window);
    v.group("keyframe", keyframe);
    v.group("standstill", standstill);
    v.group("start_up", start_up);
    v.group("calibration", calibration);
    v.field("gravity", gravity, "m/s^2", "Magnitude of gravity.", 9.7, 9.9);
    v.field("imu_noise_factor", imu_noise_factor, "ratio",
            "Multiplies the calibration's IMU noise densities: real sensors shake, and errors of "
            "tracks, which last from frame to frame, must not pass for accelerations.",
            0.1, 100.0);
    v.field("max_imu_gap_s", max_imu_gap_s, "s",
            "Longer steps between IMU readings count as a gap, bridged with raised noise.", 0.005,
            10.0);
    v.field("max_blind_s", max_blind_s, "s",
            "Dead reckoning without images ends as lost after this time in motion.", 0.5, 600.0);
    v.field("use_wheel", use_wheel, "Use the rear wheels' speed where the car reports it.");
    v.field("wheel_sigma", wheel_sigma, "m/s", "Error of the wheels' mean speed, 1 sigma.", 1e-4,
            10.0);
    v.field("wheel_max_age_s", wheel_max_age_s, "s",
            "Wheel readings older than this at a frame are not used.", 0.0, 10.0);
    v.field("use_no_side_slip", use_no_side_slip,
            "Hold the sideways speed of the rear axle near zero, where the rig tells of a car.");
    v.field("side_slip_sigma", side_slip_sigma, "m/s", "Sideways speed, 1 sigma.", 1e-4, 10.0);
    v.field("side_slip_in_curves", side_slip_in_curves, "s",
            "What a sideways acceleration of 1 m/s^2 adds to that sigma, in squares: tyres slip.",
            0.0, 10.0);
    v.field("use_planar", use_planar, "Hold the speed across the car's own floor plane near zero.");
    v.field("planar_sigma", planar_sigma, "m/s", "Speed across the floor plane, 1 sigma.", 1e-4,
            10.0);
  }
};

}  // namespace parkade
