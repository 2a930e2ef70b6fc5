// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
//
// Feeds Parkade from one's own sensors: a SensorSource that hands out what drivers deliver. Here a
// recorded folder plays the drivers; on a car they would be callbacks of the cameras and the IMU.
//
//   01_feed_a_source SEQUENCE [SECONDS]
#include <fmt/core.h>

#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <thread>

#include "parkade/io/sequence_reader.hpp"
#include "parkade/pipeline/mapping_run.hpp"

namespace {

using namespace parkade;

/// A queue between the threads of the drivers and the run. Events must come in the order of time,
/// an inertial reading before the frame set of the same stamp (SensorSource).
class LiveSource : public SensorSource {
 public:
  explicit LiveSource(SensorSourceInfo info) : info_(std::move(info)) {}

  void push(SensorEvent event) {
    std::unique_lock lock(mutex_);
    constexpr std::size_t kMost = 64;  // a car drops events here rather than wait
    changed_.wait(lock, [&] { return events_.size() < kMost; });
    events_.push_back(std::move(event));
    changed_.notify_all();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

  [[nodiscard]] const SensorSourceInfo& info() const override { return info_; }
  Result<std::optional<SensorEvent>> next() override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return closed_ || !events_.empty(); });
    if (events_.empty()) return std::optional<SensorEvent>();
    std::optional<SensorEvent> event(std::move(events_.front()));
    events_.pop_front();
    changed_.notify_all();
    return event;
  }

 private:
  SensorSourceInfo info_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<SensorEvent> events_;
  bool closed_ = false;
};

int fail(const Error& error) {
  fmt::print(stderr, "error: {}\n", error.message);
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: {} SEQUENCE [SECONDS]\n", argv[0]);
    return 2;
  }
  SequenceReaderOptions options;
  options.duration_s = argc > 2 ? std::atof(argv[2]) : 0.0;
  auto drivers = SequenceReader::open(argv[1], options);
  if (!drivers) return fail(drivers.error());

  LiveSource source((*drivers)->info());
  Status recorded;
  std::thread car([&] {
    while (true) {
      auto event = (*drivers)->next();
      if (!event) recorded = event.error();
      if (!event || !event->has_value()) break;
      source.push(std::move(**event));
    }
    source.close();
  });

  constexpr int kThreads = 2;
  auto run = MappingRun::create((*drivers)->rig(), PipelineOptions{}, kThreads);
  if (!run) {
    fmt::print(stderr, "error: {}\n", run.error().message);
    std::_Exit(1);  // the drivers still push
  }
  const Status done = (*run)->run(source);
  car.join();
  if (!recorded) return fail(recorded.error());
  if (!done) return fail(done.error());
  const Trajectory& trajectory = (*run)->trajectory();
  if (trajectory.empty()) return fail({"no pose: the estimator did not start"});
  const Eigen::Vector3d end = trajectory.back().T_world_body.translation();
  fmt::print("{} poses; the car ends {:.3f} {:.3f} {:.3f} m from where it began\n",
             trajectory.size(), end.x(), end.y(), end.z());
  return 0;
}
