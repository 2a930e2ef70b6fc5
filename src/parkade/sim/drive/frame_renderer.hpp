// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>

#include "parkade/core/result.hpp"
#include "parkade/sim/drive/sim_source.hpp"
#include "parkade/sim/drive/simulation.hpp"
#include "parkade/sim/render/renderer.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

/// The scene of a simulation: its garage with parked cars, what moves (clear of the own car),
/// light.
std::shared_ptr<const Scene> makeScene(const Simulation& simulation);

/// Draws what the cameras of a simulated drive see, frame set by frame set, in any order.
class FrameRenderer {
 public:
  /// Builds the scene and bakes its light: seconds.
  static Result<std::unique_ptr<FrameRenderer>> make(std::shared_ptr<const Simulation> simulation);

  /// Which cameras to draw of a frame set; the others' images stay empty. Empty: all.
  using Wanted = std::vector<bool>;
  [[nodiscard]] FrameSet draw(int index, const Wanted& wanted = {}) const;

  /// CV_8UC1, SemanticClass of every pixel of a camera's picture.
  [[nodiscard]] cv::Mat labels(int index, int camera) const;
  /// The ground around the car from above.
  [[nodiscard]] OrthoImages groundView(int index, int size_px, double metres_per_px) const;
  /// CV_8UC1: 0 where the own car hides the world from a camera.
  [[nodiscard]] cv::Mat bodyMask(int camera) const;
  /// The whole garage without its ceiling, seen from above its middle; and its true plan.
  [[nodiscard]] cv::Mat overview(int width_px) const;

  [[nodiscard]] const Scene& scene() const { return *scene_; }
  [[nodiscard]] const Renderer& renderer() const { return *renderer_; }
  [[nodiscard]] const Simulation& simulation() const { return *simulation_; }

 private:
  FrameRenderer() = default;
  [[nodiscard]] double secondsOf(int index) const;
  [[nodiscard]] CameraMotion motionOf(int camera) const;

  std::shared_ptr<const Simulation> simulation_;
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<Renderer> renderer_;
};

/// A picture in gray, CV_8UC1.
cv::Mat grayOf(const cv::Mat& bgr);

struct SimSourceOptions {
  std::string cameras;    ///< names with commas between them; empty: all
  bool gray = false;      ///< CV_8UC1 instead of BGR
  double duration = 0.0;  ///< s; 0: as the address says
};

/// Opens an address (parseSimAddress) as a source with pictures, unless it says images=0. With
/// pictures, scene and light are made here, and the rig tells where the own body hides the world.
Result<std::unique_ptr<SimSource>> openSimSource(const std::string& address,
                                                 const SimSourceOptions& options = {});

}  // namespace parkade::sim
