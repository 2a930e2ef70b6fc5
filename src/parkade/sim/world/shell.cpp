// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "parkade/sim/world/structure.hpp"

namespace parkade::sim {
namespace {

constexpr double kOpeningHeight = 2.35;  // m, of the entrance
constexpr double kDoorWidth = 0.95;
constexpr double kDoorHeight = 2.05;
constexpr double kTextureSize = 4.0;  // m per repeat of the stain texture

struct ShellMaterials {
  std::uint16_t floor, lower, upper, ceiling, beam, door, frame, red, exit_sign, ramp, ramp_wall;
  std::array<std::uint16_t, 4> posters;
};

ShellMaterials addMaterials(const GarageStyle& style, Random random, Palette& palette) {
  const int stain = palette.addTexture(stainTexture(512, 0.35 + 0.5 * style.dirt, random.bits()));
  const int form = palette.addTexture(stainTexture(256, 0.5, random.bits()));
  ShellMaterials m{};
  m.floor = palette.add("floor", SemanticClass::kFloor, style.aisle_floor, style.floor_roughness,
                        style.floor_specular);
  palette.scene().materials[m.floor].is_floor = true;
  m.lower =
      palette.add("wall_lower", SemanticClass::kWall, style.wall_lower / 0.86F, 0.5F, 0.04F, stain);
  m.upper =
      palette.add("wall_upper", SemanticClass::kWall, style.wall_upper / 0.86F, 0.9F, 0.04F, stain);
  m.ceiling = palette.add("ceiling", SemanticClass::kCeiling, style.ceiling_colour / 0.86F, 0.9F,
                          0.04F, form);
  m.beam =
      palette.add("beam", SemanticClass::kCeiling, 1.05F * style.ceiling_colour, 0.9F, 0.04F, form);
  m.door = palette.add("door", SemanticClass::kWall, {0.36F, 0.36F, 0.34F}, 0.5F, 0.04F, stain);
  m.frame = palette.add("frame", SemanticClass::kWall, {0.12F, 0.12F, 0.12F}, 0.6F);
  m.red = palette.add("hydrant", SemanticClass::kWall, {0.45F, 0.03F, 0.02F}, 0.4F);
  const int exit_texture = palette.addTexture(guideTexture(0.5, 0.2, "EXIT"));
  m.exit_sign = palette.addGlow("exit_light", SemanticClass::kWall, Eigen::Vector3f::Constant(1.5F),
                                exit_texture);
  // Under the open sky: what it receives does not come from the lamps that the bake knows.
  m.ramp = palette.addGlow("ramp", SemanticClass::kFloor, Eigen::Vector3f(1.0F, 1.0F, 1.03F), form);
  m.ramp_wall =
      palette.addGlow("ramp_wall", SemanticClass::kWall, Eigen::Vector3f(0.8F, 0.8F, 0.83F), form);
  for (std::size_t i = 0; i < m.posters.size(); ++i) {
    const int texture = palette.addTexture(posterTexture(random.fork("poster", i).bits()));
    m.posters[i] =
        palette.add("poster", SemanticClass::kWall, Eigen::Vector3f::Ones(), 0.4F, 0.04F, texture);
  }
  return m;
}

/// Builds walls seen from the left of their run from a to b.
class WallBuilder {
 public:
  WallBuilder(const Garage& garage, const GarageStyle& style, const ShellMaterials& materials,
              MeshBuilder& mesh)
      : garage_(garage), style_(style), m_(materials), mesh_(mesh) {}

  /// The whole height, or only above `from` metres over the datum.
  void wall(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double from = -0.5) {
    const double band = std::max(from, std::min(style_.wall_band_height, top()));
    if (band > from) panel(a, b, from, band, m_.lower);
    if (top() > band) panel(a, b, band, top(), m_.upper);
  }

  /// A rectangle on the wall, `out` metres before it; s along the wall from a.
  void plate(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double s, double width, double z0,
             double z1, double out, std::uint16_t material) {
    const Eigen::Vector2d along = (b - a).normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    const Eigen::Vector2d p = a + s * along + out * normal;
    const Eigen::Vector2d q = p + width * along;
    // Seen from the left of the run, its end lies to the left.
    mesh_.quad(point3(q, z0), point3(p, z0), point3(p, z1), point3(q, z1), material);
  }

  void door(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double s) {
    const Eigen::Vector2d along = (b - a).normalized();
    const double floor = garage_.floorHeight(a + s * along);
    plate(a, b, s - 0.06, kDoorWidth + 0.12, floor, floor + kDoorHeight + 0.06, 0.01, m_.frame);
    plate(a, b, s, kDoorWidth, floor, floor + kDoorHeight, 0.02, m_.door);
    plate(a, b, s + 0.08, 0.10, floor + 0.98, floor + 1.03, 0.04, m_.frame);
    plate(a, b, s + 0.2, 0.5, floor + 2.15, floor + 2.35, 0.05, m_.exit_sign);
  }

  void hydrant(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double s) {
    const Eigen::Vector2d along = (b - a).normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    const Eigen::Vector2d c = a + s * along + 0.11 * normal;
    const double z = garage_.floorHeight(c) + 1.0;
    mesh_.box(point3(c, z), {0.36F, 0.11F, 0.6F}, m_.red,
              static_cast<float>(std::atan2(along.y(), along.x())));
    plate(a, b, s - 0.25, 0.5, z - 0.1, z + 0.45, 0.225, m_.frame);
  }

  [[nodiscard]] double top() const { return garage_.ceiling_height; }

 private:
  /// Where the floor slopes, the lower edge follows it piece by piece.
  void panel(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double z0, double z1,
             std::uint16_t material) {
    const double length = (b - a).norm();
    const bool on_floor = z0 < -0.1;
    const int pieces =
        on_floor && !garage_.ramps.empty() ? std::max(1, static_cast<int>(length / 1.5)) : 1;
    for (int i = 0; i < pieces; ++i) {
      const Eigen::Vector2d p = a + (b - a) * i / pieces;
      const Eigen::Vector2d q = a + (b - a) * (i + 1) / pieces;
      const double low_p = on_floor ? garage_.floorHeight(p) - 1e-3 : z0;
      const double low_q = on_floor ? garage_.floorHeight(q) - 1e-3 : z0;
      // Texture coordinates run from the far end of the run.
      const auto uv = [&](const Eigen::Vector2d& at, double z) {
        return Eigen::Vector2f(static_cast<float>((b - at).norm() / kTextureSize),
                               static_cast<float>(z / kTextureSize));
      };
      const Eigen::Vector2d along = (b - a) / length;
      const Eigen::Vector3f normal = point3({-along.y(), along.x()}, 0.0);
      const std::uint32_t v = mesh_.vertex(point3(q, low_q), normal, uv(q, low_q));
      mesh_.vertex(point3(p, low_p), normal, uv(p, low_p));
      mesh_.vertex(point3(p, z1), normal, uv(p, z1));
      mesh_.vertex(point3(q, z1), normal, uv(q, z1));
      mesh_.triangle(v, v + 1, v + 2, material);
      mesh_.triangle(v, v + 2, v + 3, material);
    }
  }

  const Garage& garage_;
  const GarageStyle& style_;
  const ShellMaterials& m_;
  MeshBuilder& mesh_;
};

void addFloor(const Garage& garage, std::uint16_t material, MeshBuilder& mesh) {
  // A little wider than the outline, so that no ray slips between floor and wall.
  const Eigen::Vector2d low = garage.min - Eigen::Vector2d::Constant(0.2);
  const double step = garage.ramps.empty() ? 1000.0 : 0.75;
  const Eigen::Vector2d size = garage.max - garage.min + Eigen::Vector2d::Constant(0.4);
  const int nx = std::max(1, static_cast<int>(std::ceil(size.x() / step)));
  const int ny = std::max(1, static_cast<int>(std::ceil(size.y() / step)));
  std::vector<std::uint32_t> index;
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const Eigen::Vector2d p = low + Eigen::Vector2d(size.x() * i / nx, size.y() * j / ny);
      constexpr double kStep = 0.01;
      const double dx = (garage.floorHeight(p + Eigen::Vector2d(kStep, 0.0)) -
                         garage.floorHeight(p - Eigen::Vector2d(kStep, 0.0))) /
                        (2.0 * kStep);
      const double dy = (garage.floorHeight(p + Eigen::Vector2d(0.0, kStep)) -
                         garage.floorHeight(p - Eigen::Vector2d(0.0, kStep))) /
                        (2.0 * kStep);
      const Eigen::Vector3f normal(static_cast<float>(-dx), static_cast<float>(-dy), 1.0F);
      index.push_back(mesh.vertex(point3(p, garage.floorHeight(p)), normal.normalized()));
    }
  }
  const auto at = [&](int i, int j) { return index[static_cast<std::size_t>(j * (nx + 1) + i)]; };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      mesh.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1), material);
      mesh.triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1), material);
    }
  }
}

void addCeiling(const Garage& garage, const ShellMaterials& m, MeshBuilder& mesh) {
  const double z = garage.ceiling_height;
  const Eigen::Vector2d a = garage.min;
  const Eigen::Vector2d b = garage.max;
  const Eigen::Vector2f repeats = ((b - a) / kTextureSize).cast<float>();
  mesh.quad(point3({a.x(), b.y()}, z), point3(b, z), point3({b.x(), a.y()}, z), point3(a, z),
            m.ceiling, repeats);
  // Beams from pillar to pillar.
  std::set<long> columns;
  std::set<long> rows;
  for (const Pillar& pillar : garage.pillars) {
    columns.insert(std::lround(pillar.center.x() * 1000.0));
    rows.insert(std::lround(pillar.center.y() * 1000.0));
  }
  constexpr float kHalfWidth = 0.2F;
  constexpr float kHalfDepth = 0.11F;
  const float bz = static_cast<float>(z) - kHalfDepth;
  const Eigen::Vector2f middle = (0.5 * (a + b)).cast<float>();
  const Eigen::Vector2f half = (0.5 * (b - a)).cast<float>();
  for (const long x : columns) {
    mesh.box({static_cast<float>(x) * 1e-3F, middle.y(), bz}, {kHalfWidth, half.y(), kHalfDepth},
             m.beam);
  }
  for (const long y : rows) {
    mesh.box({middle.x(), static_cast<float>(y) * 1e-3F, bz + 0.02F},
             {half.x(), kHalfWidth, kHalfDepth - 0.02F}, m.beam);
  }
}

/// The way up to the street behind the opening: slope, side walls, a roof over its first metres.
void addRamp(const Garage& garage, const Entrance& entrance, const ShellMaterials& m,
             MeshBuilder& mesh) {
  constexpr double kLength = 16.0;
  constexpr double kRise = 2.3;
  constexpr double kFlat = 1.0;
  const Frame2 at{entrance.center, entrance.heading};
  const double half = 0.5 * entrance.width;
  const double z0 = garage.floorHeight(entrance.center);
  const auto p = [&](double x, double y, double z) {
    return point3(at * Eigen::Vector2d(x, y), z);
  };
  mesh.quad(p(-kFlat, half, z0), p(-kFlat, -half, z0), p(0.0, -half, z0), p(0.0, half, z0), m.ramp);
  mesh.quad(p(-kLength, half, z0 + kRise), p(-kLength, -half, z0 + kRise), p(-kFlat, -half, z0),
            p(-kFlat, half, z0), m.ramp, {4.0F, 1.5F});
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector2d middle = at * Eigen::Vector2d(-0.5 * kLength, side * (half + 0.1));
    mesh.box(point3(middle, z0 + 0.5 * kRise + 0.45),
             {static_cast<float>(0.5 * kLength), 0.1F, static_cast<float>(0.5 * kRise + 0.55)},
             m.ramp_wall, static_cast<float>(entrance.heading));
  }
}

void addOuterWalls(const Garage& garage, const ShellMaterials& m, Random random,
                   WallBuilder& walls) {
  const std::size_t n = garage.outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d a = garage.outline[i];
    const Eigen::Vector2d b = garage.outline[(i + 1) % n];
    const double length = (b - a).norm();
    const Eigen::Vector2d along = (b - a) / length;
    double from = 0.0;
    for (const auto& [begin, end] : garage.openings(a, b)) {
      walls.wall(a + from * along, a + begin * along);
      walls.wall(a + begin * along, a + end * along, kOpeningHeight);
      from = end;
    }
    walls.wall(a + from * along, b);
    const auto is_shut = [&](double s) {
      const Eigen::Vector2d p = a + s * along;
      return std::none_of(garage.entrances.begin(), garage.entrances.end(), [&](const Entrance& e) {
        return (e.center - p).norm() < 0.5 * e.width + 2.0;
      });
    };
    for (double s = random.uniform(3.0, 9.0); s < length - 3.0; s += random.uniform(5.0, 13.0)) {
      if (!is_shut(s)) continue;
      const double u = random.uniform();
      if (u < 0.3)
        walls.door(a, b, s);
      else if (u < 0.5)
        walls.hydrant(a, b, s);
      else
        walls.plate(a, b, s, 0.8, 1.0, 2.1, 0.012, random.pick(m.posters));
    }
  }
}

void addRooms(const Garage& garage, const ShellMaterials& m, Random random, WallBuilder& walls) {
  for (const Room& room : garage.rooms) {
    // Clockwise, so that the walls are seen from outside.
    const std::array<Eigen::Vector2d, 4> corners = {
        Eigen::Vector2d(room.min.x(), room.min.y()), Eigen::Vector2d(room.min.x(), room.max.y()),
        Eigen::Vector2d(room.max.x(), room.max.y()), Eigen::Vector2d(room.max.x(), room.min.y())};
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d& a = corners[i];
      const Eigen::Vector2d& b = corners[(i + 1) % 4];
      walls.wall(a, b);
      const double length = (b - a).norm();
      for (double s = random.uniform(0.8, 3.0); s < length - 1.6; s += random.uniform(3.0, 9.0)) {
        const double u = random.uniform();
        if (u < 0.4)
          walls.door(a, b, s);
        else if (u < 0.55)
          walls.hydrant(a, b, s);
        else
          walls.plate(a, b, s, 0.8, 1.0, 2.1, 0.012, random.pick(m.posters));
      }
    }
  }
}

}  // namespace

void addShell(const Garage& garage, const GarageStyle& style, Random random, Palette& palette,
              MeshBuilder& mesh) {
  const ShellMaterials m = addMaterials(style, random.fork("materials"), palette);
  addFloor(garage, m.floor, mesh);
  addCeiling(garage, m, mesh);
  WallBuilder walls(garage, style, m, mesh);
  addOuterWalls(garage, m, random.fork("outer"), walls);
  addRooms(garage, m, random.fork("rooms"), walls);
  for (const Entrance& entrance : garage.entrances) addRamp(garage, entrance, m, mesh);
}

}  // namespace parkade::sim
