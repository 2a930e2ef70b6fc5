// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/semantic_parts.hpp"

#include <algorithm>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/pipeline/avp_slam.hpp"
#include "parkade/pipeline/fused_mapper.hpp"

namespace parkade {
namespace {

std::unique_ptr<SemanticMapper> makeMapper(const Rig& rig, const PipelineOptions& options,
                                           RunMethod method) {
  if (method == RunMethod::kAvpSlam) return std::make_unique<AvpSlam>(options.avp_slam);
  std::vector<Eigen::Vector3d> viewpoints;
  for (const RigCamera& camera : rig.cameras) {
    viewpoints.push_back(camera.T_vehicle_cam.translation());
  }
  FusedMapperOptions fusion = options.fusion;
  // What key points tell of their growth is too large; what wheels do is not.
  if (method == RunMethod::kSemantic) {
    fusion.odometry.told_share = std::max(1.0, fusion.odometry.told_share);
  }
  return std::make_unique<FusedMapper>(fusion, std::move(viewpoints));
}

}  // namespace

Result<SemanticParts> makeSemanticParts(const Rig& rig, const std::vector<cv::Mat>& masks,
                                        const PipelineOptions& options, RunMethod method) {
  PARKADE_CHECK(method != RunMethod::kVis, "key points alone use no semantics");
  auto front_end = SemanticFrontEnd::create(rig, masks, options.semantics);
  if (!front_end) return front_end.error();
  SemanticParts parts;
  parts.front_end = std::move(front_end).value();
  parts.mapper = makeMapper(rig, options, method);
  if (method != RunMethod::kFused) {
    parts.reckoning = std::make_unique<DeadReckoning>(rig.imu.T_vehicle_imu, options.reckoning);
  }
  return parts;
}

}  // namespace parkade
