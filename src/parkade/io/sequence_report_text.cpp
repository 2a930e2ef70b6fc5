// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "parkade/io/csv.hpp"
#include "parkade/io/rig_report.hpp"
#include "parkade/io/sequence_report.hpp"

namespace parkade {
namespace {

std::string vectorText(const Eigen::Vector3d& v) {
  return fmt::format("{:.4f} {:.4f} {:.4f}", v.x(), v.y(), v.z());
}

std::string gapText(const StreamStatistics& s) {
  if (s.gaps == 0) return "no gaps";
  return fmt::format("{} {} (up to {:.1f} ms)", s.gaps, s.gaps == 1 ? "gap" : "gaps",
                     s.largest_gap_ms);
}

std::string streamText(const StreamStatistics& s) {
  std::string text =
      fmt::format("{:.4g} Hz, jitter {:.3f} ms, {}", s.rate_hz, s.jitter_ms, gapText(s));
  if (!s.stamps.clean()) {
    text += fmt::format(", {} stamps backward, {} repeated", s.stamps.backward, s.stamps.repeated);
  }
  return text;
}

std::string imuText(const ImuReport& imu) {
  const Eigen::Vector3d& g = imu.quiet_accel_vehicle;
  return fmt::format(
      "  imu        {:.4g} Hz IMU, {} samples, jitter {:.3f} ms, {}, {} stamps backward, {} "
      "repeated\n"
      "    gyro     mean {} rad/s, std {}\n"
      "    accel    mean {} m/s^2, std {}\n"
      "    gravity  {:.3f} m/s^2, in the vehicle frame {} (quietest second, from {} s on)\n"
      "    bias     gyro {} rad/s in that second\n",
      imu.stream.rate_hz, imu.stream.count, imu.stream.jitter_ms, gapText(imu.stream),
      imu.stream.stamps.backward, imu.stream.stamps.repeated, vectorText(imu.gyro_mean),
      vectorText(imu.gyro_std), vectorText(imu.accel_mean), vectorText(imu.accel_std), imu.gravity,
      vectorText(g), fmt::format("{:.2f}", toSeconds(imu.quiet_start_ns - imu.stream.start_ns)),
      vectorText(imu.quiet_gyro));
}

nlohmann::json streamJson(const StreamStatistics& s) {
  return {{"count", s.count},
          {"start_ns", s.start_ns},
          {"end_ns", s.end_ns},
          {"rate_hz", s.rate_hz},
          {"jitter_ms", s.jitter_ms},
          {"gaps", s.gaps},
          {"largest_gap_ms", s.largest_gap_ms},
          {"backward", s.stamps.backward},
          {"repeated", s.stamps.repeated}};
}

}  // namespace

std::string sequenceText(const SequenceReport& r) {
  std::string text = fmt::format("sequence {}\n  duration   {:.3f} s, from {} to {}\n", r.path,
                                 r.duration_s, formatSeconds(r.start_ns), formatSeconds(r.end_ns));
  text += fmt::format("  cameras    {} cameras, {} frame sets, {:.4g} Hz, {} of them complete\n",
                      r.cameras.size(), r.frame_sets, r.frame_rate_hz, r.complete_frame_sets);
  for (const CameraReport& c : r.cameras) {
    text += fmt::format("    {:<8} {} x {} {}, {} images, {}\n", c.name, c.width, c.height, c.model,
                        c.stream.count, streamText(c.stream));
  }
  text += r.imu ? imuText(*r.imu) : "  imu        none\n";
  if (r.wheel) {
    text += fmt::format(
        "  wheel      {}, {} samples, up to {:.2f} m/s, {:.1f} m driven, {} steering angle\n",
        streamText(r.wheel->stream), r.wheel->stream.count, r.wheel->max_speed_mps,
        r.wheel->distance_m, r.wheel->has_steering ? "with" : "without");
  } else {
    text += "  wheel      none\n";
  }
  if (r.reference) {
    text +=
        fmt::format("  reference  {} poses over {:.3f} s, {:.2f} m long: {}\n", r.reference->count,
                    r.reference->duration_s, r.reference->length_m, r.reference->path);
  } else {
    text += "  reference  none\n";
  }
  return text + checksText(r.checks);
}

nlohmann::json sequenceJson(const SequenceReport& r) {
  nlohmann::json json = {{"path", r.path},
                         {"duration_s", r.duration_s},
                         {"start_ns", r.start_ns},
                         {"end_ns", r.end_ns},
                         {"frame_sets", r.frame_sets},
                         {"complete_frame_sets", r.complete_frame_sets},
                         {"frame_rate_hz", r.frame_rate_hz},
                         {"cameras", nlohmann::json::array()},
                         {"imu", nullptr},
                         {"wheel", nullptr},
                         {"reference", nullptr},
                         {"checks", nlohmann::json::array()},
                         {"failed", r.failed()}};
  for (const CameraReport& c : r.cameras) {
    json["cameras"].push_back({{"name", c.name},
                               {"model", c.model},
                               {"width", c.width},
                               {"height", c.height},
                               {"missing", c.missing},
                               {"unreadable", c.unreadable},
                               {"stream", streamJson(c.stream)}});
  }
  if (r.imu) {
    json["imu"] = {{"stream", streamJson(r.imu->stream)},
                   {"gyro_mean", vectorJson(r.imu->gyro_mean)},
                   {"gyro_std", vectorJson(r.imu->gyro_std)},
                   {"accel_mean", vectorJson(r.imu->accel_mean)},
                   {"accel_std", vectorJson(r.imu->accel_std)},
                   {"quiet_start_ns", r.imu->quiet_start_ns},
                   {"quiet_gyro", vectorJson(r.imu->quiet_gyro)},
                   {"quiet_accel_vehicle", vectorJson(r.imu->quiet_accel_vehicle)},
                   {"quiet_accel_std", r.imu->quiet_accel_std},
                   {"gravity", r.imu->gravity}};
  }
  if (r.wheel) {
    json["wheel"] = {{"stream", streamJson(r.wheel->stream)},
                     {"max_speed_mps", r.wheel->max_speed_mps},
                     {"distance_m", r.wheel->distance_m},
                     {"has_steering", r.wheel->has_steering}};
  }
  if (r.reference) {
    json["reference"] = {{"path", r.reference->path},
                         {"count", r.reference->count},
                         {"duration_s", r.reference->duration_s},
                         {"length_m", r.reference->length_m}};
  }
  for (const Check& check : r.checks) {
    json["checks"].push_back(
        {{"mark", toString(check.mark)}, {"name", check.name}, {"detail", check.detail}});
  }
  return json;
}

}  // namespace parkade
