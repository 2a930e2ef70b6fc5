// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "parkade/core/time.hpp"
#include "parkade/mapping/frame_evidence.hpp"

namespace parkade {

struct GlobalMapOptions {
  double resolution_m = 0.05;
  double distance_m = 0.2;
  double rotation_deg = 3.0;
  double interval_s = 1.0;
  int rebuild_per_frame = 8;
  EvidenceOptions evidence;

  void visit(OptionVisitor& v) {
    v.field("resolution_m", resolution_m, "m", "Side of a cell.", 0.01, 1.0);
    v.field("distance_m", distance_m, "m",
            "The car moves this far between two pictures that are entered; one that stands sees "
            "nothing new.",
            0.0, 10.0);
    v.field("rotation_deg", rotation_deg, "deg", "Or turns this much.", 0.0, 180.0);
    v.field("interval_s", interval_s, "s",
            "Or this time passes: cars come and go around a standing one.", 0.05, 60.0);
    v.field("rebuild_per_frame", rebuild_per_frame, "count",
            "Old pictures entered anew per frame set after poses were corrected.", 1, 1000);
    v.group("evidence", evidence);
  }
};

/// The five layers of all that was seen. Every entered picture hangs on an anchor: a pose of the
/// graph, which loop closures correct. When anchors move, the grid is made again from the pictures,
/// some per frame set, beside the old one, which stays in use until the new one is complete.
class GlobalMap {
 public:
  explicit GlobalMap(const GlobalMapOptions& options);
  ~GlobalMap();
  GlobalMap(GlobalMap&&) noexcept;
  GlobalMap& operator=(GlobalMap&&) noexcept;

  /// Enters a picture, where the car has moved or waited enough since the last; true if so.
  /// new_view: false where the car stands as in the frame before: unless it has moved enough since
  /// a picture that entered all layers, it enters layers 2 and 5 alone. Goes on with a rebuild that
  /// is under way.
  bool update(const PackedLabels& labels, TimeNs t_ns, std::int64_t anchor,
              const SE2& T_anchor_vehicle, bool new_view = true);

  /// The pose of an anchor in the map, new or corrected. A correction that moves the anchor or its
  /// pictures' edges by less than a cell is kept for later; others start a rebuild.
  void setAnchor(std::int64_t anchor, const SE2& T_map_anchor);

  /// Finishes a rebuild and takes up all corrections, however small.
  void finish();

  [[nodiscard]] bool rebuilding() const;
  [[nodiscard]] const LayeredGrid& grid() const;
  [[nodiscard]] LayeredGrid& grid();
  [[nodiscard]] int pictures() const;
  [[nodiscard]] std::size_t pictureBytes() const;  ///< memory that they take, compressed

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
