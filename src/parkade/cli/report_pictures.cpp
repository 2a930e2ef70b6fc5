// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/report_pictures.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "parkade/bev/stitcher.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/mapping/storage/map_drawing.hpp"
#include "parkade/semantics/drawing/draw_labels.hpp"
#include "parkade/semantics/drawing/draw_objects.hpp"
#include "parkade/semantics/drawing/draw_slots.hpp"
#include "parkade/tracking/draw_tracks.hpp"
#include "parkade/tracking/overlap.hpp"

namespace parkade::cli {
namespace {

using Json = nlohmann::ordered_json;

cv::Mat drawFeatures(const FeaturesEvent& event) {
  constexpr double kShare = 0.4;  // of the classes' colours
  constexpr double kEnlarged = 2.0;
  const SemanticFrame& f = event.features;
  const BevGeometry& geometry = event.picture.geometry;
  cv::Mat picture = drawLabels(event.picture.image, f.labels.labels, kShare);
  picture = drawObjects(picture, geometry, f.objects, f.moving, kEnlarged);
  return drawSlots(picture, geometry, f.slots, f.line_segments);
}

// The classes that a legend of drawFeatures() must name.
Json classesOf(const cv::Mat& labels) {
  std::array<int, kNumSemanticClasses> counts{};
  for (int v = 0; v < labels.rows; ++v) {
    for (int u = 0; u < labels.cols; ++u) {
      const std::uint8_t label = labels.at<std::uint8_t>(v, u);
      if (label < counts.size()) ++counts[label];
    }
  }
  constexpr int kFew = 20;  // px: nobody sees fewer
  Json names = Json::array();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const bool drawn = static_cast<SemanticClass>(i) != SemanticClass::kUnknown &&
                       static_cast<SemanticClass>(i) != SemanticClass::kFloor;
    if (drawn && counts[i] >= kFew) names.push_back(kSemanticClassNames[i]);
  }
  return names;
}

// Where a picture of the local map lies, and the car on it.
Json placeOf(const MapEvent& event, const std::optional<VehicleShape>& vehicle) {
  const LocalMap& map = *event.local_map;
  const SE2 pose = SE2::fromSE3(event.T_odom_vehicle);
  const double top = (map.lowest().y() + map.cells()) * map.resolution();
  Json json{{"t_ns", map.time()},
            {"top_left", {map.lowest().x() * map.resolution(), top}},
            {"size_m", map.cells() * map.resolution()},
            {"car", {pose.translation().x(), pose.translation().y(), pose.angle()}}};
  if (vehicle) {
    json["car_shape"] = {-vehicle->rear_overhang, vehicle->wheelbase + vehicle->front_overhang,
                         vehicle->width};
  }
  return json;
}

int movingOf(const SemanticFrame& features) {
  return static_cast<int>(std::count_if(
      features.moving.begin(), features.moving.end(), [](const MovingObservation& object) {
        return object.moving || object.semantic_class == SemanticClass::kPedestrian;
      }));
}

}  // namespace

ReportPictures::ReportPictures(Rig rig, TimeNs begin_ns, TimeNs end_ns, bool semantics)
    : rig_(std::move(rig)), middle_ns_(begin_ns + (end_ns - begin_ns) / 2), semantics_(semantics) {}

void ReportPictures::onTracks(const TracksEvent& event) {
  if (!tracks_.empty()) return;
  if (event.frames.t_ns >= middle_ns_) {
    tracks_ =
        drawTracks(event.frames, event.tracks, previous_, event.report, event.prior, rig_, "");
    if (!semantics_) stitch(event.frames);
  }
  previous_ = event.tracks;
}

void ReportPictures::onFeatures(const FeaturesEvent& event) {
  if (!features_.empty() || event.features.labels.t_ns < middle_ns_) return;
  stitched_ = event.picture.image.clone();
  features_ = drawFeatures(event);
  features_json_ = {{"t_ns", event.features.labels.t_ns},
                    {"classes", classesOf(event.features.labels.labels)},
                    {"slots", event.features.slots.size()},
                    {"objects", event.features.objects.size()},
                    {"vehicles_and_people", event.features.moving.size()}};
}

void ReportPictures::onMap(const MapEvent& event) {
  if (event.local_map == nullptr) return;
  if (local_map_.empty() && event.features.labels.t_ns >= middle_ns_) {
    local_map_ = drawLocalMap(*event.local_map);
    local_json_ = placeOf(event, rig_.vehicle);
  }
  const int moving = movingOf(event.features);
  if (moving <= most_moving_) return;  // a handful of times in a run
  most_moving_ = moving;
  moving_ = drawLocalMap(*event.local_map, GridLayer::kDynamic);
  moving_json_ = placeOf(event, rig_.vehicle);
  moving_json_["moving"] = moving;
}

void ReportPictures::stitch(const FrameSet& frames) {
  BevStitcher stitcher(rig_, BevOptions{});
  const Result<std::vector<cv::Mat>> masks = readBodyMasks(rig_);
  for (std::size_t i = 0; masks && i < masks->size(); ++i) {
    if (!(*masks)[i].empty()) stitcher.setMask(static_cast<int>(i), (*masks)[i]);
  }
  stitched_ = stitcher.stitch(frames).image;
}

Status ReportPictures::write(const std::string& folder) const {
  Status status = makeFolders(joinPath(folder, "pictures"));
  ImageEncoding jpeg;
  jpeg.jpeg_quality = 80;
  ImageEncoding png;
  png.png = true;
  png.png_level = 9;
  const std::pair<const char*, const cv::Mat*> pictures[] = {{"tracks.jpg", &tracks_},
                                                             {"stitched.jpg", &stitched_},
                                                             {"features.jpg", &features_},
                                                             {"local_map.png", &local_map_},
                                                             {"local_moving.png", &moving_}};
  for (const auto& [name, picture] : pictures) {
    if (!status || picture->empty()) continue;
    const bool lossless = std::string_view(name).ends_with(".png");
    status =
        writeImage(joinPath(joinPath(folder, "pictures"), name), *picture, lossless ? png : jpeg);
  }
  if (!status) return status;
  const Json json{
      {"features", features_json_}, {"local_map", local_json_}, {"local_moving", moving_json_}};
  return writeFileAtomic(joinPath(folder, "pictures/pictures.json"), json.dump(2) + "\n");
}

}  // namespace parkade::cli
