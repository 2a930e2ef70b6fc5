// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <future>
#include <memory>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/pipeline/semantic_front_end.hpp"
#include "parkade/pipeline/semantic_mapper.hpp"
#include "parkade/pipeline/stage_clock.hpp"
#include "parkade/pipeline/thread_pool.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

class PipelineObserver;

struct SemanticQueueOptions {
  int delay = 2;            ///< frame sets until features enter the map
  bool live = false;        ///< never wait for features: pass pictures over instead
  bool own_threads = true;  ///< two; else it works in its caller's
};

/// The semantic side of a run: has pictures looked at beside everything else, and corrects the
/// mapper with what was seen in them, in their order.
///
/// Features enter a fixed number of frame sets after their picture, waited for where they are not
/// ready: what comes out does not depend on how fast they are made. A live one does not wait: they
/// enter when they are ready, no new picture is taken while some are overdue, and its threads give
/// way to others. Where the computer keeps up, both give the same.
class SemanticQueue {
 public:
  /// mapper and observers: not owned, must live as long.
  SemanticQueue(std::unique_ptr<SemanticFrontEnd> front_end, SemanticMapper& mapper,
                const std::vector<PipelineObserver*>& observers,
                const SemanticQueueOptions& options);

  /// Corrects the mapper with the features that are due at frame set `number`.
  void enterDue(int number);
  /// Takes the odometry of every frame set, in order; true where its pictures are due by the way
  /// driven and not passed over: take() them then.
  bool wants(int number, const PoseEstimate& odometry, const std::vector<Landmark>& landmarks);
  /// Sends the pictures of the frame set off that was just wanted. cameras: where they sit by now,
  /// none: as the rig says.
  void take(FrameSet frames, int number, const SE3& T_odom_vehicle, CamerasAtStamp cameras);
  /// Waits for all that is on its way and enters it.
  void finish();
  /// Waits for all that is on its way, and drops it.
  void abandon() noexcept;

  /// The first failure to look at a picture, by now.
  [[nodiscard]] const Status& status() const { return status_; }
  /// Pictures that a live run took no time for.
  [[nodiscard]] int passedOver() const { return passed_over_; }
  [[nodiscard]] std::vector<StageTiming> timings() const;
  /// When it was at work, on what has entered the map by now.
  [[nodiscard]] const BusyTime& busy() const { return busy_; }

 private:
  // The features of one frame set, on their way.
  struct Look {
    FrameSet frames;
    int number = 0;  // of the frame set
    SE3 T_odom_vehicle;
    CamerasAtStamp cameras;
    Result<SemanticFrame> frame = Error{"not looked yet"};
    std::vector<LevelView> views;
    BusyTime::Clock::time_point begin;
    BusyTime::Clock::time_point end;
    std::future<void> done;
  };

  [[nodiscard]] bool anyDue(int number) const;
  void work(Look& look);
  void enterFirst();

  SemanticQueueOptions options_;
  std::unique_ptr<SemanticFrontEnd> front_end_;
  SemanticMapper& mapper_;
  const std::vector<PipelineObserver*>& observers_;
  std::deque<std::unique_ptr<Look>> looks_;
  StageClock fuse_clock_{"fuse"};
  BusyTime busy_;
  Status status_;
  int passed_over_ = 0;
  ThreadPool beside_;  // for what front_end_ looks at meanwhile
  ThreadPool pool_;    // last: its thread uses what is above
};

}  // namespace parkade
