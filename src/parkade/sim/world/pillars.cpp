// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "parkade/sim/world/structure.hpp"

namespace parkade::sim {
namespace {

/// Materials that pillars share.
struct PillarMaterials {
  std::uint16_t body, guard, black, yellow;
};

/// Height of the coloured band above and below its text, m.
constexpr double kBandMargin = 0.14;

class PillarBuilder {
 public:
  PillarBuilder(const Garage& garage, const GarageStyle& style, const PillarMaterials& materials,
                Palette& palette, MeshBuilder& mesh)
      : garage_(garage), style_(style), m_(materials), palette_(palette), mesh_(mesh) {}

  void add(const Pillar& pillar) {
    base_ = garage_.floorHeight(pillar.center);
    const double guard = std::min(style_.guard_height, pillar.height);
    const double low = style_.zone_text_center - 0.5 * style_.zone_text_height - kBandMargin;
    const double high = style_.zone_text_center + 0.5 * style_.zone_text_height + kBandMargin;
    const bool marked = !pillar.zone_text.empty();
    addGuard(pillar, guard);
    if (!marked) {
      section(pillar, guard, pillar.height, m_.body);
      return;
    }
    const Eigen::Vector3f zone = zoneColour(pillar);
    const Eigen::Vector3f back = style_.zone_band ? zone : style_.pillar_colour;
    const Eigen::Vector3f ink =
        style_.zone_band ? Eigen::Vector3f(Eigen::Vector3f::Constant(0.8F)) : zone;
    const double from = std::max(low, guard);
    if (from > guard) section(pillar, guard, from, m_.body);
    section(pillar, high, pillar.height, m_.body);
    const std::uint16_t plain = palette_.add("zone_band", SemanticClass::kZoneMarker, back, 0.45F);
    const std::uint16_t text = addText(pillar, high - from, from, back, ink);
    band(pillar, from, high, plain, text);
  }

 private:
  [[nodiscard]] Eigen::Vector3f zoneColour(const Pillar& pillar) const {
    // One colour per letter of the zone.
    for (const char c : pillar.zone_text) {
      if (c < 'A' || c > 'Z') continue;
      return style_.zone_colours[static_cast<std::size_t>(c - 'A') % style_.zone_colours.size()];
    }
    return style_.zone_colours.front();
  }

  std::uint16_t addText(const Pillar& pillar, double height, double from,
                        const Eigen::Vector3f& back, const Eigen::Vector3f& ink) {
    const Sign* sign = nullptr;
    for (const Sign& s : garage_.signs) {
      const Eigen::Vector2d p = s.T_world_sign.translation().head<2>();
      if (s.semantic_class == SemanticClass::kZoneMarker &&
          (p - pillar.center).norm() < pillar.size.x()) {
        sign = &s;
      }
    }
    if (sign == nullptr) return palette_.add("zone", SemanticClass::kZoneMarker, back, 0.45F);
    // The face's middle may lie off the text's where a guard cuts the band.
    const double face = zonePlateWidth(pillar);
    PlateStyle plate{back, ink, style_.text_weight};
    const double off = style_.zone_text_center - (from + 0.5 * height);
    const Texture texture = plateTexture(face, height, pillar.zone_text,
                                         sign->height - kZoneTextMargin, plate, 320.0, {0.0, off});
    return palette_.add("zone " + pillar.zone_text, SemanticClass::kZoneMarker,
                        Eigen::Vector3f::Ones(), 0.45F, 0.04F, palette_.addTexture(texture));
  }

  /// One face from z0 to z1 above the floor; face k looks along heading k * 90 degrees - 180.
  void face(const Pillar& pillar, int k, double z0, double z1, std::uint16_t material,
            const Eigen::Vector2f& repeats = Eigen::Vector2f::Ones()) {
    const double heading = k * M_PI_2;  // of the reader
    const Eigen::Vector2d normal(-std::cos(heading), -std::sin(heading));
    const Eigen::Vector2d right(-normal.y(), normal.x());
    const Eigen::Vector2d half = 0.5 * pillar.size;
    const Eigen::Vector2d middle = pillar.center + half.cwiseProduct(normal);
    const Eigen::Vector2d side = half.cwiseProduct(right);
    const auto foot = [&](const Eigen::Vector2d& p) {  // on the floor, also where it slopes
      return point3(p, z0 == 0.0 ? garage_.floorHeight(p) - 1e-3 : base_ + z0);
    };
    mesh_.quad(foot(middle - side), foot(middle + side), point3(middle + side, base_ + z1),
               point3(middle - side, base_ + z1), material, repeats);
  }

  void ring(const Pillar& pillar, double z0, double z1, std::uint16_t material) {
    const float radius = 0.5F * static_cast<float>(pillar.size.x());
    mesh_.cone(point3(pillar.center, base_ + z0), point3(pillar.center, base_ + z1), radius, radius,
               24, material, false);
  }

  void section(const Pillar& pillar, double z0, double z1, std::uint16_t material) {
    if (z1 - z0 < 1e-3) return;
    if (pillar.round) {
      ring(pillar, z0, z1, material);
      return;
    }
    const Eigen::Vector2f repeats(static_cast<float>(pillar.size.x() / 2.0),
                                  static_cast<float>((z1 - z0) / 2.0));
    for (int k = 0; k < 4; ++k) face(pillar, k, z0, z1, material, repeats);
  }

  void addGuard(const Pillar& pillar, double top) {
    if (top <= 0.0) return;
    constexpr double kRing = 0.18;
    if (pillar.round) {
      int i = 0;
      for (double z = 0.0; z < top; z += kRing, ++i) {
        ring(pillar, z, std::min(z + kRing, top), i % 2 == 0 ? m_.yellow : m_.black);
      }
      return;
    }
    if (style_.guard_diagonal) {
      const Eigen::Vector2f repeats(static_cast<float>(pillar.size.x() / 0.4),
                                    static_cast<float>(top / 0.4));
      for (int k = 0; k < 4; ++k) face(pillar, k, 0.0, top, m_.guard, repeats);
      return;
    }
    section(pillar, 0.0, top, m_.body);
    // Rubber strips with stripes around the edges.
    const Eigen::Vector2d half = 0.5 * pillar.size;
    for (const double x : {-1.0, 1.0}) {
      for (const double y : {-1.0, 1.0}) {
        const Eigen::Vector2d c = pillar.center + Eigen::Vector2d(x * half.x(), y * half.y());
        int i = 0;
        for (double z = 0.05; z < top; z += kRing, ++i) {
          const double end = std::min(z + kRing, top);
          mesh_.box(point3(c - Eigen::Vector2d(0.035 * x, 0.035 * y), base_ + 0.5 * (z + end)),
                    {0.05F, 0.05F, static_cast<float>(0.5 * (end - z))},
                    i % 2 == 0 ? m_.yellow : m_.black);
        }
      }
    }
  }

  void band(const Pillar& pillar, double z0, double z1, std::uint16_t plain, std::uint16_t text) {
    const auto has_text = [&](int k) { return style_.zone_faces != 2 || k % 2 == 1; };
    if (!pillar.round) {
      for (int k = 0; k < 4; ++k) face(pillar, k, z0, z1, has_text(k) ? text : plain);
      return;
    }
    ring(pillar, z0, z1, plain);
    // Flat plates before the curve.
    Pillar plate = pillar;
    plate.size = Eigen::Vector2d::Constant(zonePlateWidth(pillar));
    for (int k = 0; k < 4; ++k) {
      if (!has_text(k)) continue;
      const double heading = k * M_PI_2;
      const Eigen::Vector2d normal(-std::cos(heading), -std::sin(heading));
      const double behind = 0.5 * (pillar.size.x() - plate.size.x());
      plate.center = pillar.center + (behind + 0.025) * normal;
      face(plate, k, z0, z1, text);
    }
  }

  const Garage& garage_;
  const GarageStyle& style_;
  const PillarMaterials& m_;
  Palette& palette_;
  MeshBuilder& mesh_;
  double base_ = 0.0;
};

}  // namespace

void addPillars(const Garage& garage, const GarageStyle& style, Palette& palette,
                MeshBuilder& mesh) {
  const int stain =
      palette.addTexture(stainTexture(256, 0.25 + 0.4 * style.dirt, garage.seed + 31));
  const int stripes = palette.addTexture(stripeTexture(128));
  PillarMaterials m{};
  m.body = palette.add("pillar", SemanticClass::kPillar, style.pillar_colour / 0.86F, 0.7F, 0.04F,
                       stain);
  m.guard =
      palette.add("guard", SemanticClass::kPillar, Eigen::Vector3f::Ones(), 0.6F, 0.04F, stripes);
  m.black = palette.add("guard_black", SemanticClass::kPillar, Eigen::Vector3f::Constant(0.025F));
  m.yellow = palette.add("guard_yellow", SemanticClass::kPillar, {0.72F, 0.48F, 0.03F});
  PillarBuilder builder(garage, style, m, palette, mesh);
  for (const Pillar& pillar : garage.pillars) builder.add(pillar);
}

}  // namespace parkade::sim
