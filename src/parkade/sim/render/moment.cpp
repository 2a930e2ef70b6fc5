// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/render/moment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "parkade/core/check.hpp"
#include "parkade/sim/render/openness.hpp"

namespace parkade::sim {
namespace {

constexpr float kBeamWedge = 0.95F;  // rad: the lobe's half angle on the plan, with room for tilt

/// A cone from an eye.
struct SightCone {
  Eigen::Vector3f eye;
  Eigen::Vector3f axis;
  float cosine;  // of the half angle
  float sine;

  /// Whether a sphere may show; now and then true where it only nearly does.
  [[nodiscard]] bool meets(const Eigen::Vector3f& center, float radius) const {
    const Eigen::Vector3f d = center - eye;
    const float d2 = d.squaredNorm();
    if (d2 <= radius * radius || cosine < -0.99F) {
      return true;
    }
    // The half angle and the sphere's, added: cos(a + b) = cos a cos b - sin a sin b.
    const float distance = std::sqrt(d2);
    const float sphere_cosine = std::sqrt(d2 - radius * radius);  // times distance
    if (cosine < 0.0F && -cosine * distance >= sphere_cosine) {
      return true;  // together more than half a turn
    }
    return d.dot(axis) > cosine * sphere_cosine - sine * radius - 1e-4F * distance;
  }
};

/// Spheres around the cells of a half-metre grid that the mesh's triangles reach.
std::vector<Eigen::Vector4f> partsOf(const RenderMesh& mesh, const Eigen::Vector3f& low) {
  constexpr float kBallCell = 0.5F;
  std::set<std::array<int, 3>> cells;
  for (const RenderTriangle& t : mesh.triangles) {
    Eigen::Vector3f from = mesh.positions[t.v[0]];
    Eigen::Vector3f to = from;
    for (const std::uint32_t v : t.v) {
      from = from.cwiseMin(mesh.positions[v]);
      to = to.cwiseMax(mesh.positions[v]);
    }
    const Eigen::Array3i first = ((from - low) / kBallCell).array().floor().cast<int>();
    const Eigen::Array3i last = ((to - low) / kBallCell).array().floor().cast<int>();
    for (int x = first.x(); x <= last.x(); ++x) {
      for (int y = first.y(); y <= last.y(); ++y) {
        for (int z = first.z(); z <= last.z(); ++z) {
          cells.insert({x, y, z});
        }
      }
    }
  }
  std::vector<Eigen::Vector4f> parts;
  for (const auto& [x, y, z] : cells) {
    const Eigen::Vector3f center =
        low + kBallCell * (Eigen::Array3f(x, y, z).matrix() + Eigen::Vector3f::Constant(0.5F));
    parts.emplace_back(center.x(), center.y(), center.z(), 0.87F * kBallCell);
  }
  return parts;
}

}  // namespace

bool Moment::showsIn(const Eigen::Vector3f& eye, const Eigen::Vector3f& axis,
                     float half_angle) const {
  const SightCone world{eye, axis, std::cos(half_angle), std::sin(half_angle)};
  for (const PlacedObject& object : objects) {
    if (!world.meets(object.center_world, object.shape->radius)) {
      continue;
    }
    // In the object's frame, against its parts.
    const Eigen::Matrix3f R_object_world = object.R_world_object.transpose();
    const SightCone cone{R_object_world * (eye - object.p_world), R_object_world * axis,
                         world.cosine, world.sine};
    const auto& parts = object.shape->parts;
    if (std::any_of(parts.begin(), parts.end(), [&](const Eigen::Vector4f& part) {
          return cone.meets(part.head<3>(), part.w());
        })) {
      return true;
    }
  }
  return false;
}

void Moment::floorShares(const float* x, const float* y, float* share) const {
  std::fill_n(share, kLightLanes, 1.0F);
  const auto [left, right] = std::minmax_element(x, x + kLightLanes);
  const auto [low, high] = std::minmax_element(y, y + kLightLanes);
  for (const PlacedObject& object : objects) {
    const FloorShadow& shadow = object.shadow;
    const float dx = std::max({*left - shadow.x, shadow.x - *right, 0.0F});
    const float dy = std::max({*low - shadow.y, shadow.y - *high, 0.0F});
    if (dx * dx + dy * dy <= shadow.reach2) {
      castShadow(shadow, x, y, share);
    }
  }
}

void Moment::beamLux(unsigned reach, const LightPoints& points, float* lux) const {
  std::fill_n(lux, kLightLanes, 0.0F);
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if ((reach & ReachGrid::bitOf(i)) != 0) {
      addBeam(beams[i], points, lux);
    }
  }
}

MomentMaker::MomentMaker(const Scene& scene, RTCDevice device, const BakedLight& light,
                         const SubdivisionLimits& limits)
    : scene_(scene), device_(device), light_(light), limits_(limits) {}

std::shared_ptr<const ObjectMesh> MomentMaker::shapeOf(int mesh) const {
  const std::lock_guard lock(mutex_);
  auto& known = shapes_[mesh];
  if (known != nullptr) {
    return known;
  }
  PARKADE_CHECK(mesh >= 0 && mesh < static_cast<int>(scene_.meshes.size()), "mesh {} of {}", mesh,
                scene_.meshes.size());
  auto shape = std::make_shared<ObjectMesh>();
  shape->mesh = prepareMesh(scene_.meshes[static_cast<std::size_t>(mesh)], scene_, limits_);
  PARKADE_CHECK(!shape->mesh.triangles.empty(), "mesh {} is empty", mesh);
  shape->mesh.positions.reserve(shape->mesh.positions.size() + 1);
  shape->box_min.setConstant(std::numeric_limits<float>::max());
  shape->box_max = -shape->box_min;
  for (const Eigen::Vector3f& p : shape->mesh.positions) {
    shape->box_min = shape->box_min.cwiseMin(p);
    shape->box_max = shape->box_max.cwiseMax(p);
  }
  shape->center = 0.5F * (shape->box_min + shape->box_max);
  shape->radius = 0.5F * (shape->box_max - shape->box_min).norm();
  shape->parts = partsOf(shape->mesh, shape->box_min);
  shape->scene.reset(rtcNewScene(device_));
  attachTriangles(device_, shape->scene.get(), shape->mesh, 0,
                  static_cast<std::uint32_t>(shape->mesh.triangles.size()), kMaskAll);
  rtcCommitScene(shape->scene.get());
  shape->mesh.openness = opennessOf(shape->mesh, shape->scene.get());
  known = std::move(shape);
  return known;
}

void MomentMaker::place(Moment& moment, int mesh, const SE3& T_world_object, std::uint32_t instance,
                        SemanticClass label) const {
  PlacedObject object;
  object.shape = shapeOf(mesh);
  const ObjectMesh& shape = *object.shape;
  object.R_world_object = T_world_object.rotation().matrix().cast<float>();
  object.p_world = T_world_object.translation().cast<float>();
  object.center_world = object.R_world_object * shape.center + object.p_world;
  object.instance = instance;
  object.label = label;
  object.vertex_lux.reserve(shape.mesh.positions.size());
  for (std::size_t i = 0; i < shape.mesh.positions.size(); ++i) {
    const Eigen::Vector3f p = object.R_world_object * shape.mesh.positions[i] + object.p_world;
    const Eigen::Vector3f n = object.R_world_object * shape.mesh.normals[i];
    object.vertex_lux.push_back(ProbeGrid::evaluate(light_.probes.cubeAt(p), n) *
                                shape.mesh.openness[i]);
  }
  const Eigen::Vector2f along = object.R_world_object.col(0).head<2>();
  const Eigen::Vector2f axis = along.norm() > 1e-3F ? Eigen::Vector2f(along.normalized())
                                                    : Eigen::Vector2f(Eigen::Vector2f::UnitX());
  const Eigen::Vector3f half = 0.5F * (shape.box_max - shape.box_min);
  // Round corners and the bumpers' ground clearance make the shadow a little smaller than the box.
  const Eigen::Vector2f sides = (half.head<2>().array() - 0.08F).max(0.1F);
  const float height = std::min(half.z(), 0.8F);
  object.shadow = {object.center_world.x(),
                   object.center_world.y(),
                   axis.x(),
                   axis.y(),
                   sides.x(),
                   sides.y(),
                   height,
                   (sides.array() + height).matrix().squaredNorm()};
  moment.objects.push_back(std::move(object));
}

void MomentMaker::markReach(Moment& moment) const {
  const FloorGrid& floor = light_.floor_grid;
  ReachGrid& grid = moment.reach_grid;
  grid.min = floor.min;
  grid.nx = static_cast<int>(static_cast<float>(floor.nx) * floor.cell / ReachGrid::kCell) + 1;
  grid.ny = static_cast<int>(static_cast<float>(floor.ny) * floor.cell / ReachGrid::kCell) + 1;
  grid.cells.assign(static_cast<std::size_t>(grid.nx) * grid.ny, 0);
  constexpr float kRadius = 0.75F * ReachGrid::kCell;  // of a circle around a cell
  for (int y = 0; y < grid.ny; ++y) {
    for (int x = 0; x < grid.nx; ++x) {
      std::uint8_t& cell = grid.cells[static_cast<std::size_t>(y) * grid.nx + x];
      const Eigen::Vector2f center =
          grid.min + ReachGrid::kCell * Eigen::Vector2f(x + 0.5F, y + 0.5F);
      for (std::size_t i = 0; i < moment.beams.size(); ++i) {
        const BeamLight& beam = moment.beams[i];
        const Eigen::Vector2f d = center - Eigen::Vector2f(beam.x, beam.y);
        const Eigen::Vector2f ahead(beam.ahead_x, beam.ahead_y);
        const float distance = d.norm();
        if (distance > kBeamReach + kRadius) {
          continue;
        }
        const float wide = kBeamWedge + std::asin(std::min(1.0F, kRadius / distance));
        if (distance < 2.0F * kRadius || d.dot(ahead.normalized()) > distance * std::cos(wide)) {
          cell |= ReachGrid::bitOf(i);
        }
      }
      for (const PlacedObject& object : moment.objects) {
        const FloorShadow& shadow = object.shadow;
        const float far = std::sqrt(shadow.reach2) + kRadius;
        if ((center - Eigen::Vector2f(shadow.x, shadow.y)).squaredNorm() <= far * far) {
          cell |= ReachGrid::kShadow;
        }
      }
    }
  }
}

std::shared_ptr<const Moment> MomentMaker::make(double t,
                                                const std::optional<SE3>& T_world_vehicle) const {
  auto moment = std::make_shared<Moment>();
  moment->t = t;
  for (const MovingObject& object : scene_.moving) {
    const SE3 T_world_object = object.pose(t);
    place(*moment, object.mesh(t), T_world_object, object.instance, object.label);
    if (object.head_lamps) {
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d lamp(0.5 * object.box_size.x(), side * 0.36 * object.box_size.y(),
                                   0.43 * object.box_size.z());
        const Eigen::Vector3d forward(1.0, 0.0, -0.05);
        const Eigen::Vector3f p = (T_world_object * lamp).cast<float>();
        const Eigen::Vector3f ahead =
            (T_world_object.rotation() * forward.normalized()).cast<float>();
        moment->beams.push_back({p.x(), p.y(), p.z(), ahead.x(), ahead.y(), ahead.z()});
      }
    }
  }
  if (T_world_vehicle.has_value() && scene_.ego_mesh >= 0) {
    place(*moment, scene_.ego_mesh, *T_world_vehicle, kEgoInstance, SemanticClass::kVehicle);
  }
  if (!moment->objects.empty()) {
    moment->scene.reset(rtcNewScene(device_));
    for (const PlacedObject& object : moment->objects) {
      RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, object.shape->scene.get());
      float columns[12];
      Eigen::Map<Eigen::Matrix3f>{columns} = object.R_world_object;
      Eigen::Map<Eigen::Vector3f>{columns + 9} = object.p_world;
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
      rtcSetGeometryMask(instance, object.instance == kEgoInstance ? kMaskOwnCar : kMaskMoving);
      rtcCommitGeometry(instance);
      rtcAttachGeometry(moment->scene.get(), instance);
      rtcReleaseGeometry(instance);
    }
    rtcCommitScene(moment->scene.get());
  }
  markReach(*moment);
  for (const Luminaire& lamp : scene_.luminaires) {
    if (lamp.flicker_depth > 0.0F && moment->lamp_brightness.empty()) {
      moment->lamp_brightness.assign(scene_.luminaires.size(), 1.0F);
    }
  }
  for (std::size_t i = 0; i < moment->lamp_brightness.size(); ++i) {
    const Luminaire& lamp = scene_.luminaires[i];
    const double wave = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * lamp.flicker_hz * t);
    moment->lamp_brightness[i] = 1.0F - lamp.flicker_depth * static_cast<float>(wave);
  }
  return moment;
}

}  // namespace parkade::sim
