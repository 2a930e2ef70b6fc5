// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "parkade/camera/camera.hpp"
#include "parkade/core/options.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/semantics/texts/text_patch.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {

struct ZoneMarkerFaceOptions {
  int min_label_px = 10;
  double min_height_px = 10.0;
  double max_slant_deg = 68.0;
  int max_faces = 10;

  void visit(OptionVisitor& v) {
    v.field("min_label_px", min_label_px, "px", "Smaller patches of labels are no marker.", 1,
            100000);
    v.field("min_height_px", min_height_px, "px",
            "Markers lower than this in the camera's picture are not read.", 1.0, 1000.0);
    v.field("max_slant_deg", max_slant_deg, "deg",
            "Faces turned farther away from the camera are not read.", 0.0, 89.0);
    v.field("max_faces", max_faces, "count", "Faces that are read in a picture, largest first.", 1,
            100);
  }
};

/// One vertical face of a marker, straightened: upright, as seen from straight ahead.
struct ZoneMarkerFace {
  /// CV_8UC3 (BGR), kZonePatchWidth x kZonePatchHeight; on the face mean 128 and standard
  /// deviation 40, whatever the light; grey beside it.
  cv::Mat patch;
  cv::Mat around;             ///< the same with what is above and below, kTallPatchHeight high
  double patch_height = 1.0;  ///< px of the patch that the face is high
  double slant = 0.0;         ///< rad, between its normal and the line of sight
  double height_px = 0;       ///< in the camera's picture
  /// Its corners there: top left, top right, bottom right, bottom left.
  std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                            Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
};

/// A zone marker as one camera sees it: the marked part of a pillar, one or two faces in sight.
struct ZoneMarkerSight {
  SemanticClass semantic_class = SemanticClass::kZoneMarker;
  Eigen::Vector3d ray_level = Eigen::Vector3d::UnitX();  ///< unit, to the middle; levelled axes
  double sigma = 0.0;                                    ///< rad, of the ray across its direction
  double height_ratio = 0.0;  ///< the marker's height over its horizontal distance
  double height_sigma = 0.0;  ///< of that ratio
  bool cut = false;           ///< by the picture's border or the own car, or covered by a car
  bool legible = false;       ///< not cut at its sides, so that its text is whole
  cv::Rect box;               ///< in the label picture
  std::vector<ZoneMarkerFace> faces;  ///< from left to right; those that can be read
  /// The other way to part the outline into faces.
  std::vector<ZoneMarkerFace> other_faces;
};

/// Of a sight without faces: whether they shall be straightened.
using WantedSight = std::function<bool(const ZoneMarkerSight&)>;

/// Finds zone markers in the labels of a camera's picture and straightens their faces.
///
/// Everything is measured in a picture that a level camera would take in the marker's direction:
/// there a vertical face's height is a linear function of the column, h(x) ~ 1 / depth, and a
/// pillar's two visible faces meet where it peaks (docs/math/zone_markers.md). The outline says
/// thus how the faces stand; no size need be known.
///
/// labels: CV_8UC1 (SemanticClass), of any size; the picture that the camera gave, shrunk. mask:
/// CV_8UC1 of the camera's picture, 0 where the own car is; may be empty. R_level_cam: from the
/// camera to axes with z up. wanted: empty for all.
std::vector<ZoneMarkerSight> findZoneMarkers(const cv::Mat& labels, const cv::Mat& image,
                                             const cv::Mat& mask, const Camera& camera,
                                             const SO3& R_level_cam,
                                             const ZoneMarkerFaceOptions& options,
                                             const WantedSight& wanted = nullptr);

/// The same for signs of a class: one face each, of a speed-limit sign the middle of the plate
/// inside its ring.
std::vector<ZoneMarkerSight> findSigns(const cv::Mat& labels, const cv::Mat& image,
                                       const cv::Mat& mask, const Camera& camera,
                                       const SO3& R_level_cam, SemanticClass sign,
                                       const ZoneMarkerFaceOptions& options);

}  // namespace parkade
