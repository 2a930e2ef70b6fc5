// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/stitcher.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

BevGeometry makeGeometry(const Rig& rig, const BevOptions& options) {
  BevGeometry geometry;
  geometry.width_px = options.width_px;
  geometry.height_px = options.height_px;
  geometry.metres_per_px = options.metres_per_px;
  if (rig.vehicle) {
    const VehicleShape& car = *rig.vehicle;
    geometry.center.x() = 0.5 * (car.wheelbase + car.front_overhang - car.rear_overhang);
  }
  return geometry;
}

cv::Mat makeCarMask(const Rig& rig, const BevGeometry& geometry, double margin) {
  cv::Mat mask = cv::Mat::zeros(geometry.height_px, geometry.width_px, CV_8UC1);
  if (!rig.vehicle) return mask;
  const VehicleShape& car = *rig.vehicle;
  const double front = car.wheelbase + car.front_overhang + margin;
  const double rear = -car.rear_overhang - margin;
  const double side = 0.5 * car.width + margin;
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const Eigen::Vector2d p = geometry.toGround(Eigen::Vector2d(u, v));
      if (p.x() < front && p.x() > rear && std::abs(p.y()) < side)
        mask.at<std::uint8_t>(v, u) = 255;
    }
  }
  return mask;
}

// Adds weight * gain * picture to the sum, all of one region.
template <int kChannels>
void accumulate(const cv::Mat& picture, const cv::Mat& weight, float gain, cv::Mat sum,
                cv::Mat weight_sum) {
  for (int v = 0; v < picture.rows; ++v) {
    const std::uint8_t* in = picture.ptr<std::uint8_t>(v);
    const float* w = weight.ptr<float>(v);
    float* out = sum.ptr<float>(v);
    float* total = weight_sum.ptr<float>(v);
    for (int u = 0; u < picture.cols; ++u) {
      total[u] += w[u];
      const float scaled = w[u] * gain;
      for (int c = 0; c < kChannels; ++c) {
        out[kChannels * u + c] += scaled * static_cast<float>(in[kChannels * u + c]);
      }
    }
  }
}

template <int kChannels>
void normalise(const cv::Mat& sum, const cv::Mat& weight_sum, const cv::Mat& car_mask,
               cv::Mat& image, cv::Mat& valid) {
  for (int v = 0; v < sum.rows; ++v) {
    const float* in = sum.ptr<float>(v);
    const float* total = weight_sum.ptr<float>(v);
    const std::uint8_t* car = car_mask.ptr<std::uint8_t>(v);
    std::uint8_t* out = image.ptr<std::uint8_t>(v);
    std::uint8_t* ok = valid.ptr<std::uint8_t>(v);
    for (int u = 0; u < sum.cols; ++u) {
      const bool seen = total[u] > 0.0F && car[u] == 0;
      const float scale = seen ? 1.0F / total[u] : 0.0F;
      ok[u] = seen ? 255 : 0;
      for (int c = 0; c < kChannels; ++c) {
        out[kChannels * u + c] =
            static_cast<std::uint8_t>(std::min(255.0F, in[kChannels * u + c] * scale + 0.5F));
      }
    }
  }
}

double luma(const cv::Mat& picture, const cv::Point& at) {
  if (picture.channels() == 1) return picture.at<std::uint8_t>(at);
  const auto& bgr = picture.at<cv::Vec3b>(at);
  return 0.114 * bgr[0] + 0.587 * bgr[1] + 0.299 * bgr[2];
}

}  // namespace

BevStitcher::BevStitcher(const Rig& rig, const BevOptions& options)
    : options_(options),
      rig_(rig),
      geometry_(makeGeometry(rig, options)),
      masks_(rig.cameras.size()),
      car_mask_(makeCarMask(rig, geometry_, options.car_margin_m)),
      log_gains_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(rig.cameras.size()))),
      warped_(rig.cameras.size()) {
  for (const RigCamera& camera : rig.cameras) {
    tables_.emplace_back(camera, geometry_, options.border_px, options.max_range_m);
  }
  findOverlaps();
}

GroundTable& BevStitcher::tableOf(int camera) {
  PARKADE_CHECK(camera >= 0 && camera < static_cast<int>(tables_.size()), "camera {} of {}", camera,
                tables_.size());
  return tables_[static_cast<std::size_t>(camera)];
}

void BevStitcher::setMask(int camera, const cv::Mat& mask) {
  GroundTable& table = tableOf(camera);
  const Camera& model = rig_.cameras[static_cast<std::size_t>(camera)].camera;
  PARKADE_CHECK(mask.cols == model.width() && mask.rows == model.height(),
                "mask of {} x {}, calibration for {} x {}", mask.cols, mask.rows, model.width(),
                model.height());
  masks_[static_cast<std::size_t>(camera)] = mask;
  table.hide(mask);
  findOverlaps();
}

void BevStitcher::setReadoutTime(int camera, double seconds) {
  tableOf(camera).setReadoutTime(seconds);
  rig_.cameras[static_cast<std::size_t>(camera)].readout_time = seconds;
}

void BevStitcher::moveCamera(int camera, const SE3& T_vehicle_cam) {
  GroundTable& table = tableOf(camera);
  const auto index = static_cast<std::size_t>(camera);
  rig_.cameras[index].T_vehicle_cam = T_vehicle_cam;
  table = GroundTable(rig_.cameras[index], geometry_, options_.border_px, options_.max_range_m);
  if (!masks_[index].empty()) table.hide(masks_[index]);
  findOverlaps();
}

std::vector<double> BevStitcher::gains() const {
  std::vector<double> gains;
  for (const double log_gain : log_gains_) gains.push_back(std::exp(log_gain));
  return gains;
}

void BevStitcher::findOverlaps() {
  // A sparse grid is plenty for a mean brightness.
  constexpr int kStride = 4;
  constexpr std::size_t kFewest = 20;
  const int count = static_cast<int>(tables_.size());
  overlaps_.clear();
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      Overlap overlap{i, j, {}};
      const cv::Rect common = tables_[i].roi() & tables_[j].roi();
      for (int v = common.y; v < common.y + common.height; v += kStride) {
        for (int u = common.x; u < common.x + common.width; u += kStride) {
          const cv::Point at(u, v);
          if (car_mask_.at<std::uint8_t>(at) == 0 &&
              tables_[i].weight().at<float>(at - tables_[i].roi().tl()) > 0.0F &&
              tables_[j].weight().at<float>(at - tables_[j].roi().tl()) > 0.0F) {
            overlap.pixels.push_back(at);
          }
        }
      }
      if (overlap.pixels.size() >= kFewest) overlaps_.push_back(std::move(overlap));
    }
  }
}

void BevStitcher::updateGains(const FrameSet& frames) {
  // Least squares over the logarithms of the gains: overlapping cameras shall agree, and no gain
  // shall leave 1 without need. Equation (5).
  const auto count = static_cast<Eigen::Index>(tables_.size());
  Eigen::MatrixXd normal = 0.01 * Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  for (const Overlap& overlap : overlaps_) {
    const auto i = static_cast<std::size_t>(overlap.first);
    const auto j = static_cast<std::size_t>(overlap.second);
    if (frames.images[i].empty() || frames.images[j].empty()) continue;
    double sum_i = 0.0;
    double sum_j = 0.0;
    for (const cv::Point& at : overlap.pixels) {
      const double a = luma(warped_[i], at - tables_[i].roi().tl());
      const double b = luma(warped_[j], at - tables_[j].roi().tl());
      constexpr double kSaturated = 250.0;
      if (a > kSaturated || b > kSaturated) continue;
      sum_i += a;
      sum_j += b;
    }
    const auto pixels = static_cast<double>(overlap.pixels.size());
    if (sum_i < pixels || sum_j < pixels) continue;  // black: nothing to balance
    const double wanted = std::log(sum_j / sum_i);
    normal(overlap.first, overlap.first) += 1.0;
    normal(overlap.second, overlap.second) += 1.0;
    normal(overlap.first, overlap.second) -= 1.0;
    normal(overlap.second, overlap.first) -= 1.0;
    right[overlap.first] += wanted;
    right[overlap.second] -= wanted;
  }
  const Eigen::VectorXd solved =
      normal.ldlt().solve(right).cwiseMax(-std::log(3.0)).cwiseMin(std::log(3.0));
  const double share = has_gains_ ? options_.gain_smoothing : 1.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    // Who gave no picture keeps his: nothing tells another.
    if (frames.images[static_cast<std::size_t>(i)].empty()) continue;
    log_gains_[i] += share * (solved[i] - log_gains_[i]);
  }
  has_gains_ = true;
}

BevImage BevStitcher::stitch(const FrameSet& frames, const GroundAttitude& attitude,
                             const GroundRelief& relief, const GroundMotion& motion) {
  PARKADE_CHECK(frames.images.size() == tables_.size(), "{} images for a rig of {} cameras",
                frames.images.size(), tables_.size());
  const cv::Mat rise = reliefPicture(relief, geometry_);
  int channels = 0;
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const cv::Mat& image = frames.images[i];
    if (image.empty()) continue;
    const Camera& camera = rig_.cameras[i].camera;
    PARKADE_CHECK(image.cols == camera.width() && image.rows == camera.height(),
                  "camera {}: image of {} x {}, calibration for {} x {}", rig_.cameras[i].name,
                  image.cols, image.rows, camera.width(), camera.height());
    PARKADE_CHECK(image.depth() == CV_8U && (image.channels() == 1 || image.channels() == 3) &&
                      (channels == 0 || channels == image.channels()),
                  "camera {}: {} channels", rig_.cameras[i].name, image.channels());
    channels = image.channels();
    if (tables_[i].roi().empty()) continue;
    tables_[i].mapFor(attitude, rise, motion, map_x_, map_y_);
    cv::remap(image, warped_[i], map_x_, map_y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  }
  BevImage result;
  result.t_ns = frames.t_ns;
  result.geometry = geometry_;
  if (channels == 0) channels = 3;
  const cv::Size size(geometry_.width_px, geometry_.height_px);
  result.image.create(size, CV_8UC(channels));
  result.valid.create(size, CV_8UC1);
  if (options_.balance_gains) updateGains(frames);

  sum_.create(size, CV_32FC(channels));
  sum_.setTo(0.0);
  weight_sum_.create(size, CV_32FC1);
  weight_sum_.setTo(0.0);
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const cv::Rect& roi = tables_[i].roi();
    if (frames.images[i].empty() || roi.empty()) continue;
    const auto gain = static_cast<float>(std::exp(log_gains_[static_cast<Eigen::Index>(i)]));
    const auto add = channels == 3 ? accumulate<3> : accumulate<1>;
    add(warped_[i], tables_[i].weight(), gain, sum_(roi), weight_sum_(roi));
  }
  const auto finish = channels == 3 ? normalise<3> : normalise<1>;
  finish(sum_, weight_sum_, car_mask_, result.image, result.valid);
  return result;
}

}  // namespace parkade
