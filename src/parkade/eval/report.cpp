// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/report.hpp"
#include "parkade/core/json_text.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace parkade {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"p95", s.p95},
          {"max", s.max},   {"min", s.min},   {"std", s.std},       {"count", s.count}};
}

Json toJson(const Alignment& alignment, const std::string& method) {
  const Eigen::Quaterniond& q = alignment.T_target_source.rotation().quaternion();
  const Eigen::Vector3d& t = alignment.T_target_source.translation();
  return {{"method", method},
          {"translation", {t.x(), t.y(), t.z()}},
          {"quaternion_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"scale", alignment.scale},
          {"degeneracy", toString(alignment.degeneracy)}};
}

std::string row(const char* name, const Statistics& s, const std::string& remark = "") {
  if (s.count == 0) return fmt::format("{:<19} {:>10}{}\n", name, "-", remark);
  return fmt::format("{:<19} {:>10.6f} {:>10.6f} {:>10.6f} {:>10.6f} {:>10.6f} {:>10.6f}{}\n", name,
                     s.rmse, s.mean, s.median, s.std, s.p95, s.max, remark);
}

std::string deltaText(const RpeOptions& rpe) {
  return fmt::format("{:g} {}", rpe.delta, rpe.unit == "f" ? "frames" : rpe.unit);
}

std::string alignmentText(const Evaluation& e) {
  std::string text = e.options.align;
  if (e.options.align == "sim3") text += fmt::format(", scale {:.6f}", e.alignment.scale);
  if (e.alignment.degenerate()) {
    text += fmt::format(" (open: {})", toString(e.alignment.degeneracy));
  }
  return text;
}

std::string matchingText(const Evaluation& e, const EvaluationLabels& labels) {
  if (labels.by_index) return "by index";
  if (e.options.association.interpolate) return "reference interpolated";
  return fmt::format("nearest stamp, {:.2f} ms apart on average", 1e3 * e.pairs.mean_difference_s);
}

}  // namespace

std::string evaluationJson(const Evaluation& e, const EvaluationLabels& labels) {
  Json json = {{"ape", toJson(e.ape)},
               {"ape_rotation_deg", toJson(e.ape_rotation_deg)},
               {"rpe", toJson(e.rpe)},
               {"drift_percent", e.drift.percent},
               {"matched", e.pairs.size()},
               {"coverage", e.pairs.coverage},
               {"ape_heading_deg", toJson(e.ape_heading_deg)},
               {"rpe_rotation_deg", toJson(e.rpe_rotation_deg)},
               {"rpe_pairs",
                {{"delta", e.options.rpe.delta},
                 {"unit", e.options.rpe.unit},
                 {"all_pairs", e.options.rpe.all_pairs}}},
               {"drift",
                {{"percent", e.drift.percent},
                 {"deg_per_m", e.drift.deg_per_m},
                 {"step_m", e.drift.step_m},
                 {"segments", e.drift.segments},
                 {"end_m", e.drift.end_m},
                 {"end_percent", e.drift.end_percent}}},
               {"final_error_m", e.final_error},
               {"alignment", toJson(e.alignment, e.options.align)},
               {"association",
                {{"tolerance_s", e.options.association.tolerance_s},
                 {"offset_s", e.options.association.offset_s},
                 {"interpolate", e.options.association.interpolate},
                 {"by_index", labels.by_index},
                 {"mean_difference_s", e.pairs.mean_difference_s}}},
               {"estimate", {{"name", labels.estimate}, {"poses", e.pairs.estimate_poses}}},
               {"reference", {{"name", labels.reference}, {"poses", e.pairs.reference_poses}}},
               {"path_m", e.path_length},
               {"duration_s", labels.by_index ? Json() : Json(e.duration_s)},
               {"notes", e.notes}};
  if (e.consistency) {
    json["nees"] = {{"position", e.consistency->position},
                    {"yaw", e.consistency->yaw},
                    {"poses", e.consistency->poses}};
  }
  if (e.cameras) {
    json["cameras"] = {{"count", e.cameras->cameras},       {"told_m", e.cameras->told_m},
                       {"told_deg", e.cameras->told_deg},   {"found_m", e.cameras->found_m},
                       {"found_deg", e.cameras->found_deg}, {"nees_place", e.cameras->nees_place},
                       {"nees_turn", e.cameras->nees_turn}};
  }
  return jsonText(json);
}

std::string evaluationTable(const Evaluation& e, const EvaluationLabels& labels) {
  std::string text;
  text += fmt::format("estimate   {} ({} poses)\n", labels.estimate, e.pairs.estimate_poses);
  text += fmt::format("reference  {} ({} poses)\n", labels.reference, e.pairs.reference_poses);
  text += fmt::format("matched    {} ({}), coverage {:.1f} %\n", e.pairs.size(),
                      matchingText(e, labels), 100.0 * e.pairs.coverage);
  text += fmt::format("alignment  {}\n", alignmentText(e));
  text += fmt::format("path       {:.2f} m", e.path_length);
  text += labels.by_index ? "\n\n" : fmt::format(" in {:.2f} s\n\n", e.duration_s);

  text += fmt::format("{:<19} {:>10} {:>10} {:>10} {:>10} {:>10} {:>10}\n", "", "rmse", "mean",
                      "median", "std", "p95", "max");
  text += row("APE translation m", e.ape);
  text += row("APE rotation deg", e.ape_rotation_deg);
  text += row("APE about z deg", e.ape_heading_deg);
  text += row("RPE translation m", e.rpe);
  text += row("RPE rotation deg", e.rpe_rotation_deg);
  text += fmt::format("(RPE over {}: {} pairs)\n\n", deltaText(e.options.rpe), e.rpe.count);

  if (e.drift.segments > 0) {
    text += fmt::format("drift      {:.4f} %, {:.6f} deg/m ({} segments of {:.4g} to {:.4g} m)\n",
                        e.drift.percent, e.drift.deg_per_m, e.drift.segments, e.drift.step_m,
                        8.0 * e.drift.step_m);
  } else {
    text += "drift      -\n";
  }
  text += fmt::format("at the end {:.4f} m (APE)", e.final_error);
  if (!std::isnan(e.drift.end_percent)) {
    text += fmt::format("; {:.4f} m, {:.4f} % of the path (first poses joined)", e.drift.end_m,
                        e.drift.end_percent);
  }
  text += "\n";
  if (e.consistency) {
    text += fmt::format(
        "covariance mean NEES of position {:.2f} (3 if honest), of yaw {:.2f} (1), {} poses\n",
        e.consistency->position, e.consistency->yaw, e.consistency->poses);
  }
  if (e.cameras) {
    text += fmt::format(
        "cameras    told wrong by {:.3f} deg about and {:.1f} mm along each axis, found to {:.3f} "
        "deg and {:.1f} mm (RMS);\n"
        "           mean NEES of their turns {:.2f}, of their places {:.2f} (3 if honest)\n",
        e.cameras->told_deg, 1e3 * e.cameras->told_m, e.cameras->found_deg,
        1e3 * e.cameras->found_m, e.cameras->nees_turn, e.cameras->nees_place);
  }
  for (const auto& note : e.notes) text += fmt::format("note: {}\n", note);
  return text;
}

}  // namespace parkade
