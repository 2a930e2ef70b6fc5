// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/marginalisation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Removes a frame's observations; features keep their point through another anchor, if any.
void eraseObservations(Window& window, int frame_id) {
  for (auto it = window.features.begin(); it != window.features.end();) {
    WindowFeature& feature = it->second;
    std::erase_if(feature.observations,
                  [&](const WindowObservation& o) { return o.frame_id == frame_id; });
    if (feature.observations.empty()) {
      it = window.features.erase(it);
      continue;
    }
    if (feature.has_point && feature.anchor_frame_id == frame_id &&
        !moveAnchor(window, feature, feature.observations.front())) {
      feature.has_point = false;
      feature.selected = false;
    }
    ++it;
  }
}

FactorSelection selectFactors(const Window& window, std::size_t index,
                              const std::vector<WindowFeature*>& landmarks) {
  FactorSelection selection = FactorSelection::none(window);
  const int id = window.frames[index].id;
  selection.prior = true;
  selection.imu[index] = 1;
  if (index + 1 < window.frames.size()) selection.imu[index + 1] = 1;
  for (std::size_t k = 0; k < window.frames.size(); ++k) {
    if (k == index || window.frames[k].still_since == id) selection.still[k] = 1;
  }
  selection.unary[index] = 1;
  selection.features = landmarks;
  selection.inverse_distance_information = kLeavingInverseDistanceInformation;
  return selection;
}

// Frames that the selected terms touch, in the order of time.
std::vector<std::size_t> involvedFrames(const Window& window, const FactorSelection& selection,
                                        std::size_t index) {
  std::vector<char> involved(window.frames.size(), 0);
  involved[index] = 1;
  const auto mark = [&](int id) {
    const int k = window.indexOf(id);
    if (k >= 0) involved[static_cast<std::size_t>(k)] = 1;
  };
  for (const int id : window.prior.frame_ids) mark(id);
  for (std::size_t k = 0; k < window.frames.size(); ++k) {
    const WindowFrame& frame = window.frames[k];
    if (selection.imu[k] != 0 && k > 0 && frame.imu) involved[k] = involved[k - 1] = 1;
    if (selection.still[k] != 0 && frame.still_since >= 0 && frame.still_since < frame.id &&
        window.indexOf(frame.still_since) >= 0) {
      involved[k] = 1;
      mark(frame.still_since);
    }
  }
  for (const WindowFeature* feature : selection.features) {
    for (const WindowObservation& o : feature->observations) mark(o.frame_id);
  }
  std::vector<std::size_t> result;
  for (std::size_t k = 0; k < involved.size(); ++k) {
    if (involved[k] != 0) result.push_back(k);
  }
  return result;
}

}  // namespace

FrameConditional marginaliseFrame(Window& window, int frame_id,
                                  const std::vector<WindowFeature*>& landmarks,
                                  const WindowLoss& loss, const StillSigma& still) {
  const int found = window.indexOf(frame_id);
  PARKADE_CHECK(found >= 0, "frame {} is not in the window", frame_id);
  const auto index = static_cast<std::size_t>(found);
  const FactorSelection selection = selectFactors(window, index, landmarks);
  const std::vector<std::size_t> involved = involvedFrames(window, selection, index);
  for (const std::size_t k : involved) window.frames[k].fixLinearisation();

  window.fixGlobals();

  // 1. All terms, landmarks eliminated, as a quadratic about the points of linearisation. The frame
  // that leaves goes first, the globals last.
  LinearSystem system(loss, still);
  system.linearise(window, selection);
  system.reduce(0.0);
  std::vector<std::size_t> order{index};
  for (const std::size_t k : involved) {
    if (k != index) order.push_back(k);
  }
  const Eigen::Index globals = window.globalSize();
  const Eigen::Index size = kState * static_cast<Eigen::Index>(order.size()) + globals;
  std::vector<Eigen::Index> from;
  Eigen::VectorXd delta(size);
  for (std::size_t i = 0; i < order.size(); ++i) {
    delta.segment<kState>(kState * static_cast<Eigen::Index>(i)) = window.frames[order[i]].delta;
    for (Eigen::Index row = 0; row < kState; ++row) {
      from.push_back(kState * static_cast<Eigen::Index>(order[i]) + row);
    }
  }
  delta.tail(globals) = window.globalDelta();
  for (Eigen::Index row = 0; row < globals; ++row) {
    from.push_back(system.reducedH().rows() - globals + row);
  }
  const Eigen::MatrixXd full = system.reducedH().selfadjointView<Eigen::Lower>();
  const Eigen::MatrixXd H = full(from, from);
  const Eigen::VectorXd b = system.reducedB()(from) - H * delta;

  // 2. The frame itself is eliminated.
  Matrix15d leaving = H.topLeftCorner<kState, kState>();
  leaving.diagonal() *= 1.0 + 1e-12;
  const Eigen::LDLT<Matrix15d> ldlt(leaving);
  const Eigen::Index rest = size - kState;
  FrameConditional conditional;
  conditional.frame_id = frame_id;
  conditional.t_ns = window.frames[index].t_ns;
  conditional.lin_state = window.frames[index].lin_state;
  conditional.gain = ldlt.solve(H.topRightCorner(kState, rest));
  conditional.offset = ldlt.solve(Vector15d(b.head<kState>()));
  WindowPrior prior;
  for (std::size_t i = 1; i < order.size(); ++i)
    prior.frame_ids.push_back(window.frames[order[i]].id);
  conditional.frame_ids = prior.frame_ids;
  prior.H = H.bottomRightCorner(rest, rest);
  prior.H.noalias() -= H.bottomLeftCorner(rest, kState) * conditional.gain;
  prior.H = 0.5 * (prior.H + prior.H.transpose()).eval();
  prior.b = b.tail(rest) - H.bottomLeftCorner(rest, kState) * conditional.offset;
  window.prior = std::move(prior);

  // 3. What has been used is erased.
  if (window.start.frame_id == frame_id) window.start.frame_id = -1;
  if (index + 1 < window.frames.size()) window.frames[index + 1].imu.reset();
  for (const WindowFeature* feature : landmarks) window.features.erase(feature->id);
  for (WindowFrame& frame : window.frames) {
    if (frame.still_since == frame_id && frame.id != frame_id) frame.still_since = frame.id;
  }
  eraseObservations(window, frame_id);
  window.frames.erase(window.frames.begin() + static_cast<std::ptrdiff_t>(index));
  return conditional;
}

void dropFrame(Window& window, int frame_id, const Preintegration& imu) {
  const int found = window.indexOf(frame_id);
  PARKADE_CHECK(found > 0 && found + 1 < static_cast<int>(window.frames.size()),
                "frame {} has no neighbours in the window", frame_id);
  const auto index = static_cast<std::size_t>(found);
  eraseObservations(window, frame_id);
  WindowFrame& next = window.frames[index + 1];
  next.imu = imu;
  next.imu_sqrt_information = sqrtInformation(imu);
  window.frames.erase(window.frames.begin() + static_cast<std::ptrdiff_t>(index));
}

}  // namespace parkade
