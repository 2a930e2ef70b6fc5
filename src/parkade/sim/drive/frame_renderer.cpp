// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/frame_renderer.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/core/split.hpp"
#include "parkade/sim/world/scene_builder.hpp"

namespace parkade::sim {

std::shared_ptr<const Scene> makeScene(const Simulation& simulation) {
  const SimSpec& spec = simulation.spec();
  SceneOptions options;
  options.lux = spec.lux;
  options.vehicles = spec.cars;
  options.pedestrians = spec.people;
  options.seed = spec.parkedSeed();
  options.agents_seed = spec.seed;
  EgoInput ego;
  ego.shape = simulation.trueRig().vehicle;
  ego.pose = [&simulation](double t) {
    const SE3 pose = simulation.T_world_vehicle(t);
    return Eigen::Vector3d(pose.translation().x(), pose.translation().y(), pose.rotation().yaw());
  };
  // What moves is planned for the whole drive: who meets the car does not depend on where the
  // recording ends.
  ego.duration = simulation.wholeDuration();
  return std::make_shared<const Scene>(buildScene(simulation.garage(), options, ego));
}

Result<std::unique_ptr<FrameRenderer>> FrameRenderer::make(
    std::shared_ptr<const Simulation> simulation) {
  std::shared_ptr<const Scene> scene = makeScene(*simulation);
  const SimSpec& spec = simulation->spec();
  RenderOptions options;
  options.fast = spec.fast;
  options.threads = spec.threads;
  options.sensor.noise = spec.noise;
  options.sensor.motion_blur = spec.motion_blur;
  std::unique_ptr<FrameRenderer> result(new FrameRenderer());
  result->simulation_ = std::move(simulation);
  result->scene_ = scene;
  result->renderer_ = std::make_unique<Renderer>(std::move(scene), options);
  for (const RigCamera& camera : result->simulation_->trueRig().cameras) {
    result->renderer_->addCamera(camera.camera);
  }
  return result;
}

double FrameRenderer::secondsOf(int index) const {
  const std::vector<TimeNs>& times = simulation_->frameTimes();
  PARKADE_CHECK(index >= 0 && index < static_cast<int>(times.size()), "frame set {} of {}", index,
                times.size());
  return toSeconds(times[static_cast<std::size_t>(index)] - kSimStartNs);
}

FrameSet FrameRenderer::draw(int index, const Wanted& wanted) const {
  const double t = secondsOf(index);
  const std::vector<RigCamera>& cameras = simulation_->trueRig().cameras;
  FrameSet set;
  set.index = index;
  set.t_ns = simulation_->frameTimes()[static_cast<std::size_t>(index)];
  set.images.resize(cameras.size());
  set.image_t_ns.assign(cameras.size(), 0);
  const std::uint64_t key = hash64(static_cast<std::uint64_t>(simulation_->spec().seed),
                                   static_cast<std::uint64_t>(index));
  const bool blurred = simulation_->spec().motion_blur > 1;
  const auto moment = renderer_->moment(t, simulation_->T_world_vehicle(t));
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (!wanted.empty() && !wanted[i]) continue;
    const int camera = static_cast<int>(i);
    set.image_t_ns[i] = set.t_ns;
    const CameraMotion motion = motionOf(camera);
    set.images[i] =
        blurred ? renderer_->render(camera, motion, t, key)
                : renderer_->render(camera, renderer_->placesOf(camera, motion, t), *moment, key);
  }
  return set;
}

CameraMotion FrameRenderer::motionOf(int camera) const {
  const RigCamera& told = simulation_->trueRig().cameras.at(static_cast<std::size_t>(camera));
  return {[this](double at) { return simulation_->T_world_vehicle(at); }, told.T_vehicle_cam,
          told.readout_time};
}

cv::Mat FrameRenderer::labels(int index, int camera) const {
  const double t = secondsOf(index);
  return renderer_
      ->renderTruth(camera, renderer_->placesOf(camera, motionOf(camera), t),
                    *renderer_->moment(t, simulation_->T_world_vehicle(t)))
      .labels;
}

OrthoImages FrameRenderer::groundView(int index, int size_px, double metres_per_px) const {
  const double t = secondsOf(index);
  return renderer_->renderOrtho(simulation_->T_world_vehicle(t), size_px, metres_per_px, t);
}

cv::Mat FrameRenderer::bodyMask(int camera) const {
  const SE3 T_world_vehicle = simulation_->T_world_vehicle(0.0);
  const SE3& T_vehicle_cam = simulation_->trueRig().cameras.at(camera).T_vehicle_cam;
  const TruthImages truth = renderer_->renderTruth(camera, T_world_vehicle * T_vehicle_cam,
                                                   *renderer_->moment(0.0, T_world_vehicle));
  constexpr int kOwnCar = -1;
  cv::Mat own;
  cv::compare(truth.instances, kOwnCar, own, cv::CMP_NE);
  return own;
}

cv::Mat FrameRenderer::overview(int width_px) const {
  const Garage& garage = simulation_->garage();
  const Eigen::Vector2d size = garage.max - garage.min;
  const Eigen::Vector2d middle = 0.5 * (garage.min + garage.max);
  const int height_px =
      static_cast<int>(std::lround(width_px * (size.y() + 8.0) / (size.x() + 8.0)));
  // High enough that walls hardly lean.
  constexpr double kHeight = 140.0;  // m
  const double focal = width_px * kHeight / (size.x() + 8.0);
  PinholeRadtan::Parameters pinhole;
  pinhole.fx = pinhole.fy = focal;
  pinhole.cx = 0.5 * (width_px - 1);
  pinhole.cy = 0.5 * (height_px - 1);
  const Camera camera(PinholeRadtan(pinhole), width_px, height_px);
  // Looks straight down; the picture's right is +x, its top +y.
  Eigen::Matrix3d R_world_cam;
  R_world_cam << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return renderer_->renderOverview(camera, SE3(SO3(R_world_cam), {middle.x(), middle.y(), kHeight}),
                                   0.0);
}

cv::Mat grayOf(const cv::Mat& bgr) {
  cv::Mat gray;
  cv::cvtColor(bgr, gray, cv::COLOR_BGR2GRAY);
  return gray;
}

namespace {

// Draws the chosen cameras.
class ChosenFrames {
 public:
  ChosenFrames(std::shared_ptr<const Simulation> simulation,
               std::unique_ptr<FrameRenderer> renderer, std::vector<std::size_t> chosen, bool gray)
      : simulation_(std::move(simulation)),
        renderer_(std::move(renderer)),
        chosen_(std::move(chosen)),
        gray_(gray) {}

  Result<FrameSet> draw(int index) {
    FrameRenderer::Wanted wanted(simulation_->trueRig().cameras.size(), false);
    for (const std::size_t camera : chosen_) wanted[camera] = true;
    FrameSet all = renderer_->draw(index, wanted);
    FrameSet set;
    set.index = all.index;
    set.t_ns = all.t_ns;
    for (const std::size_t camera : chosen_) {
      set.images.push_back(gray_ ? grayOf(all.images[camera]) : all.images[camera]);
      set.image_t_ns.push_back(all.image_t_ns[camera]);
    }
    return set;
  }

 private:
  std::shared_ptr<const Simulation> simulation_;
  std::unique_ptr<FrameRenderer> renderer_;
  std::vector<std::size_t> chosen_;
  bool gray_;
};

}  // namespace

Result<std::unique_ptr<SimSource>> openSimSource(const std::string& address,
                                                 const SimSourceOptions& options) {
  Result<SimSpec> spec = parseSimAddress(address);
  if (!spec) return spec.error();
  if (options.duration > 0.0) spec->duration = options.duration;
  const Result<std::shared_ptr<const Simulation>> simulation = Simulation::make(*spec);
  if (!simulation) return simulation.error();
  Rig rig = (*simulation)->toldRig();
  // Stamps leave the simulator on the inertial unit's clock.
  for (RigCamera& camera : rig.cameras) camera.time_offset_ns = 0;
  if (!options.cameras.empty()) {
    Result<Rig> subset = rig.subset(split(options.cameras, ','));
    if (!subset) return subset.error();
    rig = std::move(subset).value();
  }
  FrameFunction draw;
  if (spec->images) {
    Result<std::unique_ptr<FrameRenderer>> renderer = FrameRenderer::make(*simulation);
    if (!renderer) return renderer.error();
    std::vector<std::size_t> chosen;
    for (RigCamera& camera : rig.cameras) {
      const int index = (*simulation)->trueRig().find(camera.name);
      chosen.push_back(static_cast<std::size_t>(index));
      const cv::Mat mask = (*renderer)->bodyMask(index);
      if (cv::countNonZero(mask) == static_cast<int>(mask.total())) continue;
      camera.mask_pixels.assign(mask.datastart, mask.dataend);
    }
    const auto frames = std::make_shared<ChosenFrames>(*simulation, std::move(renderer).value(),
                                                       std::move(chosen), options.gray);
    draw = [frames](int index) { return frames->draw(index); };
  }
  return std::make_unique<SimSource>(*simulation, std::move(rig), std::move(draw), kFrameSetsAhead,
                                     spec->threads);
}

}  // namespace parkade::sim
