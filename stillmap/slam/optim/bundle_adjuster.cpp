// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/optim/bundle_adjuster.hpp"

#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

using Matrix63d = Eigen::Matrix<double, 6, 3>;

constexpr std::uint32_t kHeld = ~std::uint32_t{0};
constexpr double kBundleConverged = 1e-5;  // relative decrease of the cost
// Squared error, in sigmas, of a point that a step moved behind a camera, where the error is
// undefined: that of a gross outlier. A step that does this to one of ten thousand points may still
// be good.
constexpr double kBehind = 1e4;
constexpr double kMaxDamping = 1e8;

// The position of a free camera's six parameters in the reduced system.
Eigen::Index offset_of(std::uint32_t slot) {
  return 6 * static_cast<Eigen::Index>(slot);
}

/// The state of one adjustment: the current estimate, its linearisation, and steps from it.
class Solver {
 public:
  Solver(BundleProblem problem, std::vector<std::uint8_t> used)
      : problem_(std::move(problem)), used_(std::move(used)) {
    slot_.assign(problem_.T_camera_world.size(), kHeld);
    for (std::size_t c = 0; c < slot_.size(); ++c) {
      if (problem_.held[c] == 0) slot_[c] = free_cameras_++;
    }
    H_camera_.resize(free_cameras_);
    g_camera_.resize(free_cameras_);
    H_point_.resize(problem_.points.size());
    g_point_.resize(problem_.points.size());
    W_.resize(problem_.observations.size());
  }

  /// Runs up to `iterations` accepted or rejected steps and returns their number.
  int minimize(int iterations);

  [[nodiscard]] double cost() const { return cost_of(problem_.T_camera_world, problem_.points); }
  [[nodiscard]] std::vector<std::uint8_t> inliers() const;
  void use(std::vector<std::uint8_t> used) { used_ = std::move(used); }
  [[nodiscard]] const BundleProblem& problem() const { return problem_; }
  [[nodiscard]] BundleProblem take_problem() { return std::move(problem_); }

 private:
  struct Step {
    Eigen::VectorXd cameras;
    std::vector<Eigen::Vector3d> points;
  };

  [[nodiscard]] double cost_of(const std::vector<Eigen::Isometry3d>& poses,
                               const std::vector<Eigen::Vector3d>& points) const;
  void linearize();
  [[nodiscard]] Step solve(double damping) const;
  void eliminate_points(double damping,
                        Eigen::MatrixXd& S,
                        Eigen::VectorXd& b,
                        std::vector<Eigen::Matrix3d>& H_point_inverse) const;

  BundleProblem problem_;
  std::vector<std::uint8_t> used_;   // per observation
  std::vector<std::uint32_t> slot_;  // position of each camera among the free cameras
  std::uint32_t free_cameras_ = 0;

  std::vector<Matrix6d> H_camera_;  // lower triangles
  std::vector<Vector6d> g_camera_;
  std::vector<Eigen::Matrix3d> H_point_;
  std::vector<Eigen::Vector3d> g_point_;
  std::vector<Matrix63d> W_;  // camera-point block of each observation
};

double Solver::cost_of(const std::vector<Eigen::Isometry3d>& poses,
                       const std::vector<Eigen::Vector3d>& points) const {
  double cost = 0;
  for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
    if (used_[i] == 0) continue;
    const BundleObservation& o = problem_.observations[i];
    const Eigen::Vector3d p_camera = poses[o.camera] * points[o.point];
    if (p_camera.z() < kMinPointDepth) {
      cost += Huber(kBehind, chi2_bound(o.measurement)).cost;
      continue;
    }
    const Eigen::Vector3d r = reprojection_residual(problem_.camera, o.measurement, p_camera);
    cost += Huber(r.squaredNorm(), chi2_bound(o.measurement)).cost;
  }
  return cost;
}

std::vector<std::uint8_t> Solver::inliers() const {
  std::vector<std::uint8_t> inlier(problem_.observations.size(), 0);
  for (std::size_t i = 0; i < inlier.size(); ++i) {
    const BundleObservation& o = problem_.observations[i];
    const Eigen::Vector3d p_camera = problem_.T_camera_world[o.camera] * problem_.points[o.point];
    if (p_camera.z() < kMinPointDepth) continue;
    const Eigen::Vector3d r = reprojection_residual(problem_.camera, o.measurement, p_camera);
    inlier[i] = r.squaredNorm() <= chi2_bound(o.measurement) ? 1 : 0;
  }
  return inlier;
}

void Solver::linearize() {
  for (auto& H : H_camera_) H.setZero();
  for (auto& g : g_camera_) g.setZero();
  for (auto& H : H_point_) H.setZero();
  for (auto& g : g_point_) g.setZero();
  for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
    if (used_[i] == 0) continue;
    const BundleObservation& o = problem_.observations[i];
    const Eigen::Isometry3d& T = problem_.T_camera_world[o.camera];
    const Eigen::Vector3d p_camera = T * problem_.points[o.point];
    if (p_camera.z() < kMinPointDepth) {
      W_[i].setZero();
      continue;
    }
    const Eigen::Vector3d r = reprojection_residual(problem_.camera, o.measurement, p_camera);
    const double weight = Huber(r.squaredNorm(), chi2_bound(o.measurement)).weight;
    const PointEquations eq = point_equations(problem_.camera, o.measurement, p_camera, r, weight);
    // rows in camera axes, columns in world axes
    const Eigen::Matrix3d H_mixed = eq.H * T.linear();
    H_point_[o.point].noalias() += T.linear().transpose() * H_mixed;
    g_point_[o.point].noalias() += T.linear().transpose() * eq.g;
    const std::uint32_t slot = slot_[o.camera];
    if (slot == kHeld) continue;
    add_to_pose(eq, p_camera, H_camera_[slot], g_camera_[slot]);
    W_[i].topRows<3>() = H_mixed;
    W_[i].bottomRows<3>() = cross_columns(p_camera, H_mixed);
  }
}

// Reduces S and b to the normal equations of the cameras (Schur complement).
void Solver::eliminate_points(double damping,
                              Eigen::MatrixXd& S,
                              Eigen::VectorXd& b,
                              std::vector<Eigen::Matrix3d>& H_point_inverse) const {
  struct Term {
    std::uint32_t slot;
    std::size_t observation;
  };
  std::vector<Term> terms;  // the free cameras that observe the point
  const std::size_t count = problem_.observations.size();
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    const std::uint32_t point = problem_.observations[begin].point;
    terms.clear();
    for (end = begin; end < count && problem_.observations[end].point == point; ++end) {
      const std::uint32_t slot = slot_[problem_.observations[end].camera];
      if (used_[end] != 0 && slot != kHeld) terms.push_back({slot, end});
    }
    Eigen::Matrix3d H = H_point_[point];
    H.diagonal() += damping * H.diagonal();
    H.diagonal().array() += 1e-9;
    H_point_inverse[point] = H.inverse();
    for (const Term& row : terms) {
      const Matrix63d Y = W_[row.observation] * H_point_inverse[point];
      b.segment<6>(offset_of(row.slot)).noalias() += Y * g_point_[point];
      for (const Term& column : terms) {
        if (column.slot > row.slot) continue;  // only the lower triangle is needed
        S.block<6, 6>(offset_of(row.slot), offset_of(column.slot)).noalias() -=
            Y * W_[column.observation].transpose();
      }
    }
  }
}

Solver::Step Solver::solve(double damping) const {
  const Eigen::Index size = offset_of(free_cameras_);
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b(size);
  for (std::uint32_t c = 0; c < free_cameras_; ++c) {
    Matrix6d H = H_camera_[c];
    H.diagonal() += damping * H.diagonal();
    H.diagonal().array() += 1e-9;
    S.block<6, 6>(offset_of(c), offset_of(c)) = H;
    b.segment<6>(offset_of(c)) = -g_camera_[c];
  }
  std::vector<Eigen::Matrix3d> H_point_inverse(problem_.points.size(), Eigen::Matrix3d::Zero());
  eliminate_points(damping, S, b, H_point_inverse);

  Step step;
  step.cameras = S.selfadjointView<Eigen::Lower>().ldlt().solve(b);
  step.points.resize(problem_.points.size());
  for (std::size_t p = 0; p < step.points.size(); ++p) step.points[p] = -g_point_[p];
  for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
    const BundleObservation& o = problem_.observations[i];
    const std::uint32_t slot = slot_[o.camera];
    if (used_[i] == 0 || slot == kHeld) continue;
    step.points[o.point].noalias() -= W_[i].transpose() * step.cameras.segment<6>(offset_of(slot));
  }
  for (std::size_t p = 0; p < step.points.size(); ++p) {
    step.points[p] = H_point_inverse[p] * step.points[p];
  }
  return step;
}

int Solver::minimize(int iterations) {
  double damping = 1e-4;
  double cost = this->cost();
  linearize();
  int iteration = 0;
  for (; iteration < iterations && damping < kMaxDamping; ++iteration) {
    const Step step = solve(damping);
    std::vector<Eigen::Isometry3d> poses = problem_.T_camera_world;
    for (std::size_t c = 0; c < poses.size(); ++c) {
      if (slot_[c] == kHeld) continue;
      poses[c] = perturb_left(poses[c], step.cameras.segment<6>(offset_of(slot_[c])));
    }
    std::vector<Eigen::Vector3d> points = problem_.points;
    for (std::size_t p = 0; p < points.size(); ++p) points[p] += step.points[p];
    const double new_cost = cost_of(poses, points);
    if (!(new_cost < cost)) {  // also for NaN
      damping *= 10;
      continue;
    }
    const bool converged = cost - new_cost < kBundleConverged * cost;
    problem_.T_camera_world = std::move(poses);
    problem_.points = std::move(points);
    cost = new_cost;
    damping = std::max(damping * 0.2, 1e-8);
    if (converged) return iteration + 1;
    if (iteration + 1 < iterations) linearize();
  }
  return iteration;
}

// Observations of points that start behind their camera, where the residual is undefined, and NaN
// observations never take part.
std::vector<std::uint8_t> usable(const BundleProblem& problem) {
  std::vector<std::uint8_t> used(problem.observations.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    const BundleObservation& o = problem.observations[i];
    const Eigen::Vector3d p_camera = problem.T_camera_world[o.camera] * problem.points[o.point];
    const bool finite = reprojection_residual(problem.camera, o.measurement, p_camera).allFinite();
    used[i] = p_camera.z() >= kMinPointDepth && finite ? 1 : 0;
  }
  return used;
}

}  // namespace

BundleResult adjust_bundle(BundleProblem problem, const BundleConfig& config) {
  STILLMAP_CHECK(problem.held.size() == problem.T_camera_world.size());
  std::vector<std::uint8_t> used = usable(problem);
  Solver solver(std::move(problem), std::move(used));
  BundleResult result;
  result.initial_cost = solver.cost();
  result.iterations = solver.minimize(config.robust_iterations);
  solver.use(solver.inliers());
  result.iterations += solver.minimize(config.final_iterations);
  result.inlier = solver.inliers();
  solver.use(usable(solver.problem()));  // an outlier may have moved behind its camera
  result.final_cost = solver.cost();
  BundleProblem solved = solver.take_problem();
  result.T_camera_world = std::move(solved.T_camera_world);
  result.points = std::move(solved.points);
  return result;
}

}  // namespace stillmap
