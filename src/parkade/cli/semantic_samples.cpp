// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/semantic_samples.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "parkade/core/units.hpp"
#include "parkade/sim/drive/frame_renderer.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade::cli {
namespace {

constexpr int kOwnCar = -1;

/// The plane that fits the floor around the car best, in the vehicle frame: z = c0 + c1 x + c2 y.
Eigen::Vector3d floorPlane(const sim::Garage& garage, const SE3& T_world_vehicle) {
  constexpr double kReach = 6.0;  // m
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (double x = -kReach; x <= kReach; x += 2.0) {
    for (double y = -kReach; y <= kReach; y += 2.0) {
      Eigen::Vector3d p_world = T_world_vehicle * Eigen::Vector3d(x + 1.4, y, 0.0);
      p_world.z() = garage.floorHeight(p_world.head<2>());
      const Eigen::Vector3d p = T_world_vehicle.inverse() * p_world;
      const Eigen::Vector3d row(1.0, p.x(), p.y());
      normal += row * row.transpose();
      right += row * p.z();
    }
  }
  return normal.ldlt().solve(right);
}

/// Worn paint breaks into specks that no label image can follow: a pixel that shares its class with
/// fewer than two of its eight neighbours takes the class of most of them.
cv::Mat withoutSpecks(const cv::Mat& labels, const cv::Mat& valid) {
  cv::Mat out = labels.clone();
  for (int v = 1; v + 1 < labels.rows; ++v) {
    for (int u = 1; u + 1 < labels.cols; ++u) {
      if (valid.at<std::uint8_t>(v, u) == 0) continue;
      std::array<int, kNumSemanticClasses> votes{};
      for (int y = v - 1; y <= v + 1; ++y) {
        for (int x = u - 1; x <= u + 1; ++x) {
          if (valid.at<std::uint8_t>(y, x) != 0) ++votes[labels.at<std::uint8_t>(y, x)];
        }
      }
      if (votes[labels.at<std::uint8_t>(v, u)] < 3) {
        out.at<std::uint8_t>(v, u) =
            static_cast<std::uint8_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
      }
    }
  }
  return out;
}

}  // namespace

Result<std::unique_ptr<SemanticSampler>> SemanticSampler::make(const sim::SimSpec& spec,
                                                               const SampleOptions& options,
                                                               const BevOptions& bev) {
  const Result<std::shared_ptr<const sim::Simulation>> simulation = sim::Simulation::make(spec);
  if (!simulation) return simulation.error();
  std::unique_ptr<SemanticSampler> result(new SemanticSampler());
  result->options_ = options;
  result->simulation_ = *simulation;
  result->scene_ = sim::makeScene(**simulation);
  sim::RenderOptions render;
  render.fast = spec.fast;
  render.threads = spec.threads;
  render.sensor.noise = spec.noise;
  if (options.coarse_light) {
    render.bake.floor_cell = 0.2;
    render.bake.indirect_cell = 0.75;
    render.bake.gather_rays = 24;
    render.bake.bounces = 2;
  }
  result->renderer_ = std::make_unique<sim::Renderer>(result->scene_, render);
  for (const RigCamera& camera : result->simulation_->trueRig().cameras) {
    result->renderer_->addCamera(camera.camera);
  }
  result->stitcher_ = std::make_unique<BevStitcher>(result->simulation_->toldRig(), bev);
  for (std::size_t i = 0; i < result->simulation_->trueRig().cameras.size(); ++i) {
    const int camera = static_cast<int>(i);
    result->body_masks_.push_back(result->drawBodyMask(camera));
    if (options.masks) result->stitcher_->setMask(camera, result->body_masks_.back());
  }
  double way = 0.0;
  Eigen::Vector3d last = result->simulation_->T_world_vehicle(0.0).translation();
  for (const TimeNs t_ns : result->simulation_->frameTimes()) {
    const Eigen::Vector3d now =
        result->simulation_->T_world_vehicle(toSeconds(t_ns - sim::kSimStartNs)).translation();
    way += (now - last).norm();
    last = now;
    result->way_.push_back(way);
  }
  if (result->way_.empty()) return Error{spec.name() + ": the drive has no frame sets"};
  return result;
}

cv::Mat SemanticSampler::drawBodyMask(int camera) const {
  const SE3 T_world_vehicle = simulation_->T_world_vehicle(0.0);
  const SE3& T_vehicle_cam =
      simulation_->trueRig().cameras[static_cast<std::size_t>(camera)].T_vehicle_cam;
  return renderer_
             ->renderTruth(camera, T_world_vehicle * T_vehicle_cam,
                           *renderer_->moment(0.0, T_world_vehicle))
             .instances != kOwnCar;
}

double SemanticSampler::timeOf(int index, Random& random) const {
  const double wanted = (index + random.uniform(0.1, 0.9)) / options_.frames * way_.back();
  const auto it = std::lower_bound(way_.begin(), way_.end(), wanted);
  const std::size_t frame = std::min(static_cast<std::size_t>(it - way_.begin()), way_.size() - 1);
  return toSeconds(simulation_->frameTimes()[frame] - sim::kSimStartNs);
}

GroundAttitude SemanticSampler::trueAttitude(const SE3& T_world_vehicle) const {
  const Eigen::Vector3d plane = floorPlane(simulation_->garage(), T_world_vehicle);
  const Eigen::Vector3d up = Eigen::Vector3d(-plane[1], -plane[2], 1.0).normalized();
  // Equation (3) of docs/math/ipm.md: the ground's normal in the vehicle frame is
  // (-sin pitch, cos pitch sin roll, cos pitch cos roll).
  return {-std::asin(up.x()), std::atan2(up.y(), up.z()), -plane[0] * up.z()};
}

GroundRelief SemanticSampler::trueRelief(const SE3& T_world_vehicle,
                                         const GroundAttitude& attitude) const {
  constexpr int kHalf = 5;
  constexpr double kStep = 2.0;  // m
  const sim::Garage& garage = simulation_->garage();
  const SE3 T_world_level = T_world_vehicle * levelFrom(attitude).inverse();
  return GroundRelief::around(kHalf, kStep, [&](const Eigen::Vector2d& at) {
    const Eigen::Vector3d p = T_world_level * Eigen::Vector3d(at.x(), at.y(), 0.0);
    return garage.floorHeight(p.head<2>()) - p.z();
  });
}

cv::Mat SemanticSampler::labelPicture(const SemanticSample& sample,
                                      const sim::Moment& moment) const {
  const std::size_t cameras = simulation_->trueRig().cameras.size();
  const cv::Size size = sample.bev.valid.size();
  const cv::Mat relief = reliefPicture(sample.relief, sample.bev.geometry);
  cv::Mat best(size, CV_32FC1, cv::Scalar(0.0F));
  cv::Mat labels(size, CV_8UC1, cv::Scalar(0));
  cv::Mat map_x;
  cv::Mat map_y;
  for (std::size_t i = 0; i < cameras; ++i) {
    const GroundTable& table = stitcher_->table(static_cast<int>(i));
    const cv::Rect roi = table.roi();
    if (roi.empty()) continue;
    table.mapFor(sample.attitude, relief, {}, map_x, map_y);
    const RigCamera& camera = simulation_->trueRig().cameras[i];
    cv::Mat directions(roi.size(), CV_32FC3, cv::Scalar::all(0.0));
    cv::Mat mine(roi.size(), CV_8UC1, cv::Scalar(0));
    for (int v = 0; v < roi.height; ++v) {
      for (int u = 0; u < roi.width; ++u) {
        const float weight = table.weight().at<float>(v, u);
        float& so_far = best.at<float>(v + roi.y, u + roi.x);
        if (weight <= so_far || sample.bev.valid.at<std::uint8_t>(v + roi.y, u + roi.x) == 0)
          continue;
        Eigen::Vector3d ray;
        if (!camera.camera.unproject({map_x.at<float>(v, u), map_y.at<float>(v, u)}, ray)) continue;
        so_far = weight;
        mine.at<std::uint8_t>(v, u) = 255;
        const Eigen::Vector3f direction = ray.cast<float>();
        directions.at<cv::Vec3f>(v, u) = {direction.x(), direction.y(), direction.z()};
      }
    }
    renderer_->renderSights(directions, sample.T_world_vehicle * camera.T_vehicle_cam, moment)
        .copyTo(labels(roi), mine);
  }
  return labels;
}

cv::Mat SemanticSampler::cameraLabels(const SemanticSample& sample, int camera) const {
  const SE3& T_vehicle_cam =
      simulation_->trueRig().cameras[static_cast<std::size_t>(camera)].T_vehicle_cam;
  sim::TruthImages truth =
      renderer_->renderTruth(camera, sample.T_world_vehicle * T_vehicle_cam,
                             *renderer_->moment(sample.t, sample.T_world_vehicle));
  truth.labels.setTo(0, truth.instances == kOwnCar);
  return truth.labels;
}

SemanticSample SemanticSampler::draw(int index) {
  Random random = Random(static_cast<std::uint64_t>(simulation_->spec().seed))
                      .fork("semantic sample", static_cast<std::uint64_t>(index));
  SemanticSample sample;
  sample.t = timeOf(index, random);
  const double turn = random.normal(0.0, options_.turn_deg * kDegree);
  const double step_x = random.normal(0.0, options_.shift_m);
  const double step_y = random.normal(0.0, options_.shift_m);
  const SE3 on_drive = simulation_->T_world_vehicle(sample.t);
  // Turned and moved in the plane of the car, raised by what the floor rises.
  SE3 moved = on_drive * SE3(SO3::exp({0.0, 0.0, turn}), {step_x, step_y, 0.0});
  const sim::Garage& garage = simulation_->garage();
  Eigen::Vector3d place = moved.translation();
  place.z() = on_drive.translation().z() + garage.floorHeight(place.head<2>()) -
              garage.floorHeight(on_drive.translation().head<2>());
  sample.T_world_vehicle = SE3(moved.rotation(), place);

  const auto moment = renderer_->moment(sample.t, sample.T_world_vehicle);
  const std::vector<RigCamera>& cameras = simulation_->trueRig().cameras;
  sample.frames.index = index;
  sample.frames.t_ns = sim::kSimStartNs + fromSeconds(sample.t);
  sample.frames.image_t_ns.assign(cameras.size(), sample.frames.t_ns);
  const std::uint64_t key = random.bits();
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const SE3 T_world_cam = sample.T_world_vehicle * cameras[i].T_vehicle_cam;
    sample.frames.images.push_back(
        renderer_->render(static_cast<int>(i), T_world_cam, *moment, key));
  }
  sample.true_attitude = trueAttitude(sample.T_world_vehicle);
  const double sigma = options_.attitude_error_deg * kDegree;
  sample.attitude.pitch = sample.true_attitude.pitch + random.normal(0.0, sigma);
  sample.attitude.roll = sample.true_attitude.roll + random.normal(0.0, sigma);
  sample.attitude.height =
      sample.true_attitude.height + random.normal(0.0, 0.01 * options_.height_error_cm);
  if (!options_.stitched) return sample;
  sample.relief = trueRelief(sample.T_world_vehicle, sample.true_attitude);
  for (double& height : sample.relief.heights.reshaped()) {
    height += random.normal(0.0, 0.01 * options_.relief_error_cm);
  }
  sample.bev = stitcher_->stitch(sample.frames, sample.attitude, sample.relief);
  sample.bev_labels = withoutSpecks(labelPicture(sample, *moment), sample.bev.valid);
  return sample;
}

}  // namespace parkade::cli
