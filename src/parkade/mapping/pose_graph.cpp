// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/mapping/pose_graph.hpp"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <unordered_map>

namespace parkade {
namespace {

// A symmetric square root; directions without information get none.
Matrix6d squareRoot(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(
      Matrix6d(0.5 * (information + information.transpose())));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

struct RelativePose {
  Eigen::Quaterniond q;  // measured, from <- to
  Eigen::Vector3d t;
  Matrix6d root;

  template <class T>
  bool operator()(const T* t_from, const T* q_from, const T* t_to, const T* q_to,
                  T* residual) const {
    using Vector3 = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Vector3> p_a(t_from);
    const Eigen::Map<const Vector3> p_b(t_to);
    const Eigen::Map<const Eigen::Quaternion<T>> q_a(q_from);
    const Eigen::Map<const Eigen::Quaternion<T>> q_b(q_to);
    const Eigen::Quaternion<T> measured = q.cast<T>();
    const Vector3 between = q_a.conjugate() * (p_b - p_a);
    Eigen::Quaternion<T> turn = measured.conjugate() * (q_a.conjugate() * q_b);
    if (turn.w() < T(0.0)) turn.coeffs() = -turn.coeffs();
    Eigen::Matrix<T, 6, 1> error;
    error.template head<3>() = measured.conjugate() * (between - t.cast<T>());
    error.template tail<3>() = T(2.0) * turn.vec();
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
    out = root.cast<T>() * error;
    return true;
  }
};

struct Pose {
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
};

}  // namespace

PoseGraphResult optimisePoseGraph(std::vector<PoseGraphNode>& nodes,
                                  const std::vector<PoseGraphEdge>& edges, double loop_scale) {
  PoseGraphResult result;
  if (nodes.size() < 2) return result;
  std::unordered_map<std::int64_t, std::size_t> index;
  std::vector<Pose> poses(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    index[nodes[i].id] = i;
    poses[i] = {nodes[i].T_world_vehicle.translation(),
                nodes[i].T_world_vehicle.rotation().quaternion()};
  }
  ceres::Problem problem;
  for (const PoseGraphEdge& edge : edges) {
    const auto a = index.find(edge.from);
    const auto b = index.find(edge.to);
    if (a == index.end() || b == index.end() || a->second == b->second) continue;
    auto* cost = new ceres::AutoDiffCostFunction<RelativePose, 6, 3, 4, 3, 4>(
        new RelativePose{edge.T_from_to.rotation().quaternion(), edge.T_from_to.translation(),
                         squareRoot(edge.information)});
    ceres::LossFunction* loss =
        edge.kind == EdgeKind::kLoop ? new ceres::CauchyLoss(loop_scale) : nullptr;
    Pose& from = poses[a->second];
    Pose& to = poses[b->second];
    problem.AddResidualBlock(cost, loss, from.t.data(), from.q.coeffs().data(), to.t.data(),
                             to.q.coeffs().data());
  }
  if (problem.NumResidualBlocks() == 0) return result;
  for (Pose& pose : poses) {
    if (!problem.HasParameterBlock(pose.q.coeffs().data())) continue;
    problem.SetManifold(pose.q.coeffs().data(), new ceres::EigenQuaternionManifold);
  }
  if (problem.HasParameterBlock(poses.front().t.data())) {
    problem.SetParameterBlockConstant(poses.front().t.data());
    problem.SetParameterBlockConstant(poses.front().q.coeffs().data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  result.usable = summary.IsSolutionUsable();
  result.iterations = static_cast<int>(summary.iterations.size());
  result.initial_cost = summary.initial_cost;
  result.final_cost = summary.final_cost;
  if (!result.usable) return result;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i].T_world_vehicle = SE3(SO3(poses[i].q.normalized()), poses[i].t);
  }
  return result;
}

}  // namespace parkade
