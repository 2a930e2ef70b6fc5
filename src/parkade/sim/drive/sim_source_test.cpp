// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/sim_source.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "parkade/sim/drive/rig_presets.hpp"

namespace parkade::sim {
namespace {

std::shared_ptr<const Simulation> simulate(const std::string& address) {
  const Result<SimSpec> spec = parseSimAddress(address);
  EXPECT_TRUE(spec.ok()) << spec.error().message;
  Result<std::shared_ptr<const Simulation>> simulation = Simulation::make(*spec);
  EXPECT_TRUE(simulation.ok()) << simulation.error().message;
  return *simulation;
}

FrameFunction blankFrames(std::shared_ptr<const Simulation> simulation) {
  return [simulation](int index) -> Result<FrameSet> {
    FrameSet set;
    set.index = index;
    set.t_ns = simulation->frameTimes()[index];
    set.images.resize(simulation->trueRig().cameras.size());
    set.image_t_ns.assign(set.images.size(), set.t_ns);
    return set;
  };
}

std::vector<SensorEvent> readAll(SensorSource& source) {
  std::vector<SensorEvent> events;
  while (true) {
    Result<std::optional<SensorEvent>> event = source.next();
    EXPECT_TRUE(event.ok()) << event.error().message;
    if (!event.ok() || !event->has_value()) return events;
    events.push_back(std::move(**event));
  }
}

TEST(SimSource, DeliversEventsInTheOrderOfTime) {
  const auto simulation = simulate("sim:paper/test1?duration=5");
  SimSource source(simulation, simulation->toldRig(), blankFrames(simulation));
  const std::vector<SensorEvent> events = readAll(source);
  int imu = 0, wheel = 0, frames = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i > 0) {
      EXPECT_LE(timeOf(events[i - 1]), timeOf(events[i]));
      // An inertial sample comes before the pictures of its instant.
      if (std::holds_alternative<FrameSet>(events[i - 1])) {
        EXPECT_LT(timeOf(events[i - 1]), timeOf(events[i]));
      }
    }
    imu += std::holds_alternative<ImuSample>(events[i]) ? 1 : 0;
    wheel += std::holds_alternative<WheelSample>(events[i]) ? 1 : 0;
    if (const auto* set = std::get_if<FrameSet>(&events[i])) {
      EXPECT_EQ(set->index, frames++);
    }
  }
  EXPECT_EQ(imu, 1001);
  EXPECT_EQ(wheel, 501);
  EXPECT_EQ(frames, 50);
  EXPECT_EQ(source.info().num_frame_sets, 50);
  EXPECT_EQ(source.info().end_ns - source.info().start_ns, 5 * kNsPerSecond);
}

TEST(SimSource, WithoutPicturesTheRestIsTheSame) {
  const auto simulation = simulate("sim:paper/test1?duration=2&images=0");
  SimSource source(simulation, simulation->toldRig(), {});
  for (const SensorEvent& event : readAll(source)) {
    EXPECT_FALSE(std::holds_alternative<FrameSet>(event));
  }
  EXPECT_EQ(source.info().num_frame_sets, 0);
}

TEST(SimSource, DrawsAFewAheadAndNoMore) {
  const auto simulation = simulate("sim:paper/test1?duration=5");
  std::atomic<int> drawn = 0;
  const FrameFunction blank = blankFrames(simulation);
  {
    SimSource source(
        simulation, simulation->toldRig(),
        [&drawn, blank](int index) {
          ++drawn;
          return blank(index);
        },
        2);
    EXPECT_EQ(drawn, 0);
    while (true) {
      Result<std::optional<SensorEvent>> event = source.next();
      ASSERT_TRUE(event.ok());
      if (std::holds_alternative<FrameSet>(**event)) break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_LE(drawn, 1 + 2 + 1);  // taken, waiting, in work
  }                               // ends with the background at work
  EXPECT_LE(drawn, 4);
}

TEST(SimSource, FrameSetsOfSeveralThreadsComeInOrder) {
  const auto simulation = simulate("sim:paper/test1?duration=5");
  const FrameFunction blank = blankFrames(simulation);
  SimSource source(
      simulation, simulation->toldRig(),
      [blank](int index) {
        // Every third takes longest: the ones after it are done first.
        std::this_thread::sleep_for(std::chrono::milliseconds(index % 3 == 0 ? 3 : 0));
        return blank(index);
      },
      2, 3);
  int frames = 0;
  for (const SensorEvent& event : readAll(source)) {
    if (const auto* set = std::get_if<FrameSet>(&event)) {
      EXPECT_EQ(set->index, frames++);
    }
  }
  EXPECT_EQ(frames, 50);
}

TEST(SimSource, WhatWasDrawnBeforeAFailureComesFirst) {
  const auto simulation = simulate("sim:paper/test1?duration=5");
  const FrameFunction blank = blankFrames(simulation);
  SimSource source(
      simulation, simulation->toldRig(),
      [blank](int index) -> Result<FrameSet> {
        if (index == 7) return Error{"no light"};
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        return blank(index);
      },
      3, 2);
  int frames = 0;
  Result<std::optional<SensorEvent>> event = source.next();
  for (; event.ok(); event = source.next()) {
    frames += std::holds_alternative<FrameSet>(**event) ? 1 : 0;
  }
  EXPECT_EQ(frames, 7);
  EXPECT_EQ(event.error().message, "no light");
  EXPECT_FALSE(source.next().ok());
}

TEST(SimSource, AFailureEndsTheStreamAndStays) {
  const auto simulation = simulate("sim:paper/test1?duration=2");
  SimSource source(simulation, simulation->toldRig(),
                   [](int) -> Result<FrameSet> { return Error{"no light"}; });
  int errors = 0;
  for (int i = 0; i < 200; ++i) errors += source.next().ok() ? 0 : 1;
  EXPECT_GT(errors, 100);
}

TEST(Simulation, SameSeedSameSamples) {
  const auto a = simulate("sim:paper/test2?duration=10&seed=4");
  const auto b = simulate("sim:paper/test2?duration=10&seed=4&threads=1");
  const auto c = simulate("sim:paper/test2?duration=10&seed=5");
  ASSERT_EQ(a->imu().size(), b->imu().size());
  bool differs = false;
  for (std::size_t i = 0; i < a->imu().size(); ++i) {
    EXPECT_EQ(a->imu()[i].gyro, b->imu()[i].gyro);
    EXPECT_EQ(a->imu()[i].accel, b->imu()[i].accel);
    differs = differs || a->imu()[i].gyro != c->imu()[i].gyro;
  }
  EXPECT_TRUE(differs);
}

TEST(Simulation, ACutDriveIsTheBeginningOfTheWhole) {
  const auto whole = simulate("sim:paper/test5");
  const auto cut = simulate("sim:paper/test5?duration=7");
  ASSERT_LT(cut->imu().size(), whole->imu().size());
  EXPECT_EQ(cut->imu().back().accel, whole->imu()[cut->imu().size() - 1].accel);
  EXPECT_EQ(cut->frameTimes().size(), 70U);
  EXPECT_EQ(cut->wholeDuration(), whole->duration());
}

TEST(Simulation, TheParkingSlotIsFreeAndTheShareKept) {
  const auto simulation = simulate("sim:paper/test5?duration=2");
  int occupied = 0;
  for (const Slot& slot : simulation->garage().slots) {
    occupied += slot.occupied ? 1 : 0;
    EXPECT_FALSE(slot.occupied && slot.id == simulation->route().parking_slot_id);
  }
  EXPECT_NEAR(occupied, 0.95 * static_cast<double>(simulation->garage().slots.size()), 0.51);
}

TEST(Simulation, ALaterDriveMeetsOtherParkedCarsOnTheSameWay) {
  const auto first = simulate("sim:paper/test1?duration=2");
  const auto later = simulate("sim:paper/test1?duration=2&parked_seed=5");
  int moved = 0;
  for (std::size_t i = 0; i < first->garage().slots.size(); ++i) {
    moved += first->garage().slots[i].occupied != later->garage().slots[i].occupied ? 1 : 0;
  }
  EXPECT_GT(moved, 20);
  EXPECT_EQ(first->wholeDuration(), later->wholeDuration());
  EXPECT_EQ(first->imu().back().accel, later->imu().back().accel);
}

TEST(Simulation, RollingStartBeginsOnTheMove) {
  const auto resting = simulate("sim:paper/test1?duration=2");
  const auto rolling = simulate("sim:paper/test1?duration=2&rolling_start=1");
  EXPECT_LT(resting->truth().front().velocity_world.norm(), 1e-3);
  EXPECT_GT(rolling->truth().front().velocity_world.norm(), 1.9);
}

TEST(Simulation, CalibrationErrorTurnsOnlyWhatTheReaderIsTold) {
  const auto exact = simulate("sim:paper/test1?duration=1");
  const auto wrong = simulate("sim:paper/test1?duration=1&calib_error_deg=0.5&calib_error_cm=1");
  double angle = 0.0;
  double distance = 0.0;
  const std::size_t count = wrong->trueRig().cameras.size();
  for (std::size_t i = 0; i < count; ++i) {
    const SE3& truth = wrong->trueRig().cameras[i].T_vehicle_cam;
    const SE3& told = wrong->toldRig().cameras[i].T_vehicle_cam;
    EXPECT_EQ(truth.matrix(), exact->trueRig().cameras[i].T_vehicle_cam.matrix());
    EXPECT_EQ(truth.matrix(), exact->toldRig().cameras[i].T_vehicle_cam.matrix());
    angle += angleBetween(truth.rotation(), told.rotation()) / static_cast<double>(count);
    distance += (truth.translation() - told.translation()).norm() / static_cast<double>(count);
  }
  // The mean length of a vector of three normal numbers is 1.6 sigma.
  EXPECT_NEAR(angle, 1.6 * 0.5 * 3.14159 / 180.0, 0.6 * 0.5 * 3.14159 / 180.0);
  EXPECT_NEAR(distance, 0.016, 0.006);
}

TEST(Simulation, EveryGarageIsDrivenWithAWrongRigOfItsOwn) {
  const auto told = [](const std::string& garage_seed) {
    return simulate("sim:random/random?duration=1&calib_error_deg=0.5&garage_seed=" + garage_seed)
        ->toldRig()
        .cameras[0]
        .T_vehicle_cam;
  };
  EXPECT_EQ(told("5100").matrix(), told("5100").matrix());
  EXPECT_GT(angleBetween(told("5100").rotation(), told("5101").rotation()), 1e-3);
}

TEST(Simulation, WheelsAgreeWithTheDrive) {
  const auto simulation = simulate("sim:paper/test1?noise=0");
  double distance = 0.0;
  for (const WheelSample& sample : simulation->wheel()) {
    distance += 0.005 * (sample.rear_left_mps + sample.rear_right_mps);
  }
  EXPECT_NEAR(distance, simulation->drivenDistance(), 0.05);
}

TEST(RigPresets, AreInTheProgram) {
  const std::vector<std::string> names = rigPresetNames();
  for (const char* wanted : {"avp6", "nuscenes6", "avm4"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), wanted), names.end()) << wanted;
    const Result<Rig> rig = loadRig(wanted);
    ASSERT_TRUE(rig.ok()) << rig.error().message;
    EXPECT_TRUE(rig->vehicle.has_value());
  }
  const Result<Rig> unknown = loadRig("avp7");
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().message.find("known are"), std::string::npos);
  EXPECT_FALSE(loadRig("/nowhere/rig.yaml").ok());
}

}  // namespace
}  // namespace parkade::sim
