// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/zone_marker_front_end.hpp"

#include <opencv2/core.hpp>
#include <utility>

#include "parkade/core/log.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/semantics/texts/level_views.hpp"
#include "parkade/semantics/texts/zone_marker_views.hpp"
#include "parkade/semantics/texts/zone_text_reader.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade {

struct ZoneMarkerFrontEnd::Impl {
  ZoneMarkerFrontEndOptions options;
  Rig rig;
  std::vector<cv::Mat> masks;
  SegmentationNetwork network;
  ZoneTextReader reader;
  ZoneMarkerTracker tracker;
  SignFollower signs;
  std::size_t next_camera = 0;
  std::vector<LevelView> views = {};  // of the last look

  // What one camera sees, in the odometry's frame turned so that z points up.
  Result<std::vector<ZoneMarkerView>> viewsFrom(std::size_t camera, const cv::Mat& image,
                                                const SE3& T_up_vehicle, const SE3& T_level_vehicle,
                                                TimeNs t_ns) {
    const RigCamera& eye = rig.cameras[camera];
    Result<ViewLabels> labels = network.segmentView(image);
    if (!labels) return labels.error();
    views.push_back(
        levelView(labels->labels, masks[camera], eye.camera, T_level_vehicle * eye.T_vehicle_cam));
    const SE3 T_up_cam = T_up_vehicle * eye.T_vehicle_cam;
    const Status signs_seen =
        signs.add(labels->labels, image, masks[camera], eye.camera, T_up_cam, t_ns, reader);
    if (!signs_seen) return signs_seen.error();
    const auto to_read = [&](const ZoneMarkerSight& sight) {
      return !tracker.needsNoReading(viewOf(sight, T_up_cam.translation()));
    };
    return viewsOf(findZoneMarkers(labels->labels, image, masks[camera], eye.camera,
                                   T_up_cam.rotation(), options.faces, to_read),
                   T_up_cam.translation(), &reader, options.letters);
  }
};

ZoneMarkerFrontEnd::ZoneMarkerFrontEnd(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ZoneMarkerFrontEnd::~ZoneMarkerFrontEnd() = default;

void ZoneMarkerFrontEnd::moveCamera(int camera, const SE3& T_vehicle_cam) {
  impl_->rig.cameras[static_cast<std::size_t>(camera)].T_vehicle_cam = T_vehicle_cam;
}

Result<std::unique_ptr<ZoneMarkerFrontEnd>> ZoneMarkerFrontEnd::create(
    const Rig& rig, std::vector<cv::Mat> masks, const ZoneMarkerFrontEndOptions& options) {
  std::unique_ptr<ZoneMarkerFrontEnd> none;
  if (!options.enabled) return none;
  for (const auto& [named, own] :
       {std::pair(&options.network, kViewNetwork), std::pair(&options.reader, "zone_text")}) {
    if (namedOrOwnModel(*named, own)) continue;
    logInfo("no zone markers: the network {} is not installed", own);
    return none;
  }
  Result<SegmentationNetwork> network =
      SegmentationNetwork::loadOrOwn(options.network, kViewNetwork);
  if (!network) return network.error();
  const Result<std::string> reader_path = namedOrOwnModel(options.reader, "zone_text");
  if (!reader_path) return reader_path.error();
  Result<ZoneTextReader> reader = ZoneTextReader::load(*reader_path);
  if (!reader) return reader.error();
  const Status known = reader->knows(options.letters, "semantics.zone_markers.letters");
  if (!known) return known.error();
  return std::unique_ptr<ZoneMarkerFrontEnd>(new ZoneMarkerFrontEnd(std::make_unique<Impl>(
      Impl{options, rig, std::move(masks), std::move(network).value(), std::move(reader).value(),
           ZoneMarkerTracker(options.tracker), SignFollower(options.signs)})));
}

Result<std::vector<ObjectObservation>> ZoneMarkerFrontEnd::look(const FrameSet& frames,
                                                                const PoseEstimate& odometry,
                                                                const GroundAttitude& attitude) {
  Impl& m = *impl_;
  const SE3 T_up_odom(SO3::fromTwoVectors(odometry.up_odom, Eigen::Vector3d::UnitZ()),
                      Eigen::Vector3d::Zero());
  const SE3 T_up_vehicle = T_up_odom * odometry.T_odom_vehicle;
  const SE3 T_level_vehicle = levelFrom(attitude);
  m.views.clear();
  const std::size_t cameras = m.rig.cameras.size();
  int looked = 0;
  for (std::size_t k = 0; k < cameras && looked < m.options.views; ++k) {
    const std::size_t camera = m.next_camera;
    m.next_camera = (m.next_camera + 1) % cameras;
    if (camera >= frames.images.size() || frames.images[camera].empty()) continue;
    ++looked;
    Result<std::vector<ZoneMarkerView>> views =
        m.viewsFrom(camera, frames.images[camera], T_up_vehicle, T_level_vehicle, frames.t_ns);
    if (!views) return views.error();
    m.tracker.add(*views, frames.t_ns);
  }
  // The map takes places in the plane of the levelled vehicle: heading and place of the odometry.
  const SE2 T_vehicle_odom = SE2::fromSE3(odometry.T_odom_vehicle).inverse();
  Eigen::Matrix3d R_vehicle_up = Eigen::Matrix3d::Identity();
  R_vehicle_up.topLeftCorner<2, 2>() = T_vehicle_odom.rotationMatrix();
  std::vector<ObjectObservation> observations;
  const auto observe = [&](SemanticClass semantic_class, const ZoneMarker& marker) {
    const Eigen::Vector3d p_odom = T_up_odom.inverse() * marker.position;
    ObjectObservation o;
    o.semantic_class = semantic_class;
    o.position << T_vehicle_odom * p_odom.head<2>(),
        (marker.position - T_up_vehicle.translation()).z() + attitude.height;
    o.covariance = R_vehicle_up * marker.covariance * R_vehicle_up.transpose();
    o.text = marker.text;
    o.confidence = marker.confidence;
    observations.push_back(std::move(o));
  };
  for (const ZoneMarker& marker : m.tracker.takeTold()) {
    observe(SemanticClass::kZoneMarker, marker);
  }
  for (const FollowedSign& told : m.signs.takeTold()) observe(told.semantic_class, told.sign);
  return observations;
}

const std::vector<LevelView>& ZoneMarkerFrontEnd::views() const {
  return impl_->views;
}

}  // namespace parkade
