// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/global_map.hpp"

#include <zstd.h>

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "parkade/core/check.hpp"
#include "parkade/core/units.hpp"
#include "parkade/mapping/layer_update.hpp"

namespace parkade {
namespace {

struct PackedPicture {
  std::int64_t anchor = 0;
  SE2 T_anchor_vehicle;
  TimeNs t_ns = 0;
  bool new_view = true;
  BevGeometry geometry;
  std::vector<std::uint8_t> packed;  // zstd
  std::vector<PackedLabels::Box> moving;
};

PackedPicture compress(const PackedLabels& labels) {
  PackedPicture picture;
  picture.geometry = labels.geometry;
  picture.moving = labels.moving;
  picture.packed.resize(ZSTD_compressBound(labels.pixels.size()));
  const std::size_t size = ZSTD_compress(picture.packed.data(), picture.packed.size(),
                                         labels.pixels.data(), labels.pixels.size(), 1);
  PARKADE_CHECK(ZSTD_isError(size) == 0, "a picture cannot be compressed");
  picture.packed.resize(size);
  picture.packed.shrink_to_fit();
  return picture;
}

PackedLabels expand(const PackedPicture& picture) {
  PackedLabels labels;
  labels.geometry = picture.geometry;
  labels.moving = picture.moving;
  labels.pixels.resize(static_cast<std::size_t>(picture.geometry.width_px) *
                       static_cast<std::size_t>(picture.geometry.height_px));
  const std::size_t size = ZSTD_decompress(labels.pixels.data(), labels.pixels.size(),
                                           picture.packed.data(), picture.packed.size());
  PARKADE_CHECK(size == labels.pixels.size(), "a picture unpacks to {} bytes", size);
  return labels;
}

// Looks tiles up once per run of cells in the same tile.
class TileCursor {
 public:
  TileCursor(LayeredGrid& grid, GridLayer layer) : grid_(grid), layer_(layer) {}
  GridCell& touch(int i, int j) {
    seek(i, j);
    if (tile_ == nullptr) tile_ = &grid_.touchTile(layer_, at_);
    return (*tile_)[cell_];
  }
  bool known(int i, int j) {
    seek(i, j);
    if (tile_ == nullptr) tile_ = grid_.findTile(layer_, at_);
    return tile_ != nullptr && (*tile_)[cell_].known();
  }

 private:
  void seek(int i, int j) {
    constexpr int kSide = LayeredGrid::kTileCells;
    static_assert((kSide & (kSide - 1)) == 0);
    const LayeredGrid::TileIndex at{i >> kShift, j >> kShift};
    cell_ = static_cast<std::size_t>((j & (kSide - 1)) * kSide + (i & (kSide - 1)));
    if (at == at_ && tile_ != nullptr) return;
    if (at != at_) tile_ = nullptr;
    at_ = at;
  }
  static constexpr int kShift = 6;
  static_assert(1 << kShift == LayeredGrid::kTileCells);

  LayeredGrid& grid_;
  GridLayer layer_;
  LayeredGrid::TileIndex at_{INT32_MIN, INT32_MIN};
  std::array<GridCell, LayeredGrid::kTileCells* LayeredGrid::kTileCells>* tile_ = nullptr;
  std::size_t cell_ = 0;
};

}  // namespace

struct GlobalMap::Impl {
  explicit Impl(const GlobalMapOptions& o) : options(o), kernel(o.evidence), grid(o.resolution_m) {}

  void enter(LayeredGrid& target, const PackedLabels& labels, const SE2& T_map_vehicle,
             bool new_view, double since_last_s);
  [[nodiscard]] bool movedFrom(const std::optional<SE2>& before, const SE2& T_map_vehicle) const;
  void rebuildSome(std::size_t count);
  void keep(PackedPicture picture);
  [[nodiscard]] const SE2& anchorOf(const std::unordered_map<std::int64_t, SE2>& poses,
                                    std::int64_t anchor) const;

  GlobalMapOptions options;
  EvidenceKernel kernel;
  LayeredGrid grid;
  std::vector<PackedPicture> pictures;
  std::unordered_map<std::int64_t, SE2> anchors;  // newest poses
  std::unordered_map<std::int64_t, SE2> entered;  // poses that the grid was made with
  // A rebuild under way: the new grid, the poses it is made with, and the next picture.
  std::optional<LayeredGrid> next_grid;
  std::unordered_map<std::int64_t, SE2> next_poses;
  std::size_t next_picture = 0;
  std::optional<SE2> last_pose;  // in the map, of the last picture entered
  std::optional<SE2> last_view;  // and of the last that entered all layers
  TimeNs last_t_ns = 0;
};

bool GlobalMap::Impl::movedFrom(const std::optional<SE2>& before, const SE2& T_map_vehicle) const {
  if (!before) return true;
  const SE2 step = before->inverse() * T_map_vehicle;
  return step.translation().norm() >= options.distance_m ||
         std::abs(step.angle()) >= options.rotation_deg * kDegree;
}

void GlobalMap::Impl::enter(LayeredGrid& target, const PackedLabels& labels,
                            const SE2& T_map_vehicle, bool new_view, double since_last_s) {
  if (since_last_s > 0.0 && !target.tiles(GridLayer::kDynamic).empty()) {
    target.fade(
        GridLayer::kDynamic,
        static_cast<float>(std::exp2(-since_last_s / options.evidence.dynamic_half_life_s)));
  }
  TileCursor lines(target, GridLayer::kParkingLines);
  TileCursor free(target, GridLayer::kAvailability);
  TileCursor markers(target, GridLayer::kRoadMarkers);
  TileCursor zones(target, GridLayer::kZoneMarkers);
  TileCursor dynamic(target, GridLayer::kDynamic);
  const std::array<TileCursor*, kNumGridLayers> cursors = {&lines, &free, &markers, &zones,
                                                           &dynamic};
  kernel.forEachCell(labels, T_map_vehicle, target.resolution(),
                     [&](int i, int j, SemanticClass c, const EvidenceSteps& steps,
                         const Eigen::Vector2d& p_level) {
                       updateLayers(
                           labels, c, steps, p_level, new_view,
                           [&](GridLayer l) -> GridCell& {
                             return cursors[static_cast<std::size_t>(l)]->touch(i, j);
                           },
                           [&] { return dynamic.known(i, j); });
                     });
}

const SE2& GlobalMap::Impl::anchorOf(const std::unordered_map<std::int64_t, SE2>& poses,
                                     std::int64_t anchor) const {
  const auto it = poses.find(anchor);
  PARKADE_CHECK(it != poses.end(), "anchor {} has no pose", anchor);
  return it->second;
}

void GlobalMap::Impl::rebuildSome(std::size_t count) {
  if (!next_grid) return;
  for (std::size_t k = 0; k < count && next_picture < pictures.size(); ++k, ++next_picture) {
    const PackedPicture& picture = pictures[next_picture];
    const double since =
        next_picture == 0 ? 0.0 : toSeconds(picture.t_ns - pictures[next_picture - 1].t_ns);
    // Anchors made since the rebuild began keep the newest pose.
    const auto it = next_poses.try_emplace(picture.anchor, anchorOf(anchors, picture.anchor)).first;
    enter(*next_grid, expand(picture), it->second * picture.T_anchor_vehicle, picture.new_view,
          since);
  }
  if (next_picture < pictures.size()) return;
  // Tiles that vanished must not come back from an older file: the new grid is dirty throughout.
  grid = std::move(*next_grid);
  entered = std::move(next_poses);
  next_grid.reset();
  next_poses.clear();
}

// Of a stand's pictures, which tell what moved alone, the newest are enough: a car may stand for
// hours.
void GlobalMap::Impl::keep(PackedPicture picture) {
  constexpr std::size_t kOfAStand = 5;
  pictures.push_back(std::move(picture));
  if (pictures.size() <= kOfAStand) return;
  const std::size_t oldest = pictures.size() - 1 - kOfAStand;
  const auto at = pictures.begin() + static_cast<std::ptrdiff_t>(oldest);
  const auto shows_new = [](const PackedPicture& each) { return each.new_view; };
  if (std::any_of(at, pictures.end(), shows_new)) return;
  pictures.erase(at);
  if (next_grid && next_picture > oldest) --next_picture;
}

GlobalMap::GlobalMap(const GlobalMapOptions& options) : impl_(std::make_unique<Impl>(options)) {}
GlobalMap::~GlobalMap() = default;
GlobalMap::GlobalMap(GlobalMap&&) noexcept = default;
GlobalMap& GlobalMap::operator=(GlobalMap&&) noexcept = default;

bool GlobalMap::update(const PackedLabels& labels, TimeNs t_ns, std::int64_t anchor,
                       const SE2& T_anchor_vehicle, bool new_view) {
  Impl& m = *impl_;
  m.rebuildSome(static_cast<std::size_t>(m.options.rebuild_per_frame));
  const SE2 T_map_vehicle = m.anchorOf(m.anchors, anchor) * T_anchor_vehicle;
  double since = 0.0;
  if (m.last_pose) {
    since = toSeconds(t_ns - m.last_t_ns);
    if (!m.movedFrom(m.last_pose, T_map_vehicle) && since < m.options.interval_s) return false;
  }
  PackedPicture picture = compress(labels);
  picture.anchor = anchor;
  picture.T_anchor_vehicle = T_anchor_vehicle;
  picture.t_ns = t_ns;
  // One that creeps sees new ground as well.
  picture.new_view = new_view || m.movedFrom(m.last_view, T_map_vehicle);
  if (picture.new_view) m.last_view = T_map_vehicle;
  m.keep(std::move(picture));
  // The grid in use keeps the pose that its other pictures of this anchor have.
  const SE2& T_map_anchor =
      m.entered.try_emplace(anchor, m.anchorOf(m.anchors, anchor)).first->second;
  m.enter(m.grid, labels, T_map_anchor * T_anchor_vehicle, m.pictures.back().new_view, since);
  m.last_pose = T_map_vehicle;
  m.last_t_ns = t_ns;
  return true;
}

void GlobalMap::setAnchor(std::int64_t anchor, const SE2& T_map_anchor) {
  Impl& m = *impl_;
  m.anchors[anchor] = T_map_anchor;
  if (m.next_grid) return;  // the rebuild takes what it began with; the next one follows
  const auto it = m.entered.find(anchor);
  if (it == m.entered.end()) return;
  const SE2 step = it->second.inverse() * T_map_anchor;
  const double tolerance = m.options.resolution_m;
  if (step.translation().norm() < tolerance &&
      std::abs(step.angle()) * m.options.evidence.range_m < tolerance) {
    return;
  }
  m.next_grid.emplace(m.options.resolution_m);
  m.next_poses.clear();
  m.next_picture = 0;
}

void GlobalMap::finish() {
  Impl& m = *impl_;
  m.next_grid.emplace(m.options.resolution_m);
  m.next_poses.clear();
  m.next_picture = 0;
  m.rebuildSome(m.pictures.size());
}

bool GlobalMap::rebuilding() const {
  return impl_->next_grid.has_value();
}
const LayeredGrid& GlobalMap::grid() const {
  return impl_->grid;
}
LayeredGrid& GlobalMap::grid() {
  return impl_->grid;
}
int GlobalMap::pictures() const {
  return static_cast<int>(impl_->pictures.size());
}
std::size_t GlobalMap::pictureBytes() const {
  std::size_t bytes = 0;
  for (const PackedPicture& picture : impl_->pictures) bytes += picture.packed.size();
  return bytes;
}

}  // namespace parkade
