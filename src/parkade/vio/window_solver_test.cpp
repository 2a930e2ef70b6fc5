// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/window_solver.hpp"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/core/median.hpp"
#include "parkade/core/random.hpp"
#include "parkade/geometry/test_support.hpp"
#include "parkade/imu/reading_buffer.hpp"
#include "parkade/vio/feature_manager.hpp"
#include "parkade/vio/marginalisation.hpp"
#include "parkade/vio/reprojection.hpp"
#include "parkade/vio/track_simulator.hpp"

namespace parkade {
namespace {

constexpr int kState = 15;

// A short window at true states, with features placed, all from a simulated drive.
Window makeWindow(int count, double pixel_sigma, std::vector<WindowFeature*>& features) {
  testing::TrackSimulatorOptions options;
  options.length = 12.0;
  options.stops = {};
  options.initial_rest = 0.0;
  options.start_speed = 1.0;
  options.tracks_per_camera = 30;
  options.pixel_sigma = pixel_sigma;
  const testing::SimulatedDrive drive = simulateDrive(testing::surroundRig(), options);
  Window window;
  const SE3 T_imu_vehicle = drive.rig.imu.T_vehicle_imu.inverse();
  window.T_imu_vehicle = T_imu_vehicle;
  for (const RigCamera& camera : drive.rig.cameras) {
    window.cameras.push_back({camera.camera, T_imu_vehicle * camera.T_vehicle_cam});
  }
  ReadingBuffer readings;
  for (const ImuSample& s : drive.imu) (void)readings.add({s.t_ns, s.gyro, s.accel});
  FeatureManager manager{VioOptions{}};
  for (int i = 0; i < count; ++i) {
    const TrackSet& tracks = drive.frames[static_cast<std::size_t>(2 * i)];
    const SE3 T = drive.truthAt(tracks.t_ns) * drive.rig.imu.T_vehicle_imu;
    WindowFrame frame;
    frame.id = i;
    frame.t_ns = tracks.t_ns;
    frame.keyframe = true;
    frame.state.R_odom_imu = T.rotation();
    frame.state.p_odom = T.translation();
    const double h = 1e-3;
    frame.state.v_odom =
        ((drive.truthAt(tracks.t_ns + fromSeconds(h)) * drive.rig.imu.T_vehicle_imu).translation() -
         (drive.truthAt(tracks.t_ns - fromSeconds(h)) * drive.rig.imu.T_vehicle_imu)
             .translation()) /
        (2.0 * h);
    if (i > 0) {
      Preintegration sum(ImuNoise{}, ImuBias{});
      sum.integrate(readings.between(window.frames.back().t_ns, frame.t_ns), kNsPerSecond);
      frame.imu = sum;
      frame.imu_sqrt_information = sqrtInformation(sum);
    }
    window.frames.push_back(frame);
    manager.add(window, FeatureManager::observationsOf(window.cameras, tracks, i));
    if (i > 0) manager.triangulateNew(window);
  }
  window.start.frame_id = 0;
  window.start.state = window.frames.front().state;
  window.start.gravity_sigma = 0.02;
  window.start.sigma << Eigen::Vector3d::Constant(1e-3), Eigen::Vector3d::Constant(1e-3),
      Eigen::Vector3d::Zero(), Eigen::Vector3d::Constant(0.02), Eigen::Vector3d::Constant(0.1);
  features = manager.select(window);
  return window;
}

void disturb(Window& window, double scale, std::uint64_t seed) {
  Random random(seed);
  for (WindowFrame& frame : window.frames) {
    Vector15d step;
    for (int i = 0; i < kState; ++i) step(i) = scale * random.normal();
    step.tail<6>() *= 0.1;
    frame.apply(step);
  }
}

SolveOptions tightOptions() {
  SolveOptions options;
  options.max_iterations = 50;
  options.min_decrease = 1e-10;
  // The windows' biases step at will.
  options.loss.bias_step = std::numeric_limits<double>::infinity();
  return options;
}

// The same cost for Ceres: every block as it is, derivatives by its own differences.
struct FrameManifold final : ceres::Manifold {
  int AmbientSize() const override { return 16; }
  int TangentSize() const override { return kState; }
  static NavState stateOf(const double* x) {
    NavState state;
    state.p_odom = Eigen::Vector3d(x[0], x[1], x[2]);
    state.R_odom_imu = SO3(Eigen::Quaterniond(x[6], x[3], x[4], x[5]));
    state.v_odom = Eigen::Vector3d(x[7], x[8], x[9]);
    return state;
  }
  static ImuBias biasOf(const double* x) {
    return {Eigen::Vector3d(x[10], x[11], x[12]), Eigen::Vector3d(x[13], x[14], x[15])};
  }
  static void store(const WindowFrame& frame, double* x) {
    Eigen::Matrix<double, 16, 1> all;
    const Eigen::Quaterniond& q = frame.state.R_odom_imu.quaternion();
    all << frame.state.p_odom, q.x(), q.y(), q.z(), q.w(), frame.state.v_odom, frame.bias.gyro,
        frame.bias.accel;
    std::copy(all.data(), all.data() + 16, x);
  }
  bool Plus(const double* x, const double* delta, double* x_plus) const override {
    WindowFrame frame;
    frame.state = stateOf(x);
    frame.bias = biasOf(x);
    frame.apply(Eigen::Map<const Vector15d>(delta));
    store(frame, x_plus);
    return true;
  }
  bool PlusJacobian(const double* x, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 16, kState, Eigen::RowMajor>> J(jacobian);
    for (int i = 0; i < kState; ++i) {
      Vector15d step = Vector15d::Zero();
      Eigen::Matrix<double, 16, 1> above;
      Eigen::Matrix<double, 16, 1> below;
      step(i) = 1e-7;
      Plus(x, step.data(), above.data());
      step(i) = -1e-7;
      Plus(x, step.data(), below.data());
      J.col(i) = (above - below) / 2e-7;
    }
    return true;
  }
  bool Minus(const double*, const double*, double*) const override { return false; }
  bool MinusJacobian(const double*, double*) const override { return false; }
};

struct ImuCost {
  WindowFrame end;
  bool operator()(const double* a, const double* b, const double* g, double* residual) const {
    WindowFrame begin;
    begin.state = FrameManifold::stateOf(a);
    begin.bias = FrameManifold::biasOf(a);
    WindowFrame last = end;
    last.state = FrameManifold::stateOf(b);
    last.bias = FrameManifold::biasOf(b);
    WindowGravity gravity;
    gravity.apply({g[0], g[1]});
    Eigen::Map<Vector15d>{residual} = imuResidual(begin, last, gravity);
    return true;
  }
};

struct StartCost {
  StartPrior prior;
  bool operator()(const double* a, double* residual) const {
    WindowFrame frame;
    frame.state = FrameManifold::stateOf(a);
    frame.bias = FrameManifold::biasOf(a);
    Eigen::Map<Vector15d>{residual} = startResidual(frame, prior);
    return true;
  }
};

struct GravityCost {
  StartPrior prior;
  bool operator()(const double* g, double* residual) const {
    WindowGravity gravity;
    gravity.apply({g[0], g[1]});
    Eigen::Map<Eigen::Vector2d>{residual} = gravityResidual(gravity, prior);
    return true;
  }
};

struct PixelCost {
  const VioCamera* anchor_camera;
  const VioCamera* target_camera;
  Eigen::Vector3d direction;
  WindowObservation observation;
  bool same_frame;
  bool operator()(const double* a, const double* t, const double* l, double* residual) const {
    const PoseMatrices anchor(FrameManifold::stateOf(a));
    const PoseMatrices target(FrameManifold::stateOf(same_frame ? a : t));
    const Eigen::Vector3d d =
        (direction + tangentBasis(direction) * Eigen::Vector2d(l[0], l[1])).normalized();
    Eigen::Vector2d pixel;
    if (!reproject(*anchor_camera, *target_camera, target_camera->T_imu_cam, anchor, target, anchor,
                   target, d, l[2], pixel)) {
      return false;
    }
    Eigen::Map<Eigen::Vector2d>{residual} = (pixel - observation.pixel) / observation.sigma_px;
    return true;
  }
};

struct DistanceCost {
  bool operator()(const double* l, double* residual) const {
    residual[0] = std::sqrt(kPriorInverseDistanceInformation) * (l[2] - kPriorInverseDistance);
    return true;
  }
};

TEST(WindowSolver, FindsTheMinimumThatCeresFinds) {
  std::vector<WindowFeature*> features;
  Window window = makeWindow(4, 0.5, features);
  ASSERT_GT(features.size(), 60U);
  disturb(window, 0.01, 2);

  std::vector<Eigen::Matrix<double, 16, 1>> x(window.frames.size());
  std::vector<Eigen::Vector3d> landmarks(features.size());
  ceres::Problem problem;
  for (std::size_t i = 0; i < x.size(); ++i) {
    FrameManifold::store(window.frames[i], x[i].data());
    problem.AddParameterBlock(x[i].data(), 16, new FrameManifold);
  }
  problem.AddResidualBlock(new ceres::NumericDiffCostFunction<StartCost, ceres::CENTRAL, 15, 16>(
                               new StartCost{window.start}),
                           nullptr, x[0].data());
  Eigen::Vector2d gravity = Eigen::Vector2d::Zero();
  problem.AddResidualBlock(new ceres::NumericDiffCostFunction<GravityCost, ceres::CENTRAL, 2, 2>(
                               new GravityCost{window.start}),
                           nullptr, gravity.data());
  for (std::size_t i = 1; i < x.size(); ++i) {
    problem.AddResidualBlock(
        new ceres::NumericDiffCostFunction<ImuCost, ceres::CENTRAL, 15, 16, 16, 2>(
            new ImuCost{window.frames[i]}),
        nullptr, x[i - 1].data(), x[i].data(), gravity.data());
  }
  const SolveOptions options = tightOptions();
  for (std::size_t f = 0; f < features.size(); ++f) {
    const WindowFeature& feature = *features[f];
    landmarks[f] = {0.0, 0.0, feature.inverse_distance};
    problem.AddResidualBlock(
        new ceres::NumericDiffCostFunction<DistanceCost, ceres::CENTRAL, 1, 3>(new DistanceCost),
        nullptr, landmarks[f].data());
    const auto a = static_cast<std::size_t>(window.indexOf(feature.anchor_frame_id));
    for (const WindowObservation& o : feature.observations) {
      const auto t = static_cast<std::size_t>(window.indexOf(o.frame_id));
      auto* functor = new PixelCost{
          &window.cameras[static_cast<std::size_t>(feature.anchor_camera)],
          &window.cameras[static_cast<std::size_t>(o.camera)], feature.direction, o, a == t};
      // A block may appear once only: within one frame set the second is another frame, unused.
      const std::size_t second = a != t ? t : (a + 1) % x.size();
      problem.AddResidualBlock(
          new ceres::NumericDiffCostFunction<PixelCost, ceres::CENTRAL, 2, 16, 16, 3>(functor),
          new ceres::HuberLoss(options.loss.views.scale), x[a].data(), x[second].data(),
          landmarks[f].data());
    }
  }
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::DENSE_SCHUR;
  ceres_options.max_num_iterations = 100;
  ceres_options.function_tolerance = 1e-14;
  ceres_options.parameter_tolerance = 1e-14;
  ceres::Solver::Summary ceres_summary;
  ceres::Solve(ceres_options, &problem, &ceres_summary);

  const SolveSummary summary = solveWindow(window, features, options);
  ASSERT_TRUE(summary.ok);
  WindowGravity found;
  found.apply(gravity);
  EXPECT_LT((found.vector - window.gravity.vector).norm(), 1e-3);
  EXPECT_GT(gravity.norm(), 1e-4) << "the case does not move gravity";
  EXPECT_NEAR(summary.initial_cost, ceres_summary.initial_cost, 1e-3 * summary.initial_cost);
  EXPECT_NEAR(summary.final_cost, ceres_summary.final_cost, 1e-4 * ceres_summary.final_cost);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const NavState other = FrameManifold::stateOf(x[i].data());
    EXPECT_LT((other.p_odom - window.frames[i].state.p_odom).norm(), 2e-5) << i;
    EXPECT_LT(angleBetween(other.R_odom_imu, window.frames[i].state.R_odom_imu), 1e-5) << i;
    EXPECT_LT((other.v_odom - window.frames[i].state.v_odom).norm(), 1e-4) << i;
  }
}

TEST(WindowSolver, TakesALastStepBackThatIsWorse) {
  std::vector<WindowFeature*> features;
  Window window = makeWindow(4, 0.5, features);
  Random random(5);
  for (std::size_t i = 0; i < window.frames.size(); ++i) {
    WindowFrame& frame = window.frames[i];
    Vector15d step = Vector15d::Zero();
    for (int k = 0; i > 0 && k < 3; ++k) step(k) = 0.02 * random.normal();
    frame.apply(step);
    // Jacobians are taken in axes turned by 3 rad, so that steps go the wrong way.
    const NavState state = frame.state;
    frame.fixLinearisation();
    const SO3 turn = SO3::exp(Eigen::Vector3d(0.0, 0.0, 3.0));
    frame.lin_state.R_odom_imu = turn * state.R_odom_imu;
    frame.lin_state.p_odom = turn * state.p_odom;
    frame.lin_state.v_odom = turn * state.v_odom;
    frame.delta.head<3>() = state.p_odom - frame.lin_state.p_odom;
    frame.delta.segment<3>(3) = (frame.lin_state.R_odom_imu.inverse() * state.R_odom_imu).log();
    frame.delta.segment<3>(6) = state.v_odom - frame.lin_state.v_odom;
  }
  SolveOptions options;
  options.max_iterations = 3;  // the second step is worse, and so is the last
  const auto cost = [&] {
    FactorSelection selection = FactorSelection::all(window);
    selection.features = features;
    LinearSystem system(options.loss, options.still);
    return system.linearise(window, selection);
  };
  const double before = cost();
  const Window start = window;
  std::vector<WindowFeature> start_features;
  for (const WindowFeature* f : features) start_features.push_back(*f);
  (void)solveWindow(window, features, options);
  EXPECT_LE(cost(), before + options.min_decrease);
  window = start;
  for (std::size_t i = 0; i < features.size(); ++i) *features[i] = start_features[i];
  options.max_iterations = 2;  // no step was worse before: the last is not looked back at
  (void)solveWindow(window, features, options);
  EXPECT_GT(cost(), 1.5 * before) << "the case has no step that is worse";
}

class WindowGradient : public ::testing::TestWithParam<bool> {};

TEST_P(WindowGradient, IsThatOfTheCost) {
  std::vector<WindowFeature*> features;
  Window window = makeWindow(3, 0.5, features);
  if (GetParam()) {
    for (auto& [id, feature] : window.features) {
      for (WindowObservation& o : feature.observations) {
        const VioCamera& camera = window.cameras[static_cast<std::size_t>(o.camera)];
        o.row_share = rowTimeOf(1.0, o.pixel.y(), camera.camera.height());
      }
    }
    for (VioCamera& camera : window.cameras) {
      camera.readout_time = 0.01;
      CameraRefinement refinement;
      refinement.prior_readout_time = 0.012;
      refinement.prior_T_imu_cam =
          camera.T_imu_cam *
          SE3(SO3::exp(Eigen::Vector3d(0.001, 0.002, -0.001)), Eigen::Vector3d(0.001, 0.0, 0.002));
      refinement.sigma.setConstant(0.01);
      window.refinements.push_back(refinement);
    }
  }
  disturb(window, 0.002, 3);
  features.resize(20);
  FactorSelection selection = FactorSelection::all(window);
  selection.features = features;
  const StillSigma still;
  const WindowLoss loss{{RobustLoss::Kernel::kCauchy, 0.6}};
  LinearSystem system(loss, still);
  system.linearise(window, selection);
  const auto costAt = [&](const Eigen::VectorXd& step) {
    Window other = window;
    for (std::size_t i = 0; i < other.frames.size(); ++i) {
      other.frames[i].apply(step.segment<kState>(kState * static_cast<Eigen::Index>(i)));
    }
    other.applyGlobals(step.tail(window.globalSize()));
    LinearSystem at(loss, still);
    return at.linearise(other, selection);
  };
  const double h = 1e-6;
  const Eigen::Index size = kState * 3 + window.globalSize();
  for (Eigen::Index i = 0; i < size; ++i) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
    step(i) = h;
    const double above = costAt(step);
    step(i) = -h;
    const double slope = (above - costAt(step)) / (2.0 * h);
    // How the car moves while rows are read counts as known.
    if (GetParam() && i < size - window.globalSize()) continue;
    EXPECT_NEAR(system.gradient()(i), slope, 2e-4 * std::abs(slope) + 0.5) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Calibration, WindowGradient, ::testing::Values(false, true));

TEST(Marginalisation, PriorStandsForWhatLeft) {
  // With exact pixels and readings the point of linearisation is the minimum: what is left after a
  // frame has gone must know as much as before of the frames that stay.
  std::vector<WindowFeature*> features;
  Window window = makeWindow(5, 0.0, features);
  const SolveOptions options = tightOptions();
  (void)solveWindow(window, features, options);
  const SolveSummary before = solveWindow(window, features, options);
  std::vector<WindowFeature*> gone;
  std::vector<WindowFeature*> rest;
  for (WindowFeature* feature : features) {
    (feature->observations.front().frame_id == 0 ? gone : rest).push_back(feature);
  }
  const FrameConditional conditional =
      marginaliseFrame(window, 0, gone, options.loss, options.still);
  EXPECT_EQ(window.frames.front().id, 1);
  EXPECT_EQ(conditional.frame_ids.size() * 15 + 2,
            static_cast<std::size_t>(conditional.gain.cols()));
  const SolveSummary after = solveWindow(window, rest, options);
  const Eigen::VectorXd sigma_before = before.newest_covariance.diagonal().cwiseSqrt();
  const Eigen::VectorXd sigma_after = after.newest_covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < kState; ++i) {
    EXPECT_NEAR(sigma_after(i) / sigma_before(i), 1.0, 1e-3) << i;
  }
}

TEST(Marginalisation, PriorPullsBackAsTheFullProblemDoes) {
  std::vector<WindowFeature*> features;
  Window window = makeWindow(4, 0.3, features);
  const SolveOptions options = tightOptions();
  (void)solveWindow(window, features, options);
  const std::vector<WindowFrame> solved = window.frames;
  std::vector<WindowFeature*> gone;
  std::vector<WindowFeature*> rest;
  for (WindowFeature* feature : features) {
    (feature->observations.front().frame_id == 0 ? gone : rest).push_back(feature);
  }
  (void)marginaliseFrame(window, 0, gone, options.loss, options.still);
  disturb(window, 1e-3, 8);
  (void)solveWindow(window, rest, options);
  for (std::size_t i = 0; i < window.frames.size(); ++i) {
    EXPECT_LT((window.frames[i].state.p_odom - solved[i + 1].state.p_odom).norm(), 1e-4) << i;
    EXPECT_LT(angleBetween(window.frames[i].state.R_odom_imu, solved[i + 1].state.R_odom_imu),
              1e-4);
  }
}

TEST(FeatureManager, LandmarksThatAllViewsMissCountLess) {
  std::vector<WindowFeature*> features;
  Window window = makeWindow(6, 0.5, features);
  ASSERT_GT(features.size(), 60U);
  // The views of every tenth err by four times as much, and are told with twice the sigma, lest
  // they pass for outliers.
  Random random(7);
  const auto isWorse = [](std::size_t k) { return k % 10 == 3; };
  for (std::size_t k = 0; k < features.size(); ++k) {
    if (!isWorse(k)) continue;
    for (WindowObservation& o : features[k]->observations) {
      o.pixel.x() += 2.0 * random.normal();
      o.pixel.y() += 2.0 * random.normal();
      o.sigma_px = 1.0;
    }
  }
  ASSERT_TRUE(solveWindow(window, features, tightOptions()).ok);
  FeatureManager manager{VioOptions{}};
  manager.rejectOutliers(window, features);
  std::vector<double> usual;
  std::vector<double> worse;
  for (std::size_t k = 0; k < features.size(); ++k) {
    if (features[k]->observations.size() < 4) continue;
    EXPECT_GE(features[k]->noise_factor, 0.7);
    (isWorse(k) ? worse : usual).push_back(features[k]->noise_factor);
  }
  ASSERT_GT(worse.size(), 4U);
  EXPECT_NEAR(median(usual), 1.0, 0.2);
  EXPECT_GT(median(worse), 1.5);
}

TEST(LandmarkCovariance, FollowsTheLandmarksNoise) {
  std::vector<WindowFeature*> features;
  Window window = makeWindow(6, 0.5, features);
  ASSERT_TRUE(solveWindow(window, features, tightOptions()).ok);
  WindowFeature& feature = *features.front();
  const Eigen::Matrix3d usual = landmarkCovariance(window, feature);
  EXPECT_GT(usual.trace(), 0.0);
  feature.noise_factor = 2.0;
  EXPECT_NEAR(landmarkCovariance(window, feature).trace() / usual.trace(), 4.0, 0.1);
}

}  // namespace
}  // namespace parkade
