// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "parkade/camera/camera.hpp"
#include "parkade/core/options.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/sim/render/camera_places.hpp"
#include "parkade/sim/render/frame.hpp"
#include "parkade/sim/render/light_bake.hpp"
#include "parkade/sim/render/sensor_model.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

struct RenderOptions {
  bool fast = false;
  bool reflections = true;
  int threads = 2;
  BakeOptions bake;
  SensorOptions sensor;
  void visit(OptionVisitor& v) {
    v.field("fast", fast, "One sample per pixel, 2 x 2 only where a surface ends.");
    v.field("reflections", reflections, "Mirror images in glossy floors and cars.");
    v.field("threads", threads, "count", "Threads per picture; the pictures do not depend on it.",
            1, 256);
    v.group("bake", bake);
    v.group("sensor", sensor);
  }
};

/// What each pixel's centre shows.
struct TruthImages {
  cv::Mat labels;     ///< CV_8UC1, SemanticClass
  cv::Mat instances;  ///< CV_32SC1, object ids; 0 structure, -1 the own car
  cv::Mat depths;     ///< CV_32FC1, m along the ray; 0: nothing
};

/// A bird's-eye picture and its labels.
struct OrthoImages {
  cv::Mat colour;  ///< CV_8UC3 BGR, evenly exposed, without noise
  cv::Mat labels;  ///< CV_8UC1, SemanticClass
};

/// Draws a scene: static geometry in one tree, light baked once, moving objects placed per moment.
/// After the cameras are added all drawing functions may be called from several threads. The same
/// call gives the same bytes for any number of threads.
class Renderer {
 public:
  /// Builds trees and bakes the light (seconds). The scene must have a floor and a lamp.
  Renderer(std::shared_ptr<const Scene> scene, const RenderOptions& options);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Prepares a camera and returns its index. Not at the same time as drawing.
  int addCamera(const Camera& camera);

  /// Everything that moves at t seconds, for all cameras of that time. Without a vehicle pose the
  /// own car is not drawn.
  [[nodiscard]] std::shared_ptr<const Moment> moment(
      double t, const std::optional<SE3>& T_world_vehicle) const;

  /// The picture that the camera delivers, CV_8UC3 BGR. frame counts pictures; with the camera's
  /// index it picks the noise.
  [[nodiscard]] cv::Mat render(int camera, const CameraPlaces& places, const Moment& moment,
                               std::uint64_t frame) const;

  /// The same with the motion within the exposure, when sensor.motion_blur asks for sub-frames, and
  /// from row to row of a rolling shutter; t is the middle of the middle row's exposure.
  [[nodiscard]] cv::Mat render(int camera, const CameraMotion& motion, double t,
                               std::uint64_t frame) const;

  /// Linear light before the sensor.
  [[nodiscard]] Radiance renderRadiance(int camera, const SE3& T_world_cam,
                                        const Moment& moment) const;

  [[nodiscard]] TruthImages renderTruth(int camera, const CameraPlaces& places,
                                        const Moment& moment) const;
  /// Where a camera of this renderer stands while its rows are read, the middle one at t.
  [[nodiscard]] CameraPlaces placesOf(int camera, const CameraMotion& motion, double t) const;

  /// CV_8UC1, SemanticClass along any lines of sight from a camera's place: directions_cam is
  /// CV_32FC3, in the camera frame, of any length. kUnknown where the direction is zero, and on the
  /// own car.
  [[nodiscard]] cv::Mat renderSights(const cv::Mat& directions_cam, const SE3& T_world_cam,
                                     const Moment& moment) const;

  /// The ground around the vehicle from straight above, without ceiling and hanging signs and
  /// without the own car: row 0 lies ahead, column 0 to the left, the vehicle's origin at the
  /// image's centre ((size - 1) / 2). Follows the vehicle's heading, not its pitch and roll.
  [[nodiscard]] OrthoImages renderOrtho(const SE3& T_world_vehicle, int size_px,
                                        double metres_per_px, double t) const;

  /// A picture of the garage with its ceiling taken off; without noise.
  [[nodiscard]] cv::Mat renderOverview(const Camera& camera, const SE3& T_world_cam,
                                       double t) const;

  [[nodiscard]] const BakedLight& light() const { return light_; }
  [[nodiscard]] double bakeSeconds() const { return bake_seconds_; }

 private:
  struct CameraTables;
  [[nodiscard]] FrameSetup setupFor(const Moment& moment) const;
  [[nodiscard]] const CameraTables& tables(int camera) const;

  std::shared_ptr<const Scene> scene_;
  RenderOptions options_;
  EmbreeDevice device_;
  StaticTracer tracer_;
  double bake_seconds_ = 0.0;  ///< before light_, whose making sets it
  BakedLight light_;
  Shader shader_;
  MomentMaker moments_;
  SensorModel sensor_;
  std::vector<std::unique_ptr<CameraTables>> cameras_;
};

}  // namespace parkade::sim
