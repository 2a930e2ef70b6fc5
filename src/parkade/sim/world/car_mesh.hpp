// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "parkade/camera/rig.hpp"
#include "parkade/sim/scene.hpp"

namespace parkade::sim {

enum class CarBody : std::uint8_t { kSedan, kHatchback, kEstate, kSuv, kVan, kSmall };

inline constexpr std::array<CarBody, 6> kCarBodies = {CarBody::kSedan,  CarBody::kHatchback,
                                                      CarBody::kEstate, CarBody::kSuv,
                                                      CarBody::kVan,    CarBody::kSmall};

/// Outer size of a body, m.
struct CarSize {
  double length = 4.6;
  double width = 1.84;
  double height = 1.45;
};

/// What such cars measure in the mean.
CarSize typicalSize(CarBody body);

/// Indices into Scene::materials of what a car is made of. Only the paint differs between cars.
struct CarMaterials {
  std::uint16_t paint = 0;
  std::uint16_t glass = 0;
  std::uint16_t trim = 0;  ///< black plastic, arches, grille
  std::uint16_t tyre = 0;
  std::uint16_t rim = 0;
  std::uint16_t head_lamp = 0;
  std::uint16_t tail_lamp = 0;
  std::uint16_t plate = 0;
};

/// Adds all materials of cars but the paint, labelled vehicle; the paint's index is left at 0.
CarMaterials addCarMaterials(Scene& scene);
/// Adds a paint, labelled vehicle; its index.
std::uint16_t addCarPaint(Scene& scene, const Eigen::Vector3f& colour, bool metallic);

/// A car of about 3,500 triangles: body with hood, cabin and tail lofted over cross-sections,
/// windows, lamps, plates, mirrors, wheels in dark arches. x forward, y left, z up; the origin lies
/// on the ground below the middle of its box.
Mesh makeCarMesh(CarBody body, const CarSize& size, const CarMaterials& materials);

/// The own car's body in the vehicle frame (origin below the rear axle's centre): a sedan of the
/// shape's size.
Mesh egoCarMesh(const VehicleShape& shape, const CarMaterials& materials);

}  // namespace parkade::sim
