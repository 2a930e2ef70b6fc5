// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/sim_source.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "parkade/sim/render/parallel.hpp"

namespace parkade::sim {

class SimSource::Ahead {
 public:
  Ahead(FrameFunction draw, int count, int capacity, int threads)
      : draw_(std::move(draw)), count_(count), capacity_(capacity), threads_wanted_(threads) {}

  ~Ahead() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  // Waits for the next frame set.
  Result<FrameSet> take() {
    // Started by the first reader: a source that is only asked for its info draws nothing.
    while (static_cast<int>(threads_.size()) < threads_wanted_) {
      threads_.emplace_back([this] { run(); });
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ready_.count(next_taken_) != 0; });
    const auto at = ready_.find(next_taken_);
    Result<FrameSet> frame = std::move(at->second);
    if (frame) {
      ready_.erase(at);
      ++next_taken_;
    } else {
      at->second = frame.error();  // a failure stays: every later call gets it again
    }
    lock.unlock();
    changed_.notify_all();
    return frame;
  }

 private:
  void run() {
    std::optional<KeepToThread> keep;
    if (threads_wanted_ > 1) keep.emplace();
    std::unique_lock lock(mutex_);
    while (!stop_ && next_drawn_ < count_) {
      const int index = next_drawn_++;
      lock.unlock();
      Result<FrameSet> frame = guarded(index);
      lock.lock();
      if (!frame.ok()) next_drawn_ = count_;  // none after a failure
      changed_.wait(lock, [&] { return stop_ || index < next_taken_ + capacity_; });
      ready_.emplace(index, std::move(frame));
      changed_.notify_all();
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
  const int count_;
  const int capacity_;
  const int threads_wanted_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<int, Result<FrameSet>> ready_;  // by index
  int next_drawn_ = 0;
  int next_taken_ = 0;
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

SimSource::SimSource(std::shared_ptr<const Simulation> simulation, Rig rig, FrameFunction draw,
                     int ahead, int threads)
    : simulation_(std::move(simulation)), rig_(std::move(rig)) {
  info_.name = simulation_->spec().name();
  info_.start_ns = kSimStartNs;
  info_.end_ns = simulation_->imu().empty() ? kSimStartNs : simulation_->imu().back().t_ns;
  info_.num_cameras = static_cast<int>(rig_.cameras.size());
  info_.has_wheel = true;
  if (draw) {
    info_.num_frame_sets = static_cast<int>(simulation_->frameTimes().size());
    ahead_ = std::make_unique<Ahead>(std::move(draw), info_.num_frame_sets,
                                     std::max({1, ahead, threads}), std::max(1, threads));
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
