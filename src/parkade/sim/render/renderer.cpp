// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/renderer.hpp"

#include <chrono>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/core/log.hpp"
#include "parkade/core/random.hpp"

namespace parkade::sim {
namespace {

constexpr SubdivisionLimits kLimits{};

BakedLight timedBake(const Scene& scene, const StaticTracer& tracer, const RenderOptions& options,
                     double& seconds) {
  const auto start = std::chrono::steady_clock::now();
  BakedLight light = bakeLight(scene, tracer, options.bake, options.threads);
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  logInfo(
      "light baked in {:.1f} s: {} triangles, {} vertices, floor {} x {}, {:.1f} lux before "
      "scaling to {:.1f}",
      seconds, tracer.mesh().triangles.size(), tracer.mesh().positions.size(), light.floor_grid.nx,
      light.floor_grid.ny, light.raw_floor_lux, light.mean_floor_lux);
  return light;
}

}  // namespace

/// Ray tables of a camera; those of sub-frames sit at the four sample places of a pixel in turn.
struct Renderer::CameraTables {
  Camera camera;
  RayTable picture;
  std::optional<RayTable> edges;          ///< where the picture has one sample per pixel
  std::optional<RayTable> other_centers;  ///< where the picture's samples are not the centers
  [[nodiscard]] const RayTable& centers() const { return other_centers ? *other_centers : picture; }
  [[nodiscard]] const RayTable* finer() const { return edges ? &*edges : nullptr; }
  std::vector<RayTable> sub_frames;
  std::vector<float> lens_share;
};

Renderer::Renderer(std::shared_ptr<const Scene> scene, const RenderOptions& options)
    : scene_(std::move(scene)),
      options_(options),
      device_(makeEmbreeDevice()),
      tracer_(device_.get(), flatten(*scene_, kLimits, device_.get())),
      light_(timedBake(*scene_, tracer_, options_, bake_seconds_)),
      shader_(*scene_, tracer_, light_),
      moments_(*scene_, device_.get(), light_, kLimits),
      sensor_(options_.sensor) {}

Renderer::~Renderer() = default;

int Renderer::addCamera(const Camera& camera) {
  const int grid = options_.fast ? 1 : 2;
  const int threads = options_.threads;
  auto tables = std::make_unique<CameraTables>(
      CameraTables{camera, RayTable(camera, grid, {0.0, 0.0}, threads), {}, {}, {}, {}});
  if (grid == 1) tables->edges.emplace(camera, 2, Eigen::Vector2d(0.0, 0.0), threads);
  if (grid > 1) tables->other_centers.emplace(camera, 1, Eigen::Vector2d(0.0, 0.0), threads);
  tables->lens_share = sensor_.lensShare(tables->picture.axisCosines());
  if (options_.sensor.motion_blur > 1) {
    for (int k = 0; k < 4; ++k) {
      tables->sub_frames.emplace_back(camera, 1, RayTable::samplePlace(k), threads);
    }
  }
  cameras_.push_back(std::move(tables));
  return static_cast<int>(cameras_.size()) - 1;
}

const Renderer::CameraTables& Renderer::tables(int camera) const {
  PARKADE_CHECK(camera >= 0 && camera < static_cast<int>(cameras_.size()), "camera {} of {}",
                camera, cameras_.size());
  return *cameras_[static_cast<std::size_t>(camera)];
}

std::shared_ptr<const Moment> Renderer::moment(double t,
                                               const std::optional<SE3>& T_world_vehicle) const {
  return moments_.make(t, T_world_vehicle);
}

FrameSetup Renderer::setupFor(const Moment& moment) const {
  FrameSetup setup;
  setup.tracer = &tracer_;
  setup.shader = &shader_;
  setup.moment = &moment;
  setup.reflections = options_.reflections;
  setup.threads = options_.threads;
  return setup;
}

Radiance Renderer::renderRadiance(int camera, const SE3& T_world_cam, const Moment& moment) const {
  Radiance radiance;
  traceFrame(setupFor(moment), tables(camera).picture, T_world_cam, radiance,
             tables(camera).finer());
  return radiance;
}

CameraPlaces Renderer::placesOf(int camera, const CameraMotion& motion, double t) const {
  return {motion, t, tables(camera).picture.height()};
}

cv::Mat Renderer::render(int camera, const CameraPlaces& places, const Moment& moment,
                         std::uint64_t frame) const {
  thread_local Radiance radiance;  // kept: fresh memory costs a page fault per 4 kB
  traceFrame(setupFor(moment), tables(camera).picture, places, radiance, tables(camera).finer());
  return sensor_.expose(radiance, sensor_.meter(radiance), tables(camera).lens_share,
                        hash64(static_cast<std::uint64_t>(camera), frame), options_.threads);
}

cv::Mat Renderer::render(int camera, const CameraMotion& motion, double t,
                         std::uint64_t frame) const {
  const int count = options_.sensor.motion_blur;
  if (count <= 1) {
    return render(camera, placesOf(camera, motion, t), *moment(t, motion.T_world_vehicle(t)),
                  frame);
  }
  const CameraTables& c = tables(camera);
  Radiance sum;
  Exposure exposure;
  for (int k = 0; k < count; ++k) {
    // The first sub-frame, in the middle, sets the exposure that the others spread over.
    const int part = (k + count / 2) % count;
    const double offset = k == 0 ? 0.0 : exposure.time_s * ((part + 0.5) / count - 0.5);
    const auto now = moment(t + offset, motion.T_world_vehicle(t + offset));
    Radiance sub;
    traceFrame(setupFor(*now), c.sub_frames[static_cast<std::size_t>(k % 4)],
               placesOf(camera, motion, t + offset), sub);
    if (k == 0) {
      exposure = sensor_.meter(sub);
      sum = std::move(sub);
    } else {
      for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        sum.pixels[i] += sub.pixels[i];
      }
    }
  }
  for (Eigen::Vector3f& pixel : sum.pixels) {
    pixel /= static_cast<float>(count);
  }
  return sensor_.expose(sum, exposure, c.lens_share,
                        hash64(static_cast<std::uint64_t>(camera), frame), options_.threads);
}

TruthImages Renderer::renderTruth(int camera, const CameraPlaces& places,
                                  const Moment& moment) const {
  Truth truth;
  traceTruth(setupFor(moment), tables(camera).centers(), places, truth);
  TruthImages images;
  images.labels = cv::Mat(truth.height, truth.width, CV_8UC1, truth.labels.data()).clone();
  images.instances = cv::Mat(truth.height, truth.width, CV_32SC1, truth.instances.data()).clone();
  images.depths = cv::Mat(truth.height, truth.width, CV_32FC1, truth.depths.data()).clone();
  return images;
}

}  // namespace parkade::sim
