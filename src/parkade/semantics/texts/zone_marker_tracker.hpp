// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/core/time.hpp"
#include "parkade/types/text_evidence.hpp"

namespace parkade {

struct ZoneMarkerTrackerOptions {
  double height_m = 0.62;
  double height_sigma_m = 0.2;
  double place_sigma_m = 0.08;
  double told_sigma_m = 0.3;
  int told_views = 3;
  double told_confidence = 0.9;
  double forget_s = 15.0;
  int max_views = 40;

  void visit(OptionVisitor& v) {
    v.field("height_m", height_m, "m", "Height of a marker, as expected before it is measured.",
            0.05, 5.0);
    v.field("height_sigma_m", height_sigma_m, "m", "How much markers differ in height, 1 sigma.",
            0.01, 5.0);
    v.field("place_sigma_m", place_sigma_m, "m",
            "How far the middle of what is seen of a pillar lies off its axis, 1 sigma.", 1e-4,
            1.0);
    v.field("told_sigma_m", told_sigma_m, "m",
            "Markers are told when placed this well over the ground, 1 sigma.", 0.01, 5.0);
    v.field("told_views", told_views, "count", "And seen this often.", 1, 100);
    v.field("told_confidence", told_confidence, "probability",
            "And read this surely over all views; 0: read or not.", 0.0, 0.999999);
    v.field("forget_s", forget_s, "s", "Markers not seen for longer are forgotten.", 0.1, 600.0);
    v.field("max_views", max_views, "count", "Views of a marker that are kept, the latest.", 3,
            1000);
  }
};

/// A marker in one camera's picture, in any frame that stands still and has z up.
struct ZoneMarkerView {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();   ///< the camera's place
  Eigen::Vector3d ray = Eigen::Vector3d::UnitX();  ///< unit, to the marker's middle
  double sigma = 0.0;                              ///< rad, of the ray across its direction
  double height_ratio = 0.0;  ///< the marker's height over its horizontal distance
  double height_sigma = 0.0;
  std::vector<std::vector<TextReading>> readings;  ///< of each face that was read, best first
  bool whole = true;  ///< or cut: belongs to a marker that is followed already, or to none
};

/// A marker placed by several views, since it was told last.
struct ZoneMarker {
  std::uint64_t id = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< its middle, on the pillar's axis
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  std::string text;         ///< by all views so far
  double confidence = 0.0;  ///< of the text
  int views = 0;
};

/// Follows zone markers over pictures and places them: for each the position and the height that
/// explain all bearings and apparent heights best, robustly (docs/math/zone_markers.md). What is
/// told once is not told again: each ZoneMarker rests on views of its own, so that a map may take
/// one as a measurement independent of those before. Texts that were read surely tell how the
/// others are made up.
class ZoneMarkerTracker {
 public:
  explicit ZoneMarkerTracker(const ZoneMarkerTrackerOptions& options) : options_(options) {}

  /// Takes what one camera saw at an instant; in order of time (checked).
  void add(const std::vector<ZoneMarkerView>& views, TimeNs t_ns);

  /// Whether what a view shows need not be read: it is of one marker, and of no other, whose text
  /// several views surely agree on. Every third view of such a one is to be read all the same.
  [[nodiscard]] bool needsNoReading(const ZoneMarkerView& view) const;

  /// The markers that have become well enough known since.
  std::vector<ZoneMarker> takeTold();

  /// Place and text of all that are followed, for pictures and tests.
  [[nodiscard]] std::vector<ZoneMarker> followed() const;

  void reset() { tracks_.clear(); }

 private:
  struct Track {
    std::uint64_t id = 0;
    std::deque<ZoneMarkerView> views;
    std::size_t told = 0;                             ///< of the views, those that were told
    std::size_t seen = 0;                             ///< views so far, also those that went
    Eigen::Vector4d state = Eigen::Vector4d::Zero();  ///< position, height
    Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
    TextEvidence text;
    TimeNs seen_ns = 0;
  };
  [[nodiscard]] double misfit(const Track& track, const ZoneMarkerView& view) const;
  [[nodiscard]] static bool contradicts(const Track& track, const ZoneMarkerView& view);
  void extend(Track& track, const ZoneMarkerView& view, TimeNs t_ns) const;
  void start(const ZoneMarkerView& view, TimeNs t_ns);

  ZoneMarkerTrackerOptions options_;
  TextFormat format_;
  std::vector<Track> tracks_;
  std::uint64_t next_id_ = 1;
  TimeNs last_ns_ = 0;
};

}  // namespace parkade
