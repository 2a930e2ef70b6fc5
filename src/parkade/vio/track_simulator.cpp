// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/track_simulator.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "parkade/core/random.hpp"
#include "parkade/core/units.hpp"
#include "parkade/vio/rig_error.hpp"

namespace parkade::testing {
namespace {

using Eigen::Vector3d;

constexpr double kPoseInterval = 0.2;  // s between the poses that the true motion passes through
constexpr double kPad = 1.0;           // s of motion before the first frame and after the last
const Vector3d kGravity(0.0, 0.0, -9.81);

// Turns of 90 degrees, left and right, with straights between; smooth along the way.
double curvatureAt(double s) {
  constexpr double kRadius = 7.0;
  constexpr double kTurn = 0.5 * std::numbers::pi * kRadius;
  constexpr double kStraight = 16.0;
  const int leg = static_cast<int>(std::floor(s / (kStraight + kTurn)));
  const double along = s - leg * (kStraight + kTurn) - kStraight;
  if (s < 0.0 || along < 0.0) return 0.0;
  static constexpr double kSigns[] = {1.0, 1.0, -1.0, -1.0, -1.0, 1.0, 1.0, -1.0};
  // sin^2 has the mean 1/2.
  const double shape = std::sin(std::numbers::pi * along / kTurn);
  return kSigns[leg % 8] * 2.0 * shape * shape / kRadius;
}

struct Plan {
  std::vector<SE3> poses;
  double distance = 0.0;
};

Plan planMotion(const TrackSimulatorOptions& options) {
  constexpr double kStep = 0.005;
  constexpr double kAcceleration = 1.2;
  Plan plan;
  double s = 0.0;
  double yaw = 0.0;
  double x = 0.0;
  double y = 0.0;
  double v = options.start_speed;
  double a = 0.0;
  std::size_t stop = 0;
  double rest = options.initial_rest + (options.start_speed > 0.0 ? 0.0 : kPad);
  double final_rest = 0.0;
  const int every = static_cast<int>(std::lround(kPoseInterval / kStep));
  for (int i = 0; final_rest < options.final_rest + kPad; ++i) {
    if (i % every == 0) {
      // The body pitches and rolls a little on its suspension.
      const double pitch = -0.006 * a + 0.004 * std::sin(0.35 * s);
      const double roll = 0.006 * v * v * curvatureAt(s) + 0.003 * std::sin(0.23 * s);
      plan.poses.emplace_back(SO3::fromYawPitchRoll(yaw, pitch, roll), Vector3d(x, y, 0.0));
    }
    const bool stop_ahead = stop < options.stops.size() && options.stops[stop] < options.length;
    const double goal = stop_ahead ? options.stops[stop] : options.length;
    double wanted = std::min(options.max_speed,
                             std::sqrt(1.5 / std::max(std::abs(curvatureAt(s + 2.0)), 0.05)));
    wanted = std::min(wanted, std::sqrt(std::max(0.0, 1.6 * (goal - s))));
    if (rest > 0.0) {
      rest -= kStep;
      wanted = 0.0;
    }
    double target = std::clamp((wanted - v) * 2.0, -kAcceleration, kAcceleration);
    a += std::clamp(target - a, -options.max_jerk * kStep, options.max_jerk * kStep);
    v = std::max(0.0, v + a * kStep);
    if (rest > 0.0 || (goal - s < 0.02 && v < 0.05)) {
      v = 0.0;
      a = 0.0;
      if (rest <= 0.0 && stop_ahead) {
        ++stop;
        rest = options.stop_duration;
      } else if (rest <= 0.0) {
        final_rest += kStep;
      }
    }
    const double middle_yaw = yaw + 0.5 * v * kStep * curvatureAt(s);
    yaw += v * kStep * curvatureAt(s);
    x += v * kStep * std::cos(middle_yaw);
    y += v * kStep * std::sin(middle_yaw);
    s += v * kStep;
  }
  plan.distance = s;
  return plan;
}

// Points on walls, floor, ceiling and pillars beside the way.
std::vector<Vector3d> buildGarage(const SplineSE3& truth, double distance, Random& random) {
  std::vector<Vector3d> points;
  const double end = toSeconds(truth.endNs() - truth.startNs());
  double next = 0.0;
  double along = 0.0;
  Vector3d last = truth.atSeconds(0.0).T_world_body.translation();
  const auto addAround = [&](const SE3& T, double ahead) {
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const double kind = random.uniform();
    Vector3d p(ahead + random.uniform(-0.5, 0.5), 0.0, 0.0);
    if (kind < 0.4) {
      p.y() = side * (random.chance(0.5) ? 7.0 : 4.5);
      p.z() = random.uniform(0.0, 2.6);
    } else if (kind < 0.55) {
      p.y() = random.uniform(-6.0, 6.0);
    } else if (kind < 0.75) {
      p.y() = random.uniform(-6.0, 6.0);
      p.z() = 2.6;
    } else {
      p.y() = side * (3.0 + random.uniform(-0.25, 0.25));
      p.z() = random.uniform(0.0, 2.6);
    }
    points.push_back(T * p);
  };
  for (double t = 0.0; t < end; t += 0.02) {
    const SE3 T = truth.atSeconds(t).T_world_body;
    along += (T.translation() - last).norm();
    last = T.translation();
    while (next <= along) {
      for (int k = 0; k < 90; ++k) addAround(T, 0.0);
      next += 1.0;
    }
  }
  // Beyond both ends of the way.
  for (int metre = 1; metre < 15; ++metre) {
    for (int k = 0; k < 90; ++k) {
      addAround(truth.atSeconds(0.0).T_world_body, -metre);
      addAround(truth.atSeconds(end).T_world_body, metre);
    }
  }
  (void)distance;
  return points;
}

struct ActiveTrack {
  std::uint64_t id = 0;
  int age = 0;
};

// Follows points from frame to frame, camera by camera.
class TrackMaker {
 public:
  TrackMaker(const Rig& rig, const std::vector<Vector3d>& points,
             const TrackSimulatorOptions& options, Random random)
      : rig_(rig), points_(points), options_(options), random_(std::move(random)) {
    active_.resize(rig.cameras.size());
    for (std::size_t i = 0; i < points.size(); ++i) grid_[cell(points[i])].push_back(i);
  }

  /// T_world_vehicle: by the time after the frame's instant, s.
  TrackSet make(TimeNs t_ns, const std::function<SE3(double)>& T_world_vehicle_at) {
    const SE3 T_world_vehicle = T_world_vehicle_at(0.0);
    TrackSet set;
    set.t_ns = t_ns;
    set.camera_ok.assign(rig_.cameras.size(), 1);
    const std::vector<std::size_t> near = pointsNear(T_world_vehicle.translation());
    std::vector<std::map<std::size_t, Eigen::Vector2d>> visible(rig_.cameras.size());
    for (std::size_t c = 0; c < rig_.cameras.size(); ++c) {
      const SE3 T_cam_world = (T_world_vehicle * rig_.cameras[c].T_vehicle_cam).inverse();
      for (const std::size_t i : near) {
        const Vector3d p_cam = T_cam_world * points_[i];
        Eigen::Vector2d pixel;
        if (p_cam.norm() > 0.6 && p_cam.norm() < options_.max_range &&
            rig_.cameras[c].camera.project(p_cam, pixel) &&
            rollOn(rig_.cameras[c], points_[i], T_world_vehicle_at, pixel) &&
            rig_.cameras[c].camera.inImage(pixel, 4.0)) {
          visible[c].emplace(i, pixel);
        }
      }
    }
    for (std::size_t c = 0; c < rig_.cameras.size(); ++c) {
      follow(c, visible[c]);
      refill(c, visible[c]);
    }
    for (std::size_t c = 0; c < rig_.cameras.size(); ++c) {
      std::map<std::uint64_t, TrackObservation> ordered;
      for (const auto& [point, track] : active_[c]) {
        TrackObservation o;
        o.id = track.id;
        o.camera = static_cast<int>(c);
        o.age = track.age;
        o.sigma_px = options_.pixel_sigma > 0.0 ? options_.pixel_sigma : 0.5;
        o.pixel = visible[c].at(point);
        o.pixel += options_.pixel_sigma * Eigen::Vector2d(random_.normal(), random_.normal());
        ordered.emplace(o.id, o);
      }
      for (const auto& [id, o] : ordered) set.observations.push_back(o);
    }
    return set;
  }

 private:
  // To where a rolling shutter has a point: at the row that is read as it shows there.
  static bool rollOn(const RigCamera& camera, const Vector3d& point,
                     const std::function<SE3(double)>& T_world_vehicle_at, Eigen::Vector2d& pixel) {
    for (int i = 0; i < 4 && camera.readout_time > 0.0; ++i) {
      const SE3 T_world_cam = T_world_vehicle_at(camera.rowTime(pixel.y())) * camera.T_vehicle_cam;
      if (!camera.camera.project(T_world_cam.inverse() * point, pixel)) return false;
    }
    return true;
  }
  using Cell = std::pair<int, int>;
  static Cell cell(const Vector3d& p) {
    return {static_cast<int>(std::floor(p.x() / 5.0)), static_cast<int>(std::floor(p.y() / 5.0))};
  }
  std::vector<std::size_t> pointsNear(const Vector3d& p) const {
    std::vector<std::size_t> near;
    const auto [cx, cy] = cell(p);
    for (int x = cx - 4; x <= cx + 4; ++x) {
      for (int y = cy - 4; y <= cy + 4; ++y) {
        const auto it = grid_.find({x, y});
        if (it != grid_.end()) near.insert(near.end(), it->second.begin(), it->second.end());
      }
    }
    return near;
  }
  void follow(std::size_t c, const std::map<std::size_t, Eigen::Vector2d>& visible) {
    for (auto it = active_[c].begin(); it != active_[c].end();) {
      if (visible.count(it->first) == 0 || random_.chance(1.0 / options_.mean_lifetime)) {
        it = active_[c].erase(it);
      } else {
        ++it->second.age;
        ++it;
      }
    }
  }
  void refill(std::size_t c, const std::map<std::size_t, Eigen::Vector2d>& visible) {
    std::vector<std::size_t> fresh;
    for (const auto& [point, pixel] : visible) {
      if (active_[c].count(point) == 0) fresh.push_back(point);
    }
    random_.shuffle(fresh);
    // A front end looks for the features of neighbour cameras first.
    std::stable_partition(fresh.begin(), fresh.end(), [&](std::size_t point) {
      for (std::size_t other = 0; other < active_.size(); ++other) {
        if (other != c && active_[other].count(point) != 0)
          return random_.chance(options_.match_rate);
      }
      return false;
    });
    for (const std::size_t point : fresh) {
      if (static_cast<int>(active_[c].size()) >= options_.tracks_per_camera) break;
      ActiveTrack track;
      track.age = 1;
      // A feature that a neighbour camera follows is matched to it.
      for (std::size_t other = 0; other < active_.size() && track.id == 0; ++other) {
        const auto it = active_[other].find(point);
        if (other != c && it != active_[other].end()) {
          track.id = it->second.id;
        }
      }
      if (track.id == 0) track.id = ++last_id_;
      active_[c].emplace(point, track);
    }
  }

  const Rig& rig_;
  const std::vector<Vector3d>& points_;
  TrackSimulatorOptions options_;
  Random random_;
  std::vector<std::map<std::size_t, ActiveTrack>> active_;
  std::map<Cell, std::vector<std::size_t>> grid_;
  std::uint64_t last_id_ = 0;
};

std::vector<ImuSample> makeImu(const Rig& rig, const SplineSE3& truth, TimeNs begin_ns,
                               TimeNs end_ns, const TrackSimulatorOptions& options,
                               Random& random) {
  const auto normals = [&] { return Vector3d(random.normal(), random.normal(), random.normal()); };
  const double noise = options.imu_noise ? 1.0 : 0.0;
  Vector3d bias_gyro = noise * options.bias_gyro_sigma * normals();
  Vector3d bias_accel = noise * options.bias_accel_sigma * normals();
  const double root_rate = std::sqrt(options.imu_rate);
  const SE3 T_vehicle_imu = rig.imu.T_vehicle_imu;
  std::vector<ImuSample> samples;
  for (TimeNs t = begin_ns; t <= end_ns; t += fromSeconds(1.0 / options.imu_rate)) {
    const SplineSE3::Sample s = truth.at(t);
    const Vector3d& w = s.angular_velocity_body;
    const Vector3d lever = T_vehicle_imu.translation();
    const Vector3d accel_body =
        s.T_world_body.rotation().inverse() * Vector3d(s.acceleration_world - kGravity) +
        s.angular_acceleration_body.cross(lever) + w.cross(w.cross(lever));
    ImuSample sample;
    sample.t_ns = t;
    sample.gyro = T_vehicle_imu.rotation().inverse() * w + bias_gyro +
                  noise * rig.imu.gyroscope_noise_density * root_rate * normals();
    sample.accel = T_vehicle_imu.rotation().inverse() * accel_body + bias_accel +
                   noise * rig.imu.accelerometer_noise_density * root_rate * normals();
    bias_gyro += noise * rig.imu.gyroscope_random_walk / root_rate * normals();
    bias_accel += noise * rig.imu.accelerometer_random_walk / root_rate * normals();
    samples.push_back(sample);
  }
  return samples;
}

SE3 lookAt(const Vector3d& position, double yaw_deg, double pitch_down_deg) {
  Eigen::Matrix3d R_forward;  // camera axes (right, down, forward) in a frame that looks along x
  R_forward << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return {SO3::fromYawPitchRoll(yaw_deg * kDegree, pitch_down_deg * kDegree, 0.0) * SO3(R_forward),
          position};
}

}  // namespace

Rig surroundRig() {
  Rig rig;
  rig.name = "surround";
  PinholeRadtan::Parameters p;
  p.fx = p.fy = 268.5;
  p.cx = 319.5;
  p.cy = 199.5;
  const Camera camera(PinholeRadtan(p), 640, 400);
  const auto add = [&](const char* name, const Vector3d& position, double yaw_deg) {
    RigCamera c;
    c.name = name;
    c.camera = camera;
    c.T_vehicle_cam = lookAt(position, yaw_deg, 10.0);
    c.rate_hz = 10.0;
    rig.cameras.push_back(c);
  };
  add("cam0", {3.6, 0.0, 0.7}, 0.0);
  add("cam1", {2.2, 0.95, 1.0}, 60.0);
  add("cam2", {2.0, 0.98, 1.0}, 120.0);
  add("cam3", {-0.9, 0.0, 0.9}, 180.0);
  add("cam4", {2.0, -0.98, 1.0}, -120.0);
  add("cam5", {2.2, -0.95, 1.0}, -60.0);
  rig.imu.T_vehicle_imu = SE3(SO3::fromYawPitchRoll(0.02, -0.01, 0.015), Vector3d(0.9, 0.1, 0.45));
  return rig;
}

Rig stereoRig() {
  Rig rig;
  rig.name = "stereo";
  PinholeRadtan::Parameters p;
  p.fx = p.fy = 458.0;
  p.cx = 375.5;
  p.cy = 239.5;
  const Camera camera(PinholeRadtan(p), 752, 480);
  for (int i = 0; i < 2; ++i) {
    RigCamera c;
    c.name = i == 0 ? "cam0" : "cam1";
    c.camera = camera;
    c.T_vehicle_cam = lookAt({1.5, 0.055 - 0.11 * i, 1.2}, 0.0, 5.0);
    c.rate_hz = 20.0;
    rig.cameras.push_back(c);
  }
  rig.imu.T_vehicle_imu = SE3(SO3::fromYawPitchRoll(0.02, -0.01, 0.015), Vector3d(1.4, 0.0, 1.2));
  return rig;
}

SE3 SimulatedDrive::truthAt(TimeNs t_ns) const {
  const SE3 first = truth.at(frames.front().t_ns).T_world_body;
  const SE3 T_world_odom(SO3::fromYawPitchRoll(first.rotation().yaw(), 0.0, 0.0),
                         first.translation());
  return T_world_odom.inverse() * truth.at(t_ns).T_world_body;
}

SimulatedDrive simulateDrive(const Rig& rig, const TrackSimulatorOptions& options) {
  const Random random(options.seed);
  const Plan plan = planMotion(options);
  const TimeNs epoch = 1'600'000'000 * kNsPerSecond;
  SimulatedDrive drive{rig,
                       SplineSE3::through(epoch, fromSeconds(kPoseInterval), plan.poses),
                       {},
                       {},
                       plan.distance};
  Random garage_random = random.fork("garage");
  const std::vector<Vector3d> points = buildGarage(drive.truth, plan.distance, garage_random);
  Random imu_random = random.fork("imu");
  const TimeNs begin = epoch + fromSeconds(kPad);
  const TimeNs end = drive.truth.endNs() - fromSeconds(0.5 * kPad);
  drive.imu = makeImu(rig, drive.truth, begin - fromSeconds(0.1), end + fromSeconds(0.1), options,
                      imu_random);
  TrackMaker maker(rig, points, options, random.fork("tracks"));
  for (int i = 0;; ++i) {
    // Frames lie between readings.
    const TimeNs t = begin + fromSeconds(i / options.frame_rate + 0.0017);
    if (t > end) break;
    const TimeNs seen = t + fromSeconds(options.camera_delay);
    drive.frames.push_back(maker.make(
        t, [&](double later) { return drive.truth.at(seen + fromSeconds(later)).T_world_body; }));
  }
  return drive;
}

std::vector<PoseEstimate> runDrive(const SimulatedDrive& drive, VioEstimator& estimator) {
  std::vector<PoseEstimate> estimates;
  RigErrorOnWay rig_error;
  std::size_t next = 0;
  for (const TrackSet& frame : drive.frames) {
    while (next < drive.imu.size()) {
      const TimeNs t = drive.imu[next].t_ns;
      estimator.addImu(drive.imu[next++]);
      if (t >= frame.t_ns) break;
    }
    estimates.push_back(estimator.addTracks(frame));
    PoseEstimate& now = estimates.back();
    if (now.health == Health::kInitialising) continue;
    rig_error.advance(now.T_odom_vehicle, now.T_odom_vehicle, estimator.rigSigma());
    rig_error.addTo(now);
  }
  return estimates;
}

DriveScore score(const SimulatedDrive& drive, const std::vector<PoseEstimate>& estimates) {
  DriveScore result;
  double squared = 0.0;
  SE3 T_world_odom;
  for (const PoseEstimate& estimate : estimates) {
    if (estimate.health == Health::kInitialising) continue;
    const SE3 truth = drive.truthAt(estimate.t_ns);
    // Odom is fixed to the first pose.
    if (result.poses == 0) T_world_odom = truth * estimate.T_odom_vehicle.inverse();
    const SE3 T_world_vehicle = T_world_odom * estimate.T_odom_vehicle;
    const Eigen::Matrix3d R = T_world_vehicle.rotation().matrix();
    const Vector3d e = T_world_vehicle.translation() - truth.translation();
    const Vector3d turned = (T_world_vehicle.rotation() * truth.rotation().inverse()).log();
    result.end_tilt_error = std::acos(
        std::clamp((T_world_odom.rotation() * estimate.up_odom).normalized().z(), -1.0, 1.0));
    const Eigen::Matrix3d P = R * estimate.covariance.block<3, 3>(0, 0) * R.transpose();
    const Eigen::Matrix3d Q = R * estimate.covariance.block<3, 3>(3, 3) * R.transpose();
    if (result.poses == 0) {
      result.first_pose = toSeconds(estimate.t_ns - drive.frames.front().t_ns);
    }
    ++result.poses;
    squared += e.squaredNorm();
    result.max_error = std::max(result.max_error, e.norm());
    result.max_yaw_error = std::max(result.max_yaw_error, std::abs(turned.z()));
    result.end_error = e.norm();
    result.end_yaw_error = turned.z();
    result.end_nees_position = e.dot(P.ldlt().solve(e));
    result.end_nees_yaw = turned.z() * turned.z() / Q(2, 2);
    result.mean_nees_position += result.end_nees_position;
    result.mean_nees_yaw += result.end_nees_yaw;
  }
  const double count = std::max(1, result.poses);
  result.rmse = std::sqrt(squared / count);
  result.mean_nees_position /= count;
  result.mean_nees_yaw /= count;
  return result;
}

}  // namespace parkade::testing
