// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/time_evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "stillmap/slam/optim/pose_time.hpp"

namespace stillmap {
namespace {

// Keeps what nothing determines, as a point without depth seen from one place, from being singular:
// a prior of 30 m, and of as many radians.
constexpr double kWeakPrior = 1e-3;

// The columns beside the poses and points: both times, then the residual.
using Columns = Eigen::Matrix3d;

/// One observation, linearised.
struct Linearized {
  Eigen::Matrix<double, 3, 6> J_pose;
  Eigen::Matrix3d J_point;
  Columns columns;
};

Linearized linearize(const TimedBundle& bundle, std::size_t i) {
  const BundleObservation& o = bundle.problem.observations[i];
  const CameraModel& camera = bundle.problem.camera;
  const Eigen::Isometry3d& T = bundle.problem.T_camera_world[o.camera];
  const FeatureTiming& timing = bundle.timing[o.camera];
  const Eigen::Vector3d p = T * bundle.problem.points[o.point];
  const Eigen::Matrix3d J = reprojection_jacobian(camera, o.measurement, p);
  Linearized result{pose_jacobian(J, p), J * T.linear(), Columns::Zero()};
  result.columns.leftCols<2>() =
      residual_by_times(J * timing.smooth_velocity.of_point(p), bundle.row[i]);
  const Eigen::Vector3d corrected =
      J * corrected_velocity(timing.velocity, o.measurement.has_depth()).of_point(p);
  result.columns.col(2) = reprojection_residual(camera, o.measurement, p) -
                          bundle.row[i] * timing.assumed.readout_s * corrected -
                          timing.assumed.depth_delay_s * corrected.z() * Eigen::Vector3d::UnitZ();
  return result;
}

/// The normal equations of poses and columns, from which points are eliminated one by one.
class Elimination {
 public:
  explicit Elimination(Eigen::Index cameras)
      : S_(Eigen::MatrixXd::Zero(6 * cameras, 6 * cameras)),
        poses_(Eigen::MatrixXd::Zero(6 * cameras, 3)) {}

  void add(Eigen::Index slot, const Linearized& o) {
    terms_.push_back({slot, o.J_pose.transpose() * o.J_point});
    H_point_.noalias() += o.J_point.transpose() * o.J_point;
    point_.noalias() += o.J_point.transpose() * o.columns;
    S_.block<6, 6>(6 * slot, 6 * slot).noalias() += o.J_pose.transpose() * o.J_pose;
    poses_.block<6, 3>(6 * slot, 0).noalias() += o.J_pose.transpose() * o.columns;
    columns_.noalias() += o.columns.transpose() * o.columns;
  }

  void eliminate_point() {
    H_point_.diagonal().array() += kWeakPrior;
    const Eigen::Matrix3d H_inverse = H_point_.inverse();
    const Columns solved = H_inverse * point_;
    columns_.noalias() -= point_.transpose() * solved;
    for (const Term& row : terms_) {
      poses_.block<6, 3>(6 * row.slot, 0).noalias() -= row.W * solved;
      const Eigen::Matrix<double, 6, 3> Y = row.W * H_inverse;
      for (const Term& column : terms_) {
        if (column.slot > row.slot) continue;  // only the lower triangle is needed
        S_.block<6, 6>(6 * row.slot, 6 * column.slot).noalias() -= Y * column.W.transpose();
      }
    }
    terms_.clear();
    H_point_.setZero();
    point_.setZero();
  }

  [[nodiscard]] TimeEvidence eliminate_poses() {
    S_.diagonal().array() += kWeakPrior;
    const Eigen::MatrixXd solved = S_.selfadjointView<Eigen::Lower>().ldlt().solve(poses_);
    const Columns left = columns_ - poses_.transpose() * solved;
    return {left.topLeftCorner<2, 2>(), -left.topRightCorner<2, 1>()};
  }

 private:
  struct Term {
    Eigen::Index slot;
    Eigen::Matrix<double, 6, 3> W;
  };
  Eigen::MatrixXd S_;      // lower triangle
  Eigen::MatrixXd poses_;  // poses by columns
  Columns columns_ = Columns::Zero();
  std::vector<Term> terms_;  // of the present point, as the two below
  Eigen::Matrix3d H_point_ = Eigen::Matrix3d::Zero();
  Columns point_ = Columns::Zero();
};

}  // namespace

TimeEvidence time_evidence(const TimedBundle& bundle) {
  const BundleProblem& problem = bundle.problem;
  std::vector<Eigen::Index> slot(problem.held.size(), -1);
  Eigen::Index cameras = 0;
  for (std::size_t c = 0; c < slot.size(); ++c) {
    if (problem.held[c] == 0) slot[c] = cameras++;
  }
  Elimination elimination(cameras);
  const std::size_t count = problem.observations.size();
  for (std::size_t i = 0; i < count; ++i) {
    const BundleObservation& o = problem.observations[i];
    if (slot[o.camera] >= 0) elimination.add(slot[o.camera], linearize(bundle, i));
    if (i + 1 == count || problem.observations[i + 1].point != o.point) {
      elimination.eliminate_point();
    }
  }
  return elimination.eliminate_poses();
}

}  // namespace stillmap
