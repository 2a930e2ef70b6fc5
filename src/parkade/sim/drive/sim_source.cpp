// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/sim_source.hpp"

#include <condition_variable>
#include <deque>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

namespace parkade::sim {

class SimSource::Ahead {
 public:
  Ahead(FrameFunction draw, int count, std::size_t capacity)
      : draw_(std::move(draw)), count_(count), capacity_(capacity) {}

  ~Ahead() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  // Waits for the next frame set.
  Result<FrameSet> take() {
    // Started by the first reader: a source that is only asked for its info draws nothing.
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !ready_.empty(); });
    Result<FrameSet> frame = std::move(ready_.front());
    // A failure stays at the front: every later call gets it again.
    if (frame) ready_.pop_front();
    lock.unlock();
    changed_.notify_all();
    return frame;
  }

 private:
  void run() {
    for (int index = 0; index < count_; ++index) {
      Result<FrameSet> frame = guarded(index);
      const bool failed = !frame.ok();
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || ready_.size() < capacity_; });
      if (stop_) return;
      ready_.push_back(std::move(frame));
      lock.unlock();
      changed_.notify_all();
      if (failed) return;
    }
  }

  // An exception must not end the program from a thread that nobody joins yet.
  Result<FrameSet> guarded(int index) {
    try {
      return draw_(index);
    } catch (const std::exception& error) {
      return Error{std::string("drawing failed: ") + error.what()};
    }
  }

  FrameFunction draw_;
  int count_;
  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Result<FrameSet>> ready_;
  bool stop_ = false;
  std::thread thread_;
};

SimSource::SimSource(std::shared_ptr<const Simulation> simulation, Rig rig, FrameFunction draw,
                     int ahead)
    : simulation_(std::move(simulation)), rig_(std::move(rig)) {
  info_.name = simulation_->spec().name();
  info_.start_ns = kSimStartNs;
  info_.end_ns = simulation_->imu().empty() ? kSimStartNs : simulation_->imu().back().t_ns;
  info_.num_cameras = static_cast<int>(rig_.cameras.size());
  info_.has_wheel = true;
  if (draw) {
    info_.num_frame_sets = static_cast<int>(simulation_->frameTimes().size());
    ahead_ = std::make_unique<Ahead>(std::move(draw), info_.num_frame_sets,
                                     static_cast<std::size_t>(std::max(1, ahead)));
  }
}

SimSource::~SimSource() = default;

Result<std::optional<SensorEvent>> SimSource::next() {
  constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();
  const auto stamp = [](const auto& samples, std::size_t i) {
    return i < samples.size() ? samples[i].t_ns : kNever;
  };
  const std::vector<TimeNs>& frames = simulation_->frameTimes();
  const TimeNs imu = stamp(simulation_->imu(), next_imu_);
  const TimeNs wheel = stamp(simulation_->wheel(), next_wheel_);
  const TimeNs frame = ahead_ && next_frame_ < frames.size() ? frames[next_frame_] : kNever;
  if (imu == kNever && wheel == kNever && frame == kNever) return std::optional<SensorEvent>();
  if (imu <= wheel && imu <= frame) {
    return std::optional<SensorEvent>(simulation_->imu()[next_imu_++]);
  }
  if (wheel <= frame) return std::optional<SensorEvent>(simulation_->wheel()[next_wheel_++]);
  Result<FrameSet> drawn = ahead_->take();
  if (!drawn) return drawn.error();
  ++next_frame_;
  return std::optional<SensorEvent>(std::move(drawn).value());
}

}  // namespace parkade::sim
