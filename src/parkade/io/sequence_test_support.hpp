// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/io/sequence_reader.hpp"
#include "parkade/io/sequence_writer.hpp"
#include "parkade/io/test_support.hpp"

namespace parkade::test {

inline Rig smallRig(int num_cameras = 2) {
  Rig rig;
  rig.name = "small";
  for (int i = 0; i < num_cameras; ++i) {
    PinholeRadtan::Parameters p;
    p.fx = p.fy = 50.0 + i;
    p.cx = 31.5;
    p.cy = 23.5;
    RigCamera camera;
    camera.name = "cam" + std::to_string(i);
    camera.camera = Camera(PinholeRadtan(p), 64, 48);
    camera.T_vehicle_cam = SE3(SO3::exp({0.1, 0.2, 0.3 * i}), {1.0, 0.1 * i, 0.5});
    camera.rate_hz = 10.0;
    rig.cameras.push_back(camera);
  }
  rig.imu.rate_hz = 100.0;
  rig.vehicle = VehicleShape{};
  return rig;
}

/// A second of a small car: IMU 100 Hz, wheels 50 Hz, two gray cameras 10 Hz. Camera 1 is 2 ms
/// later and lacks its fourth image.
inline std::vector<SensorEvent> smallEvents() {
  Random random(5);
  cv::RNG pixels(11);
  std::vector<SensorEvent> events;
  constexpr TimeNs kStart = 1'000'000'000'123'456'789;
  const auto vector = [&random] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  };
  for (int i = 0; i <= 100; ++i) {
    const TimeNs t_ns = kStart + i * 10 * kNsPerMs;
    events.push_back(ImuSample{t_ns, vector(), vector()});
    if (i % 2 == 0) events.push_back(WheelSample{t_ns, random.normal(), 1.0 / 3.0, NAN});
    if (i % 10 != 0 || i == 100) continue;
    FrameSet frame_set;
    frame_set.index = i / 10;
    const bool lacks = frame_set.index == 3;
    frame_set.image_t_ns = {t_ns, lacks ? 0 : t_ns + 2 * kNsPerMs};
    frame_set.t_ns = lacks ? t_ns : t_ns + kNsPerMs;
    frame_set.images.resize(2);
    for (std::size_t k = 0; k < 2; ++k) {
      if (frame_set.image_t_ns[k] == 0) continue;
      frame_set.images[k].create(48, 64, CV_8UC1);
      pixels.fill(frame_set.images[k], cv::RNG::UNIFORM, 0, 256);
    }
    events.push_back(std::move(frame_set));
  }
  return events;
}

inline void writeEvents(const std::string& path, const std::vector<SensorEvent>& events,
                        SequenceWriterOptions options = {}, const Rig& rig = smallRig()) {
  auto writer = SequenceWriter::create(path, rig, options);
  ASSERT_TRUE(writer.ok()) << writer.error().message;
  for (const SensorEvent& event : events) ASSERT_TRUE((*writer)->write(event).ok());
  const Status finished = (*writer)->finish();
  ASSERT_TRUE(finished.ok()) << finished.error().message;
}

inline SequenceWriterOptions lossless() {
  SequenceWriterOptions options;
  options.image_format = "png";
  return options;
}

/// All events of a source, or those before an Error, which goes to `error`.
inline std::vector<SensorEvent> readAll(SensorSource& source, std::string* error = nullptr) {
  std::vector<SensorEvent> events;
  while (true) {
    Result<std::optional<SensorEvent>> event = source.next();
    if (!event) {
      EXPECT_NE(error, nullptr) << event.error().message;
      if (error != nullptr) *error = event.error().message;
      return events;
    }
    if (!event->has_value()) return events;
    events.push_back(std::move(**event));
  }
}

inline std::vector<FrameSet> framesOf(const std::vector<SensorEvent>& events) {
  std::vector<FrameSet> frames;
  for (const SensorEvent& event : events) {
    if (const auto* frame = std::get_if<FrameSet>(&event)) frames.push_back(*frame);
  }
  return frames;
}

inline bool sameImage(const cv::Mat& a, const cv::Mat& b) {
  if (a.empty() || b.empty()) return a.empty() && b.empty();
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

}  // namespace parkade::test
