// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/map_report.hpp"
#include "parkade/core/json_text.hpp"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

namespace parkade {
namespace {

using Json = nlohmann::ordered_json;

Json figuresJson(const Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median},
          {"p95", s.p95},   {"max", s.max},   {"count", s.count}};
}

Json slotsJson(const SlotScore& s) {
  return {
      {"passed", s.passed},
      {"found", s.found},
      {"told", s.told},
      {"wrong", s.wrong},
      {"duplicates", s.duplicates},
      {"recall", s.recall},
      {"in_sight", s.in_sight},
      {"found_in_sight", s.found_in_sight},
      {"recall_in_sight", s.recall_in_sight},
      {"precision", s.precision},
      {"entrance_error_m", figuresJson(s.entrance_error)},
      {"corner_error_m", figuresJson(s.corner_error)},
      {"fitted_entrance_error_m", figuresJson(s.fitted_entrance_error)},
      {"availability",
       {{"accuracy", s.availability},
        {"right", s.availability_right},
        {"open", s.availability_open}}},
      {"numbers", {{"count", s.numbers}, {"right", s.numbers_right}, {"wrong", s.numbers_wrong}}},
      {"zones", {{"count", s.zones}, {"right", s.zones_right}}}};
}

Json objectJson(const ObjectScore& s) {
  return {{"passed", s.passed},
          {"found", s.found},
          {"told", s.told},
          {"wrong", s.wrong},
          {"recall", s.recall()},
          {"precision", s.precision()},
          {"position_error_m", figuresJson(s.position_error)},
          {"texts", {{"count", s.texts}, {"right", s.texts_right}}}};
}

Json layerJson(const LayerScore& s) {
  return {{"iou", s.iou},
          {"tolerant_iou", s.tolerant_iou},
          {"tolerant_precision", s.tolerant_precision},
          {"tolerant_recall", s.tolerant_recall},
          {"present_cells", s.present},
          {"truth_cells", s.truth},
          {"seen", s.seen}};
}

Json loopsJson(const LoopScore& s) {
  return {{"told", s.told},
          {"wrong", s.wrong},
          {"error_m", figuresJson(s.error)},
          {"turn_deg", figuresJson(s.turn)}};
}

std::string share(int part, int whole) {
  return whole > 0 ? fmt::format("{:.3f} ({} of {})", 1.0 * part / whole, part, whole) : "-";
}

std::string errors(const char* name, const Statistics& s) {
  if (s.count == 0) return fmt::format("  {:<26} -\n", name);
  return fmt::format("  {:<26} median {:.3f}  p95 {:.3f}  max {:.3f} m\n", name, s.median, s.p95,
                     s.max);
}

std::string slotsText(const MapEvaluation& e) {
  const SlotScore& s = e.slots;
  std::string text = fmt::format("slots passed within {:g} m\n", e.options.passed_within_m);
  text += fmt::format("  {:<26} {}\n", "recall", share(s.found, s.passed));
  text += fmt::format("  {:<26} {}\n", "recall, entrance in sight",
                      share(s.found_in_sight, s.in_sight));
  text += fmt::format("  {:<26} {}\n", "precision", share(s.told - s.wrong, s.told));
  text += fmt::format("  {:<26} {}\n", "duplicates", s.duplicates);
  text += errors("entrance corners", s.entrance_error);
  text += errors("all corners", s.corner_error);
  text += errors("entrance, best fit", s.fitted_entrance_error);
  text += fmt::format("  {:<26} {}, {} open\n", "availability",
                      share(s.availability_right, s.found), s.availability_open);
  text += fmt::format("  {:<26} {}, {} wrong\n", "painted number",
                      share(s.numbers_right, s.numbers), s.numbers_wrong);
  text += fmt::format("  {:<26} {}\n", "zone", share(s.zones_right, s.zones));
  return text;
}

}  // namespace

std::string mapEvaluationJson(const MapEvaluation& e) {
  Json json;
  json["slots"] = slotsJson(e.slots);
  json["objects"] = Json::object();
  for (const auto& [semantic_class, score] : e.objects) {
    json["objects"][std::string(kSemanticClassNames[static_cast<std::size_t>(semantic_class)])] =
        objectJson(score);
  }
  json["layers"] = Json::object();
  for (const auto& [layer, score] : e.layers) {
    json["layers"][std::string(kGridLayerNames[static_cast<std::size_t>(layer)])] =
        layerJson(score);
  }
  json["loops"] = loopsJson(e.loops);
  const Eigen::Vector2d& t = e.T_truth_map.translation();
  json["T_truth_map"] = {{"x", t.x()}, {"y", t.y()}, {"angle", e.T_truth_map.angle()}};
  json["passed_within_m"] = e.options.passed_within_m;
  return jsonText(json);
}

std::string mapEvaluationTable(const MapEvaluation& e) {
  std::string text = slotsText(e);
  text += fmt::format("\n{:<18}{:>8}{:>8}{:>8}{:>8}{:>10}{:>10}{:>14}\n", "objects", "passed",
                      "found", "told", "wrong", "median m", "p95 m", "text right");
  for (const auto& [semantic_class, s] : e.objects) {
    const bool any = s.position_error.count > 0;
    text += fmt::format("{:<18}{:>8}{:>8}{:>8}{:>8}{:>10}{:>10}{:>14}\n",
                        kSemanticClassNames[static_cast<std::size_t>(semantic_class)], s.passed,
                        s.found, s.told, s.wrong,
                        any ? fmt::format("{:.3f}", s.position_error.median) : "-",
                        any ? fmt::format("{:.3f}", s.position_error.p95) : "-",
                        s.texts > 0 ? fmt::format("{} of {}", s.texts_right, s.texts) : "-");
  }
  text += fmt::format("\n{:<18}{:>8}{:>14}{:>12}{:>12}{:>8}\n", "layers", "IoU", "within a cell",
                      "precision", "recall", "seen");
  for (const auto& [layer, s] : e.layers) {
    text += fmt::format("{:<18}{:>8.3f}{:>14.3f}{:>12.3f}{:>12.3f}{:>8.3f}\n",
                        kGridLayerNames[static_cast<std::size_t>(layer)], s.iou, s.tolerant_iou,
                        s.tolerant_precision, s.tolerant_recall, s.seen);
  }
  text += fmt::format("\n{:<18}{} told, {} wrong\n", "loop closures", e.loops.told, e.loops.wrong);
  text += errors("place", e.loops.error);
  return text;
}

}  // namespace parkade
