// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/semantic_queue.hpp"

#include <sys/resource.h>

#include <chrono>
#include <utility>

#include "parkade/pipeline/mapping_run.hpp"

namespace parkade {
namespace {

// The calling thread alone: on Linux each has its own niceness. Poses go first.
void giveWay() {
  constexpr int kNiceness = 10;
  setpriority(PRIO_PROCESS, 0, kNiceness);
}

}  // namespace

SemanticQueue::SemanticQueue(std::unique_ptr<SemanticFrontEnd> front_end, SemanticMapper& mapper,
                             const std::vector<PipelineObserver*>& observers,
                             const SemanticQueueOptions& options)
    : options_(options),
      front_end_(std::move(front_end)),
      mapper_(mapper),
      observers_(observers),
      beside_(options.own_threads ? 1 : 0),
      pool_(options.own_threads ? 1 : 0) {
  if (!options.live || !options.own_threads) return;
  pool_.submit(giveWay);
  beside_.submit(giveWay);
}

bool SemanticQueue::anyDue(int number) const {
  return !looks_.empty() && looks_.front()->number <= number - options_.delay;
}

void SemanticQueue::enterDue(int number) {
  while (anyDue(number)) {
    const bool ready =
        looks_.front()->done.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    if (options_.live && !ready) return;
    enterFirst();
  }
}

bool SemanticQueue::wants(int number, const PoseEstimate& odometry,
                          const std::vector<Landmark>& landmarks) {
  if (!front_end_->addOdometry(odometry, landmarks)) return false;
  const bool pass_over = options_.live && anyDue(number);
  passed_over_ += pass_over ? 1 : 0;
  return !pass_over;
}

void SemanticQueue::take(FrameSet frames, int number, const SE3& T_odom_vehicle,
                         CamerasAtStamp cameras) {
  front_end_->take();
  mapper_.holdView();
  auto look = std::make_unique<Look>();
  look->frames = std::move(frames);
  look->number = number;
  look->T_odom_vehicle = T_odom_vehicle;
  look->cameras = std::move(cameras);
  look->done = pool_.submit([this, at = look.get()] { work(*at); });
  looks_.push_back(std::move(look));
}

void SemanticQueue::work(Look& look) {
  look.begin = BusyTime::Clock::now();
  front_end_->placeCameras(look.cameras);
  look.frame = front_end_->look(look.frames, beside_);
  look.frames.images.clear();
  if (look.frame) look.views = front_end_->views();
  look.end = BusyTime::Clock::now();
  if (!look.frame) return;
  for (PipelineObserver* observer : observers_) {
    observer->onFeatures({front_end_->picture(), *look.frame});
  }
}

void SemanticQueue::enterFirst() {
  const std::unique_ptr<Look> look = std::move(looks_.front());
  looks_.pop_front();
  look->done.get();
  busy_.add(look->begin, look->end);
  if (!look->frame) {
    if (status_) status_ = look->frame.error();
    mapper_.dropView();
    return;
  }
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  mapper_.addSemantics(*look->frame, look->views);
  const Clock::time_point end = Clock::now();
  fuse_clock_.add(millisecondsBetween(begin, end));
  busy_.add(begin, end);
  for (PipelineObserver* observer : observers_) {
    observer->onMap({*look->frame, look->T_odom_vehicle, mapper_.localMap()});
  }
}

void SemanticQueue::finish() {
  while (!looks_.empty()) enterFirst();
}

void SemanticQueue::abandon() noexcept {
  for (const std::unique_ptr<Look>& look : looks_) look->done.wait();
  looks_.clear();
}

std::vector<StageTiming> SemanticQueue::timings() const {
  std::vector<StageTiming> stages = front_end_->timings();
  stages.push_back(fuse_clock_.timing());
  return stages;
}

}  // namespace parkade
