// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <vector>

#include "parkade/core/options.hpp"
#include "parkade/geometry/se3.hpp"

namespace parkade {

struct FloorElevationOptions {
  double curvature_sigma = 0.003;
  double slope_sigma = 0.1;
  double max_off_m = 0.12;

  void visit(OptionVisitor& v) {
    v.field("curvature_sigma", curvature_sigma, "1/m",
            "Curvature of most of the floor, 1 sigma: 0 turns ramps and falls into planes.", 0.0,
            1.0);
    v.field("slope_sigma", slope_sigma, "ratio", "Slope of floors, 1 sigma.", 1e-4, 1.0);
    v.field("max_off_m", max_off_m, "m",
            "Landmarks further above or below the floor expected are no floor.", 0.005, 2.0);
  }
};

/// How well the body is known to stand level on the floor where no sample tells it, 1 sigma.
struct RestSigma {
  double tilt = 0.012;   ///< rad
  double height = 0.02;  ///< m
};

/// A point that may be of the floor.
struct FloorSample {
  Eigen::Vector3d p_odom = Eigen::Vector3d::Zero();
  double sigma = 0.0;  ///< m, vertical
};

/// Elevation map of the floor around the car, in odom: heights on a square lattice, bilinear
/// between its nodes, from landmarks with a prior of smoothness. docs/math/ipm.md, eqs. (9) and
/// (10); maps of elevation: Fankhauser et al., "Robot-centric elevation mapping with uncertainty
/// estimates", CLAWAR 2014.
class FloorElevation {
 public:
  explicit FloorElevation(const FloorElevationOptions& options);

  /// Moves the lattice along with the car and takes the samples. plane: (a, b, c) of
  /// z = a x + b y + c in the vehicle frame, the floor where nothing was known before.
  void update(const SE3& T_odom_vehicle, const Eigen::Vector3d& plane,
              const std::vector<FloorSample>& samples, const RestSigma& rest);

  [[nodiscard]] bool isEmpty() const { return heights_.size() == 0; }
  /// Height in odom, m; beyond the lattice as at its edge.
  [[nodiscard]] double at(const Eigen::Vector2d& p_odom) const;
  /// Height of the floor over (below) the place p of a nearly level frame, in that frame.
  [[nodiscard]] double heightIn(const SE3& T_odom_frame, const Eigen::Vector2d& p) const;

  void reset() { heights_.resize(0); }

 private:
  static constexpr double kStep = 2.0;  // m
  static constexpr int kHalf = 6;       // nodes to either side of the car
  static constexpr int kSide = 2 * kHalf + 1;

  struct Weights {
    int node[4];
    double share[4];
  };
  // A difference of second order, in sigmas of curvature.
  struct Bend {
    int nodes[4];  // the last one twice where there are three
    double factors[4];
  };
  [[nodiscard]] Weights weightsAt(const Eigen::Vector2d& p_odom) const;
  void move(const SE3& T_odom_vehicle, const Eigen::Vector3d& plane);
  void addSlopes(std::vector<Eigen::Triplet<double>>& terms) const;
  void addBends();
  void solve(const std::vector<FloorSample>& samples, std::size_t firm);

  FloorElevationOptions options_;
  Eigen::Vector2i first_ = Eigen::Vector2i::Zero();  // node (0, 0), in steps
  Eigen::VectorXd heights_;                          // m, in odom; x major
  std::vector<Bend> bends_;
  Eigen::SparseMatrix<double> slopes_;  // information of a level floor; the lower half
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace parkade
