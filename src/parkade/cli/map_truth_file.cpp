// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/map_truth_file.hpp"

#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <utility>
#include <vector>

#include "parkade/cli/marking_box.hpp"
#include "parkade/eval/html_page.hpp"
#include "parkade/io/csv.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/image_file.hpp"
#include "parkade/io/trajectory_io.hpp"
#include "parkade/mapping/frame_evidence.hpp"
#include "parkade/sim/world/garage_json.hpp"
#include "parkade/sim/world/plan_image.hpp"

namespace parkade::cli {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

Polygon box(const Eigen::Vector2d& min, const Eigen::Vector2d& max) {
  return {min, {max.x(), min.y()}, max, {min.x(), max.y()}};
}

Polygon footOf(const sim::Pillar& pillar) {
  if (!pillar.round)
    return box(pillar.center - 0.5 * pillar.size, pillar.center + 0.5 * pillar.size);
  Polygon circle;
  for (int k = 0; k < 24; ++k) {
    const double angle = 2.0 * M_PI * k / 24.0;
    circle.push_back(pillar.center +
                     0.5 * pillar.size.x() * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return circle;
}

bool isText(const sim::Marking& marking) {
  return marking.semantic_class == SemanticClass::kPaintedNumber &&
         marking.meaning.rfind("accessible", 0) != 0;
}

// What lies within a metre outside the outer walls is wall to whoever sees them from inside; where
// one drives in and out there is none.
void addOuterWall(const sim::Garage& garage, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                  MapTruth& truth) {
  const double length = (b - a).norm();
  const Eigen::Vector2d along = (b - a) / length;
  const Eigen::Vector2d out(along.y(), -along.x());
  std::vector<std::pair<double, double>> openings = garage.openings(a, b);
  openings.emplace_back(length, length);
  double from = 0.0;
  for (const auto& [begin, end] : openings) {
    const Eigen::Vector2d left = a + from * along;
    const Eigen::Vector2d right = a + begin * along;
    truth.areas.push_back({SemanticClass::kWall, {left, right, right + out, left + out}});
    from = end;
  }
}

void addAreas(const sim::Garage& garage, MapTruth& truth) {
  for (const sim::Marking& marking : garage.markings) {
    for (const Polygon& polygon : marking.polygons) {
      truth.areas.push_back({marking.semantic_class, polygon});
    }
  }
  for (const sim::Pillar& pillar : garage.pillars) {
    truth.areas.push_back({SemanticClass::kPillar, footOf(pillar)});
  }
  for (const sim::Room& room : garage.rooms) {
    truth.areas.push_back({SemanticClass::kWall, box(room.min, room.max)});
  }
  for (std::size_t i = 0; i < garage.outline.size(); ++i) {
    addOuterWall(garage, garage.outline[i], garage.outline[(i + 1) % garage.outline.size()], truth);
  }
}

void addSigns(const sim::Garage& garage, MapTruth& truth) {
  std::vector<TruthObject> markers;  // one a pillar: its faces bear the same text
  for (const sim::Pillar& pillar : garage.pillars) {
    truth.objects.push_back(
        {SemanticClass::kPillar, {pillar.center.x(), pillar.center.y(), 0.0}, "", {}, 1});
    if (pillar.zone_text.empty()) continue;
    markers.push_back({SemanticClass::kZoneMarker,
                       {pillar.center.x(), pillar.center.y(), 0.0},
                       pillar.zone_text,
                       {},
                       0});
  }
  for (const sim::Sign& sign : garage.signs) {
    const Eigen::Vector3d& p = sign.T_world_sign.translation();
    const Eigen::Vector3d normal = sign.T_world_sign.rotation() * Eigen::Vector3d::UnitZ();
    TruthObject object{sign.semantic_class, p, sign.text, {normal.head<2>().normalized()}, 1};
    if (sign.semantic_class != SemanticClass::kZoneMarker) {
      truth.objects.push_back(object);
      continue;
    }
    TruthObject* nearest = nullptr;
    double distance = 1.0;
    for (TruthObject& marker : markers) {
      const double d = (marker.position - p).head<2>().norm();
      if (d >= distance || marker.text != sign.text) continue;
      distance = d;
      nearest = &marker;
    }
    if (nearest == nullptr) {
      truth.objects.push_back(object);  // on a wall
      continue;
    }
    nearest->faces.push_back(object.faces.front());
    nearest->position.z() = p.z();
    ++nearest->places;
  }
  for (const TruthObject& marker : markers) {
    if (marker.places > 0) truth.objects.push_back(marker);
  }
}

MapTruth truthOf(const sim::Garage& garage) {
  MapTruth truth;
  std::set<std::string> painted;
  for (const sim::Marking& marking : garage.markings) {
    if (isText(marking)) painted.insert(marking.meaning);
  }
  for (const sim::Slot& slot : garage.slots) {
    const bool numbered = painted.count(slot.number) > 0;
    truth.slots.push_back({slot.corners, numbered ? slot.number : "", slot.zone, slot.occupied});
  }
  addAreas(garage, truth);
  for (const sim::Marking& marking : garage.markings) {
    if (roleOf(marking.semantic_class) != LayerRole::kRoadMarker) continue;
    const bool has_text = marking.semantic_class == SemanticClass::kArrow ||
                          marking.semantic_class == SemanticClass::kSpeedLimitPaint ||
                          isText(marking);
    const auto add = [&](const std::vector<Polygon>& polygons) {
      const Eigen::Vector2d place = middleOf(marking, polygons);
      truth.objects.push_back({marking.semantic_class,
                               {place.x(), place.y(), 0.0},
                               has_text ? marking.meaning : "",
                               {},
                               1});
    };
    if (marking.semantic_class != SemanticClass::kWheelStop) {
      add(marking.polygons);
      continue;
    }
    for (const Polygon& one : marking.polygons) add({one});  // of a slot's pair, each
  }
  addSigns(garage, truth);
  return truth;
}

Result<std::vector<TruthVehicle>> readVehicles(const std::string& path) {
  return parseCsvFile<std::vector<TruthVehicle>>(
      path, CsvReader::Separator::kComma, [](CsvReader& csv) {
        std::vector<TruthVehicle> vehicles;
        while (csv.nextRow()) {
          csv.expectColumns({"timestamp", "id", "class", "x", "y", "z", "qw", "qx", "qy", "qz",
                             "length", "width", "height"});
          if (csv.text(2) != "vehicle") continue;
          vehicles.push_back(
              {csv.nanoseconds(0, "timestamp"), {csv.number(3, "x"), csv.number(4, "y")}});
        }
        return vehicles;
      });
}

}  // namespace

Result<MapTruth> readMapTruth(const std::string& sequence) {
  const std::string path = joinPath(sequence, "truth/garage.json");
  if (!std::filesystem::is_regular_file(path)) {
    return Error{fmt::format(
        "{}: no truth/garage.json: maps are judged against sequences that 'parkade sim' wrote",
        sequence)};
  }
  const Result<sim::Garage> garage = sim::readGarageTruth(path);
  if (!garage) return garage.error();
  MapTruth truth = truthOf(*garage);
  const Result<TrajectoryFile> driven = readReference(sequence);
  if (!driven) return driven.error();
  truth.driven = driven->poses;
  const std::string agents = joinPath(sequence, "truth/agents.csv");
  if (!std::filesystem::is_regular_file(agents)) return truth;
  Result<std::vector<TruthVehicle>> vehicles = readVehicles(agents);
  if (!vehicles) return vehicles.error();
  truth.vehicles = std::move(vehicles).value();
  return truth;
}

std::optional<GroundPicture> readPlanPicture(const std::string& sequence) {
  const Result<sim::Garage> garage = sim::readGarageTruth(joinPath(sequence, "truth/garage.json"));
  if (!garage) return std::nullopt;
  constexpr double kPxPerMetre = 10.0;
  constexpr double kMargin = 1.0;  // m, of drawPlan()
  const cv::Mat plan = sim::drawPlan(*garage, kPxPerMetre);
  ImageEncoding jpeg;
  jpeg.jpeg_quality = 80;
  const Result<std::string> bytes = encodeImage(plan, jpeg);
  if (!bytes) return std::nullopt;
  return GroundPicture{dataUri("image/jpeg", *bytes),
                       {garage->min.x() - kMargin, garage->max.y() + kMargin},
                       Eigen::Vector2d(plan.cols, plan.rows) / kPxPerMetre};
}

}  // namespace parkade::cli
