// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "parkade/bev/ground_table.hpp"
#include "parkade/camera/rig.hpp"
#include "parkade/core/options.hpp"
#include "parkade/types/bev_image.hpp"
#include "parkade/types/ground_relief.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

struct BevOptions {
  int width_px = 384;
  int height_px = 384;
  double metres_per_px = 0.04;
  double max_range_m = 12.0;
  double border_px = 2.0;
  double car_margin_m = 0.05;
  bool balance_gains = true;
  double gain_smoothing = 0.2;

  void visit(OptionVisitor& v) {
    v.field("width_px", width_px, "px", "Width of the bird's-eye picture.", 16, 8192);
    v.field("height_px", height_px, "px", "Height of the bird's-eye picture.", 16, 8192);
    v.field("metres_per_px", metres_per_px, "m", "Ground length of a pixel.", 0.001, 1.0);
    v.field("max_range_m", max_range_m, "m", "Ground further from a camera is left out.", 0.5);
    v.field("border_px", border_px, "px", "Image border that is not used.", 0.0, 100.0);
    v.field("car_margin_m", car_margin_m, "m", "The own car's mask is larger than its body.", 0.0,
            2.0);
    v.field("balance_gains", balance_gains,
            "Balance brightness between cameras where they overlap.");
    v.field("gain_smoothing", gain_smoothing, "share", "Share of a new gain taken per picture.",
            0.0, 1.0);
  }
};

/// Stitches the cameras of a rig into one bird's-eye picture. Not thread-safe: it keeps buffers and
/// the gains of the pictures before.
class BevStitcher {
 public:
  /// The picture's middle is the middle of the car's body where the rig has a vehicle, else the
  /// vehicle frame's origin.
  BevStitcher(const Rig& rig, const BevOptions& options);

  /// Where the own body hides the world from a camera: CV_8UC1 of its image's size, 0 where it
  /// does (checked).
  void setMask(int camera, const cv::Mat& mask);

  /// The camera sits elsewhere than the rig said; its mask stays.
  void moveCamera(int camera, const SE3& T_vehicle_cam);

  /// A rolling shutter, as the rig says of the camera, takes longer or less long than told, s.
  void setReadoutTime(int camera, double seconds);

  /// Images must have the sizes of the rig's cameras and be all grey or all BGR (checked); empty
  /// ones are left out. relief: of the floor over the attitude's plane. motion: the picture is that
  /// of the frame set's stamp, however long cameras take to read their rows.
  [[nodiscard]] BevImage stitch(const FrameSet& frames, const GroundAttitude& attitude = {},
                                const GroundRelief& relief = {}, const GroundMotion& motion = {});

  [[nodiscard]] const BevGeometry& geometry() const { return geometry_; }
  [[nodiscard]] const GroundTable& table(int camera) const { return tables_[camera]; }
  /// Factors that the pictures are multiplied with, one per camera.
  [[nodiscard]] std::vector<double> gains() const;

 private:
  struct Overlap {
    int first = 0;
    int second = 0;
    std::vector<cv::Point> pixels;  ///< of the bird's-eye picture
  };
  GroundTable& tableOf(int camera);
  void findOverlaps();
  void updateGains(const FrameSet& frames);

  BevOptions options_;
  Rig rig_;
  BevGeometry geometry_;
  std::vector<GroundTable> tables_;
  std::vector<cv::Mat> masks_;  ///< of the own body; empty: none
  std::vector<Overlap> overlaps_;
  cv::Mat car_mask_;  ///< 255 on the own car
  Eigen::VectorXd log_gains_;
  bool has_gains_ = false;
  std::vector<cv::Mat> warped_;  ///< each camera's part, in its table's region
  cv::Mat map_x_, map_y_, sum_, weight_sum_;
};

}  // namespace parkade
