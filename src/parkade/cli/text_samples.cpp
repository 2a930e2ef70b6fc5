// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/text_samples.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>

#include "parkade/cli/zone_text_truth.hpp"
#include "parkade/core/units.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/semantics/markings/painted_numbers.hpp"
#include "parkade/semantics/networks/class_map.hpp"
#include "parkade/semantics/texts/guide_text.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade::cli {
namespace {

constexpr auto kMarker = static_cast<std::uint8_t>(SemanticClass::kZoneMarker);
constexpr double kFaceReach = 40.0;   // m
constexpr double kNumberReach = 9.0;  // m
constexpr double kReadable = 0.85;    // of a text's area, in sight and in the patch
constexpr double kNone = 0.1;         // less than this of a text is none

/// Patches one below the other, and a line about each.
struct Strip {
  cv::Mat patches = cv::Mat(0, kZonePatchWidth, CV_8UC3);
  std::string lines = "text,height_px,slant_deg,distance_m,kind\n";

  void add(const cv::Mat& patch, const std::string& text, double height_px, double slant,
           double distance, const char* kind) {
    patches.push_back(patch);
    lines += fmt::format("{},{:.1f},{:.1f},{:.2f},{}\n", text, height_px, slant / kDegree, distance,
                         kind);
  }
};

/// A picture of numbers, averaged with its neighbours (1 2 1) along both axes, `times` times.
cv::Mat smoothed(const cv::Mat& picture, int times) {
  cv::Mat out = picture.clone();
  for (int k = 0; k < 2 * times; ++k) {
    const int du = k % 2;
    const int dv = 1 - du;
    const cv::Mat in = out.clone();
    for (int v = dv; v + dv < out.rows; ++v) {
      for (int u = du; u + du < out.cols; ++u) {
        out.at<float>(v, u) = 0.5F * in.at<float>(v, u) +
                              0.25F * (in.at<float>(v - dv, u - du) + in.at<float>(v + dv, u + du));
      }
    }
  }
  return out;
}

/// The labels with the edges of markers moved at random by up to about a pixel, as a network's are.
cv::Mat shakenLabels(const cv::Mat& labels, Random& random) {
  cv::Mat markers;
  cv::Mat(labels == kMarker).convertTo(markers, CV_32F, 1.0 / 255.0);
  markers = smoothed(markers, 1);
  cv::Mat waves(labels.size(), CV_32F);
  for (int v = 0; v < waves.rows; ++v) {
    for (int u = 0; u < waves.cols; ++u)
      waves.at<float>(v, u) = static_cast<float>(random.normal());
  }
  waves = smoothed(waves, 3);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(waves, mean, deviation);
  const double strength = random.uniform(0.03, 0.3) / deviation[0];
  const double threshold = 0.5 + random.normal(0.0, 0.08);
  cv::Mat out = labels.clone();
  for (int v = 0; v < out.rows; ++v) {
    for (int u = 0; u < out.cols; ++u) {
      auto& label = out.at<std::uint8_t>(v, u);
      const bool marker = markers.at<float>(v, u) + strength * waves.at<float>(v, u) > threshold;
      if (marker && label != static_cast<std::uint8_t>(SemanticClass::kVehicle)) label = kMarker;
      if (!marker && label == kMarker) label = static_cast<std::uint8_t>(SemanticClass::kPillar);
    }
  }
  return out;
}

/// Letters of a text that a quadrilateral shows; nothing where a letter is cut, or hidden.
std::optional<std::string> lettersWithin(const TrueZoneText& text,
                                         const std::array<Eigen::Vector2d, 4>& corners) {
  constexpr double kWhole = 0.75;
  constexpr double kGone = 0.2;
  const auto count = static_cast<double>(text.text.size());
  std::string shown;
  for (std::size_t i = 0; i < text.text.size(); ++i) {
    const double share = shareWithin(text, corners, static_cast<double>(i) / count,
                                     (static_cast<double>(i) + 1.0) / count);
    if (share > kGone && share < kWhole) return std::nullopt;
    if (share >= kWhole) shown += text.text[i];
  }
  if (!shown.empty() && text.in_sight < kReadable) return std::nullopt;
  return shown;
}

/// What a face shows: where the edge between two of a pillar was missed, both texts, or one and an
/// end of the other. Nothing where it cannot be told.
struct ShownText {
  std::string text;
  double distance = 0.0;  ///< m, of the nearest; 0: no text
};

std::optional<ShownText> shownBy(const ZoneMarkerFace& face,
                                 const std::vector<TrueZoneText>& texts) {
  std::vector<const TrueZoneText*> inside;
  for (const TrueZoneText& text : texts) {
    if (text.in_sight * shareWithin(text, face.corners) > kNone) inside.push_back(&text);
  }
  std::sort(inside.begin(), inside.end(),
            [](const auto* a, const auto* b) { return a->middle.x() < b->middle.x(); });
  ShownText shown;
  bool whole = inside.empty();
  for (const TrueZoneText* text : inside) {
    const std::optional<std::string> letters = lettersWithin(*text, face.corners);
    if (!letters) return std::nullopt;
    shown.text += *letters;
    whole = whole || *letters == text->text;
    if (shown.distance == 0.0 || text->distance < shown.distance) shown.distance = text->distance;
  }
  // A part alone is neither the text nor none.
  if (!whole) return std::nullopt;
  return shown;
}

// elsewhere_none: where no text of these is, there is none at all.
void addFaces(const std::vector<ZoneMarkerSight>& sights, const std::vector<TrueZoneText>& texts,
              const char* kind, Strip& strip, bool elsewhere_none) {
  for (const ZoneMarkerSight& sight : sights) {
    for (const ZoneMarkerFace& face : sight.faces) {
      const std::optional<ShownText> shown = shownBy(face, texts);
      if (!shown || (textWithin(texts, face.corners) == nullptr && !elsewhere_none)) continue;
      strip.add(face.patch, shown->text, face.height_px, face.slant, shown->distance, kind);
    }
  }
}

/// A slot's number as it lies around the car, in the levelled frame; without object and slot.
PaintedNumber numberAround(const sim::Marking& marking, const sim::Garage& garage,
                           const SE3& T_level_world) {
  const Eigen::Vector2d up(std::cos(marking.heading), std::sin(marking.heading));
  const Eigen::Vector2d right(up.y(), -up.x());
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector2d most = -least;
  for (const auto& polygon : marking.polygons) {
    for (const Eigen::Vector2d& p : polygon) {
      least = least.cwiseMin(Eigen::Vector2d(right.dot(p), up.dot(p)));
      most = most.cwiseMax(Eigen::Vector2d(right.dot(p), up.dot(p)));
    }
  }
  const Eigen::Vector2d middle = 0.5 * (least + most);
  const Eigen::Vector2d center = middle.x() * right + middle.y() * up;
  const Eigen::Vector3d p_world(center.x(), center.y(), garage.floorHeight(center));
  PaintedNumber number;
  number.center = (T_level_world * p_world).head<2>();
  number.right = (T_level_world.rotation() * Eigen::Vector3d(right.x(), right.y(), 0.0))
                     .head<2>()
                     .normalized();
  number.width = most.x() - least.x();
  number.height = most.y() - least.y();
  return number;
}

/// Whether nothing that stands hides a part of it.
bool isOpen(const PaintedNumber& number, const Camera& camera, const SE3& T_level_cam,
            const cv::Mat& labels) {
  constexpr int kSteps = 4;
  const SE3 T_cam_level = T_level_cam.inverse();
  for (int i = 0; i <= kSteps; ++i) {
    for (int j = 0; j <= kSteps; ++j) {
      const Eigen::Vector2d p =
          number.center + (static_cast<double>(i) / kSteps - 0.5) * number.width * number.right +
          (static_cast<double>(j) / kSteps - 0.5) * number.height * number.up();
      Eigen::Vector2d pixel;
      if (!camera.project(T_cam_level * Eigen::Vector3d(p.x(), p.y(), 0.0), pixel) ||
          !camera.inImage(pixel, 1.0)) {
        return false;
      }
      const auto label = labels.at<std::uint8_t>(static_cast<int>(std::lround(pixel.y())),
                                                 static_cast<int>(std::lround(pixel.x())));
      if (label != static_cast<std::uint8_t>(SemanticClass::kPaintedNumber) &&
          label != static_cast<std::uint8_t>(SemanticClass::kFloor)) {
        return false;
      }
    }
  }
  return true;
}

/// As wide and high as labels of the stitched picture might show it.
PaintedNumber shaken(PaintedNumber number, Random& random) {
  const double width = number.width;
  const double height = number.height;
  number.center += random.normal(0.0, 0.04) * width * number.right +
                   random.normal(0.0, 0.06) * height * number.up();
  number.width *= std::exp(random.normal(0.03, 0.08));
  number.height *= std::exp(random.normal(0.03, 0.1));
  const double turn = random.normal(0.0, 2.5 * kDegree);
  number.right = Eigen::Rotation2Dd(turn) * number.right;
  return number;
}

// Upside down the other digits may be read as digits.
bool looksLikeTextTurned(const std::string& text) {
  return text.find_first_of("347") == std::string::npos;
}

void addNumbers(const SemanticSampler& sampler, const SemanticSample& sample, int camera,
                const cv::Mat& labels, Random& random, Strip& strip) {
  constexpr double kLeastHeight = 6.0;  // px
  constexpr double kTurned = 0.12;
  const sim::Garage& garage = sampler.simulation().garage();
  const RigCamera& eye = sampler.simulation().trueRig().cameras[static_cast<std::size_t>(camera)];
  const SE3 T_level_vehicle = levelFrom(sample.true_attitude);
  const SE3 T_level_world = T_level_vehicle * sample.T_world_vehicle.inverse();
  const SE3 T_level_cam = T_level_vehicle * eye.T_vehicle_cam;
  for (const sim::Marking& marking : garage.markings) {
    const bool a_number = marking.semantic_class == SemanticClass::kPaintedNumber &&
                          marking.meaning.rfind("accessible", 0) != 0;
    if (!a_number) continue;
    const PaintedNumber number = numberAround(marking, garage, T_level_world);
    const double distance = (number.center - T_level_cam.translation().head<2>()).norm();
    if (distance > kNumberReach) continue;
    const double height_px = seenHeight(number, eye.camera, sampler.bodyMask(camera), T_level_cam);
    if (height_px < kLeastHeight || !isOpen(number, eye.camera, T_level_cam, labels)) continue;
    cv::Mat patch = straightenNumber(shaken(number, random),
                                     sample.frames.images[static_cast<std::size_t>(camera)],
                                     eye.camera, T_level_cam);
    const bool turned = random.chance(kTurned) && !looksLikeTextTurned(marking.meaning);
    if (turned) cv::flip(patch, patch, -1);
    strip.add(patch, turned ? "" : marking.meaning, height_px, 0.0, distance,
              turned ? "turned" : "number");
  }
}

}  // namespace

Result<TextSampler> TextSampler::make(const std::string& view_network) {
  if (view_network.empty() && !findModel(kViewNetwork)) return TextSampler(std::nullopt);
  Result<SegmentationNetwork> network = SegmentationNetwork::loadOrOwn(view_network, kViewNetwork);
  if (!network) return network.error();
  return TextSampler(std::move(network).value());
}

Status TextSampler::write(const SemanticSampler& sampler, const SemanticSample& sample, int camera,
                          const std::string& stem) {
  const auto index = static_cast<std::size_t>(camera);
  const cv::Mat& image = sample.frames.images[index];
  const RigCamera& eye = sampler.simulation().toldRig().cameras[index];
  const SO3 R_level_cam = levelFrom(sample.attitude).rotation() * eye.T_vehicle_cam.rotation();
  Random random = Random(static_cast<std::uint64_t>(sampler.simulation().spec().seed))
                      .fork("text sample", static_cast<std::uint64_t>(sample.frames.index))
                      .fork("camera", static_cast<std::uint64_t>(camera));
  ZoneMarkerFaceOptions options;
  options.min_height_px = 8.0;
  options.max_faces = 12;
  const cv::Mat true_labels = sampler.cameraLabels(sample, camera);
  const std::vector<TrueZoneText> texts =
      trueZoneTexts(sampler, sample, camera, true_labels, kFaceReach);
  Strip strip;
  const auto addBy = [&](const cv::Mat& labels, const char* kind) {
    addFaces(
        findZoneMarkers(labels, image, sampler.bodyMask(camera), eye.camera, R_level_cam, options),
        texts, kind, strip, true);
  };
  std::vector<cv::Mat> all_labels = {atNetworkSize(true_labels)};
  addBy(all_labels.front(), "true");
  addBy(shakenLabels(all_labels.front(), random), "shaken");
  if (network_) {
    Result<ViewLabels> found = network_->segmentView(image);
    if (!found) return found.error();
    addBy(found->labels, "network");
    all_labels.push_back(found->labels);
  }
  const auto addSigns = [&](SemanticClass sign, const char* kind) {
    std::vector<TrueZoneText> signs =
        trueZoneTexts(sampler, sample, camera, true_labels, kFaceReach, sign);
    for (TrueZoneText& text : signs) text.text = guideReading(text.text);
    for (const cv::Mat& labels : all_labels) {
      addFaces(findSigns(labels, image, sampler.bodyMask(camera), eye.camera, R_level_cam, sign,
                         options),
               signs, kind, strip, false);
    }
  };
  addSigns(SemanticClass::kGuideSign, "guide");
  addSigns(SemanticClass::kSpeedLimitSign, "limit");
  addNumbers(sampler, sample, camera, true_labels, random, strip);
  if (strip.patches.rows == 0) return {};
  const Status status = writeFileAtomic(stem + "_texts.csv", strip.lines);
  return status ? writeImage(stem + "_texts.png", strip.patches, {.png = true, .png_level = 1})
                : status;
}

}  // namespace parkade::cli
