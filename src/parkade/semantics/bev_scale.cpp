// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/bev_scale.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"

namespace parkade {

BevImage rescaled(const BevImage& bev, double metres_per_px) {
  PARKADE_CHECK(metres_per_px > 0.0, "{} m per pixel", metres_per_px);
  const double factor = bev.geometry.metres_per_px / metres_per_px;
  const cv::Size size(static_cast<int>(std::lround(factor * bev.image.cols)),
                      static_cast<int>(std::lround(factor * bev.image.rows)));
  BevImage out;
  out.t_ns = bev.t_ns;
  out.geometry = bev.geometry;
  out.geometry.width_px = size.width;
  out.geometry.height_px = size.height;
  out.geometry.metres_per_px *= static_cast<double>(bev.image.cols) / size.width;
  cv::resize(bev.image, out.image, size, 0, 0, factor < 1.0 ? cv::INTER_AREA : cv::INTER_LINEAR);
  cv::resize(bev.valid, out.valid, size, 0, 0, factor < 1.0 ? cv::INTER_AREA : cv::INTER_NEAREST);
  out.valid = out.valid > 0;
  return out;
}

}  // namespace parkade
