// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/car_hull.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace parkade::sim {
namespace {

std::uint16_t bodyMaterial(const CarProfile& profile, const CarMaterials& m, float s, int step) {
  const bool side_glass = step >= kBeltPoint && step < kEdgePoint;
  const bool on_top = step >= kEdgePoint;
  if (step < 2) return m.trim;
  if (on_top && step < kSidePoints - 1) {
    if (s > profile.screen_low && s < profile.screen_high) return m.glass;
    if (s > profile.rear_high && s < profile.rear_low) return m.glass;
  }
  if (side_glass && s > profile.screen_low + 0.05F && s < profile.side_end &&
      step > kBeltPoint - 1) {
    constexpr float kPillar = 0.012F;
    const bool pillar =
        std::abs(s - profile.pillar_b) < kPillar || std::abs(s - profile.pillar_c) < kPillar;
    return pillar ? m.trim : m.glass;
  }
  return m.paint;
}

// Shares of the length where cross-sections stand: closer together at both ends and at the edges of
// the windows, so that materials change there.
std::vector<float> stations(const CarProfile& profile) {
  std::vector<float> shares = {0.0F,  0.01F, 0.02F, 0.04F, 0.06F, 0.10F, 0.15F,
                               0.20F, 0.90F, 0.94F, 0.96F, 0.98F, 0.99F, 1.0F};
  for (int i = 1; i < 20; ++i) shares.push_back(0.2F + 0.7F * static_cast<float>(i) / 20.0F);
  for (const float edge : {profile.screen_low, profile.screen_low + 0.05F, profile.screen_high,
                           profile.rear_high, profile.rear_low, profile.side_end}) {
    shares.push_back(edge);
  }
  for (const float pillar : {profile.pillar_b, profile.pillar_c}) {
    shares.push_back(pillar - 0.012F);
    shares.push_back(pillar + 0.012F);
  }
  std::sort(shares.begin(), shares.end());
  std::vector<float> kept;
  for (const float s : shares) {
    if (kept.empty() || s - kept.back() > 0.004F) kept.push_back(s);
  }
  return kept;
}

}  // namespace

std::array<Eigen::Vector2f, kSidePoints> crossSection(const CarProfile& profile,
                                                      const CarSize& size, float s) {
  const auto height = static_cast<float>(size.height);
  const float half = 0.5F * static_cast<float>(size.width);
  // The nose and the tail are rounded as seen from above.
  const float nose = std::clamp(s / 0.10F, 0.0F, 1.0F);
  const float tail = std::clamp((1.0F - s) / 0.08F, 0.0F, 1.0F);
  const auto rounded = [](float x, float least) {
    return least + (1.0F - least) * std::sqrt(std::max(0.0F, 1.0F - (1.0F - x) * (1.0F - x)));
  };
  const float w = half * rounded(nose, 0.72F) * rounded(tail, 0.82F);
  const float top = height * profile.top(s);
  const float belt = std::min(height * profile.belt(s), top - 0.03F);
  const float ends = std::min(nose, tail);
  const float bottom = 0.20F + 0.06F * (1.0F - ends);
  const float cabin = std::clamp((top - belt - 0.08F) / (0.25F * height), 0.0F, 1.0F);
  // Outline corners; the roof's edge leans in where there is a cabin.
  const float edge = w * (0.86F - 0.10F * cabin);
  const float edge_z = top - 0.035F - 0.03F * cabin;
  const std::array<Eigen::Vector2f, 8> corner = {
      Eigen::Vector2f(0.0F, bottom),
      Eigen::Vector2f(0.86F * w, bottom),
      Eigen::Vector2f(0.965F * w, bottom + 0.10F),
      Eigen::Vector2f(w, 0.5F * (bottom + belt)),
      Eigen::Vector2f(0.985F * w, belt - 0.05F),
      Eigen::Vector2f(0.955F * w, belt),
      Eigen::Vector2f(edge, std::max(edge_z, belt + 0.01F)),
      Eigen::Vector2f(0.0F, top)};
  constexpr std::array<int, 7> kSteps = {1, 1, 3, 2, 1, 4, 4};
  std::array<Eigen::Vector2f, kSidePoints> points;
  std::size_t at = 0;
  points[at++] = corner[0];
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    for (int k = 1; k <= kSteps[i]; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(kSteps[i]);
      Eigen::Vector2f p = corner[i] + t * (corner[i + 1] - corner[i]);
      if (i == 6) p.y() = edge_z + (top - edge_z) * std::sin(1.5708F * t);  // a crowned roof
      points[at++] = p;
    }
  }
  return points;
}

void addHull(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
             const CarMaterials& materials) {
  const auto length = static_cast<float>(size.length);
  const std::vector<float> shares = stations(profile);
  const auto place = [&](float s, const Eigen::Vector2f& p, float side) {
    return Eigen::Vector3f(length * (0.5F - s), side * p.x(), p.y());
  };
  for (std::size_t i = 0; i + 1 < shares.size(); ++i) {
    const auto front = crossSection(profile, size, shares[i]);
    const auto rear = crossSection(profile, size, shares[i + 1]);
    const float middle = 0.5F * (shares[i] + shares[i + 1]);
    for (int k = 0; k + 1 < kSidePoints; ++k) {
      const std::uint16_t material = bodyMaterial(profile, materials, middle, k);
      const auto a = static_cast<std::size_t>(k);
      const auto b = a + 1;
      builder.quad(place(shares[i], front[b], 1), place(shares[i], front[a], 1),
                   place(shares[i + 1], rear[a], 1), place(shares[i + 1], rear[b], 1), material);
      builder.quad(place(shares[i], front[a], -1), place(shares[i], front[b], -1),
                   place(shares[i + 1], rear[b], -1), place(shares[i + 1], rear[a], -1), material);
    }
  }
}

void addEnd(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
            const CarMaterials& materials, bool nose) {
  const float s = nose ? 0.0F : 1.0F;
  const auto section = crossSection(profile, size, s);
  const float x = static_cast<float>(size.length) * (0.5F - s);
  const float low = section[0].y();
  const float high = section[kSidePoints - 1].y();
  constexpr int kColumns = 10;
  for (std::size_t k = 1; k + 1 < kSidePoints; ++k) {
    const Eigen::Vector2f& a = section[k];
    const Eigen::Vector2f& b = section[k + 1];
    const float level = (0.5F * (a.y() + b.y()) - low) / (high - low);
    for (int c = 0; c < kColumns; ++c) {
      const float u0 = -1.0F + 2.0F * static_cast<float>(c) / kColumns;
      const float u1 = -1.0F + 2.0F * static_cast<float>(c + 1) / kColumns;
      const float across = std::abs(0.5F * (u0 + u1));
      std::uint16_t material = materials.paint;
      if (level < 0.25F || (nose && across < 0.62F && level < 0.62F)) material = materials.trim;
      if (across > 0.60F && level > 0.55F) {
        material = nose ? materials.head_lamp : materials.tail_lamp;
      }
      const Eigen::Vector3f p00(x, u0 * a.x(), a.y());
      const Eigen::Vector3f p10(x, u1 * a.x(), a.y());
      const Eigen::Vector3f p11(x, u1 * b.x(), b.y());
      const Eigen::Vector3f p01(x, u0 * b.x(), b.y());
      if (nose) {
        builder.quad(p00, p10, p11, p01, material);
      } else {
        builder.quad(p10, p00, p01, p11, material);
      }
    }
  }
}

}  // namespace parkade::sim
