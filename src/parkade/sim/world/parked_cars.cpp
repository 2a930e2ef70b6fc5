// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/world/parked_cars.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace parkade::sim {
namespace {

constexpr int kMaxVariants = 36;  // different cars; more slots repeat them

struct Variant {
  int mesh = 0;
  CarSize size;
};

Variant addVariant(const CarMaterials& materials, Random random, Scene& scene) {
  const CarBody body = drawCarBody(random);
  Variant variant;
  variant.size = typicalSize(body);
  variant.size.length *= random.uniform(0.96, 1.04);
  variant.size.width *= random.uniform(0.98, 1.02);
  variant.size.height *= random.uniform(0.97, 1.04);
  const CarPaint paint = drawCarPaint(random);
  CarMaterials own = materials;
  own.paint = addCarPaint(scene, paint.colour, paint.metallic);
  variant.mesh = static_cast<int>(scene.meshes.size());
  scene.meshes.push_back(makeCarMesh(body, variant.size, own));
  return variant;
}

}  // namespace

CarPaint drawCarPaint(Random& random) {
  struct Choice {
    double share;
    Eigen::Vector3f colour;
    bool metallic;
  };
  static const std::array<Choice, 11> choices = {{
      {0.28, {0.74F, 0.74F, 0.72F}, false},    // white
      {0.19, {0.012F, 0.012F, 0.014F}, true},  // black
      {0.18, {0.11F, 0.115F, 0.12F}, true},    // grey
      {0.13, {0.42F, 0.43F, 0.44F}, true},     // silver
      {0.07, {0.02F, 0.05F, 0.18F}, true},     // blue
      {0.03, {0.06F, 0.20F, 0.42F}, false},    // light blue
      {0.05, {0.36F, 0.02F, 0.02F}, false},    // red
      {0.02, {0.05F, 0.10F, 0.05F}, true},     // green
      {0.02, {0.20F, 0.13F, 0.08F}, true},     // brown
      {0.02, {0.55F, 0.30F, 0.03F}, false},    // orange
      {0.01, {0.60F, 0.50F, 0.06F}, false},    // yellow
  }};
  double u = random.uniform();
  for (const Choice& choice : choices) {
    if (u < choice.share) {
      return {choice.colour * static_cast<float>(random.uniform(0.85, 1.12)), choice.metallic};
    }
    u -= choice.share;
  }
  return {choices[0].colour, choices[0].metallic};
}

CarBody drawCarBody(Random& random) {
  const double u = random.uniform();
  if (u < 0.30) return CarBody::kSuv;
  if (u < 0.55) return CarBody::kSedan;
  if (u < 0.75) return CarBody::kHatchback;
  if (u < 0.86) return CarBody::kSmall;
  if (u < 0.94) return CarBody::kEstate;
  return CarBody::kVan;
}

SE3 poseOnFloor(const Garage& garage, const Eigen::Vector2d& p, double heading) {
  constexpr double kStep = 0.5;
  const Eigen::Vector2d along(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-along.y(), along.x());
  const auto slope = [&](const Eigen::Vector2d& d) {
    return (garage.floorHeight(p + kStep * d) - garage.floorHeight(p - kStep * d)) / (2.0 * kStep);
  };
  const SO3 rotation =
      SO3::fromYawPitchRoll(heading, -std::atan(slope(along)), std::atan(slope(left)));
  return {rotation, {p.x(), p.y(), garage.floorHeight(p)}};
}

void addParkedCars(const Garage& garage, const CarMaterials& materials, Random random,
                   Scene& scene) {
  std::vector<Variant> variants;
  const auto occupied = std::count_if(garage.slots.begin(), garage.slots.end(),
                                      [](const Slot& slot) { return slot.occupied; });
  const auto count = std::min<std::ptrdiff_t>(occupied, kMaxVariants);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    variants.push_back(
        addVariant(materials, random.fork("variant", static_cast<std::uint64_t>(i)), scene));
  }
  for (const Slot& slot : garage.slots) {
    if (!slot.occupied) continue;
    Random own = random.fork("slot", static_cast<std::uint64_t>(slot.id));
    const auto& c = slot.corners;
    const bool parallel = slot.type == SlotType::kParallel;
    const Eigen::Vector2d front = 0.5 * (c[0] + c[1]);
    const Eigen::Vector2d rear = 0.5 * (c[2] + c[3]);
    const Eigen::Vector2d axis =
        parallel ? Eigen::Vector2d(c[1] - c[0]) : Eigen::Vector2d(rear - front);
    const double length = axis.norm();
    // Clear width across the car's axis; a slanted slot's entrance is wider than the slot.
    const Eigen::Vector2d across =
        parallel ? Eigen::Vector2d(rear - front) : Eigen::Vector2d(c[1] - c[0]);
    const double width = std::abs(axis.x() * across.y() - axis.y() * across.x()) / length;
    // Long cars do not park in short slots.
    const Variant* variant = nullptr;
    for (int attempt = 0; attempt < 12; ++attempt) {
      const Variant& candidate = own.pick(variants);
      if (variant == nullptr || candidate.size.length < variant->size.length) variant = &candidate;
      if (variant->size.length < length - 0.25 && variant->size.width < width - 0.35) break;
    }
    const double spare_length = std::max(0.0, 0.5 * (length - variant->size.length) - 0.05);
    const double spare_width = std::max(0.0, 0.5 * (width - variant->size.width) - 0.15);
    const double along = std::clamp(own.normal(0.05, 0.12), -spare_length, spare_length);
    const double sideways = std::clamp(own.normal(0.0, 0.09), -spare_width, spare_width);
    const Eigen::Vector2d unit = axis / length;
    const Eigen::Vector2d middle =
        0.5 * (front + rear) + along * unit + sideways * Eigen::Vector2d(-unit.y(), unit.x());
    const bool nose_in = parallel ? own.chance(0.85) : own.chance(0.62);
    const double heading = std::atan2(unit.y(), unit.x()) + (nose_in ? 0.0 : M_PI) +
                           std::clamp(own.normal(0.0, 0.015), -0.035, 0.035);
    scene.objects.push_back({variant->mesh, poseOnFloor(garage, middle, heading),
                             kParkedInstance + static_cast<std::uint32_t>(slot.id)});
  }
}

}  // namespace parkade::sim
