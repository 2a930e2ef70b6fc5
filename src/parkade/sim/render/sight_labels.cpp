// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// Labels along lines of sight that are no camera's pixels.
#include <algorithm>

#include "parkade/core/check.hpp"
#include "parkade/sim/render/parallel.hpp"
#include "parkade/sim/render/renderer.hpp"
#include "parkade/sim/render/tile_tracer.hpp"
#include "parkade/sim/render/tracer.hpp"

namespace parkade::sim {

cv::Mat Renderer::renderSights(const cv::Mat& directions_cam, const SE3& T_world_cam,
                               const Moment& moment) const {
  PARKADE_CHECK(directions_cam.type() == CV_32FC3, "directions of type {}", directions_cam.type());
  constexpr std::uint32_t kOwnCar = 0xffffffffU;
  const Eigen::Matrix3f R_world_cam = T_world_cam.rotation().matrix().cast<float>();
  const Eigen::Vector3f eye = T_world_cam.translation().cast<float>();
  const int cols = directions_cam.cols;
  cv::Mat labels(directions_cam.size(), CV_8UC1, cv::Scalar(0));
  parallelFor(options_.threads, static_cast<std::size_t>(directions_cam.rows),
              [&](std::size_t row) {
                const FlushDenormals flush;
                const auto* in = directions_cam.ptr<float>(static_cast<int>(row));
                std::uint8_t* out = labels.ptr<std::uint8_t>(static_cast<int>(row));
                for (int begin = 0; begin < cols; begin += kPacket) {
                  RayPacket rays;
                  rays.clear(kMaskAll);
                  Eigen::Vector3f directions[kPacket];
                  const int lanes = std::min(kPacket, cols - begin);
                  bool any = false;
                  for (int k = 0; k < lanes; ++k) {
                    const float* d = in + 3 * (begin + k);
                    directions[k] = R_world_cam * Eigen::Vector3f(d[0], d[1], d[2]);
                    if (directions[k].isZero()) continue;
                    directions[k].normalize();
                    rays.set(k, eye, directions[k], kFar);
                    any = true;
                  }
                  if (!any) continue;
                  traceBoth(tracer_, moment.scene.get(), rays, false);
                  for (int k = 0; k < lanes; ++k) {
                    if (directions[k].isZero()) continue;
                    const SurfaceHit hit = hitOf(tracer_, rays, k);
                    if (hit.triangle == kNoTriangle) continue;
                    const bool own_car =
                        hit.object >= 0 &&
                        moment.objects[static_cast<std::size_t>(hit.object)].instance == kOwnCar;
                    if (own_car) continue;
                    out[begin + k] = static_cast<std::uint8_t>(
                        shader_.labelOf(hit, eye + hit.t * directions[k], moment));
                  }
                }
              });
  return labels;
}

}  // namespace parkade::sim
