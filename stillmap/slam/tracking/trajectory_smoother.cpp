// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/tracking/trajectory_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>

namespace stillmap {
namespace {

// With fewer poses the noise is not told from the motion.
constexpr std::size_t kFewest = 20;
// The information of an exact pose, as a multiple of that of its features: far below where numbers
// fail.
constexpr double kExact = 1e6;
// The greatest scale of the noise. Poses of real and rendered cameras have 0.7 to 3.6; one that
// jumps from frame to frame has more, because no motion is likely then.
constexpr double kMostNoise = 10;
// Longer trajectories are smoothed in parts, which bounds memory.
constexpr std::size_t kLongest = 1000;

// The unknowns of a frame: correction of the position in the world, velocity, correction of the
// rotation in camera axes, angular velocity.
constexpr int kUnknowns = 12;
using Block = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

// The spectral densities of the accelerations as multiples of the measured poses' noise.
struct Agility {
  double position = 1;  // m^2 / s^3
  double rotation = 1;  // rad^2 / s^3
};

// The square form |F0 x + F1 y + c|^2 in the weight W of one half of the unknowns x, y of two
// neighbouring frames, before it is divided by its density.
struct HalfLink {
  Matrix6d xx, xy, yy;
  Vector6d x, y;
  double rest = 0;

  // residual: step + J1 dy - J0 dx - dt v_x, and v_y - v_x.
  HalfLink(double dt,
           const Eigen::Vector3d& step,
           const Eigen::Matrix3d& J0,
           const Eigen::Matrix3d& J1) {
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    Matrix6d F0, F1, W;
    F0 << -J0, -dt * I, Eigen::Matrix3d::Zero(), -I;
    F1 << J1, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), I;
    // The inverse of [dt^3/3, dt^2/2; dt^2/2, dt], the covariance of integrated white noise.
    W << 12 / (dt * dt * dt) * I, -6 / (dt * dt) * I, -6 / (dt * dt) * I, 4 / dt * I;
    Vector6d c = Vector6d::Zero();
    c.head<3>() = step;
    const Matrix6d F0_W = F0.transpose() * W, F1_W = F1.transpose() * W;
    xx = F0_W * F0;
    xy = F0_W * F1;
    yy = F1_W * F1;
    x = F0_W * c;
    y = F1_W * c;
    rest = c.dot(W * c);
  }
};

// The camera's way from one frame to the next.
struct Link {
  HalfLink position;
  HalfLink rotation;
};

Link link_between(const MeasuredPose& a, const MeasuredPose& b) {
  const double dt = b.stamp_s - a.stamp_s;
  const Eigen::Vector3d turn = so3_log(Eigen::Quaterniond(
      Eigen::Matrix3d(a.T_world_camera.linear().transpose() * b.T_world_camera.linear())));
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d step = b.T_world_camera.translation() - a.T_world_camera.translation();
  // The derivatives of log(exp(-dx) exp(turn) exp(dy)), to the first order of the turn.
  return {HalfLink(dt, step, I, I), HalfLink(dt, turn, I - 0.5 * skew(turn), I + 0.5 * skew(turn))};
}

// The information of a pose for the corrections, from that for a step of T_camera_world.
Block information_of(const MeasuredPose& pose) {
  Matrix6d M = Matrix6d::Zero();
  M.topLeftCorner<3, 3>() = -pose.T_world_camera.linear().transpose();
  M.bottomRightCorner<3, 3>() = -Eigen::Matrix3d::Identity();
  const Matrix6d H = (pose.is_exact ? kExact : 1.0) * M.transpose() * pose.information * M;
  Block block = Block::Zero();
  block.block<3, 3>(0, 0) = H.topLeftCorner<3, 3>();
  block.block<3, 3>(0, 6) = H.topRightCorner<3, 3>();
  block.block<3, 3>(6, 0) = H.bottomLeftCorner<3, 3>();
  block.block<3, 3>(6, 6) = H.bottomRightCorner<3, 3>();
  return block;
}

// A stretch of frames: a chain of measurements and links.
class Chain {
 public:
  explicit Chain(std::span<const MeasuredPose> measured) {
    for (std::size_t i = 0; i < measured.size(); ++i) {
      information_.push_back(information_of(measured[i]));
      if (i > 0) links_.push_back(link_between(measured[i - 1], measured[i]));
    }
  }

  struct Fit {
    double surprise = 0;  // -2 log of the likelihood under the best scale of all noise
    double noise = 0;     // that scale: the poses' errors by those of their information
  };

  // How well the measured poses fit, up to a constant; nothing where numbers fail.
  [[nodiscard]] std::optional<Fit> fit(const Agility& agility) const {
    double log_determinant = 0, cost = 0;
    const bool solved =
        eliminate(agility, [&](const Eigen::LLT<Block>& S, const Unknowns& b, const Unknowns& at) {
          log_determinant += 2 * S.matrixLLT().diagonal().array().log().sum();
          cost -= b.dot(at);
        });
    for (const Link& link : links_) {
      cost += link.position.rest / agility.position + link.rotation.rest / agility.rotation;
    }
    if (!solved || !(cost > 0)) return std::nullopt;
    const double freedom = 6.0 * static_cast<double>(information_.size()) - kUnknowns;
    const double densities = 6.0 * static_cast<double>(links_.size()) *
                             (std::log(agility.position) + std::log(agility.rotation));
    return Fit{freedom * std::log(cost / freedom) + log_determinant + densities,
               std::sqrt(cost / freedom)};
  }

  // The most probable unknowns of all frames; none where numbers fail.
  [[nodiscard]] std::vector<Unknowns> solve(const Agility& agility) const {
    std::vector<Eigen::LLT<Block>> factors;
    std::vector<Unknowns> x;
    const bool solved =
        eliminate(agility, [&](const Eigen::LLT<Block>& S, const Unknowns&, const Unknowns& at) {
          factors.push_back(S);
          x.push_back(at);
        });
    if (!solved) return {};
    for (std::size_t i = x.size() - 1; i-- > 0;) {
      x[i] -= factors[i].solve(coupling(links_[i], agility) * x[i + 1]);
    }
    return x;
  }

 private:
  [[nodiscard]] static Block coupling(const Link& link, const Agility& agility) {
    Block U = Block::Zero();
    U.topLeftCorner<6, 6>() = link.position.xy / agility.position;
    U.bottomRightCorner<6, 6>() = link.rotation.xy / agility.rotation;
    return U;
  }

  // Eliminates one frame after another. Visits each with its factor, its right side and the value
  // that it has while the frames after it are unknown.
  template <class Visit>
  [[nodiscard]] bool eliminate(const Agility& agility, Visit visit) const {
    Block A = information_.front();
    Unknowns b = Unknowns::Zero();
    for (std::size_t i = 0; i < information_.size(); ++i) {
      const bool last = i == links_.size();
      if (!last) {
        const HalfLink &p = links_[i].position, &r = links_[i].rotation;
        A.topLeftCorner<6, 6>() += p.xx / agility.position;
        A.bottomRightCorner<6, 6>() += r.xx / agility.rotation;
        b.head<6>() -= p.x / agility.position;
        b.tail<6>() -= r.x / agility.rotation;
      }
      const Eigen::LLT<Block> S(A);
      if (S.info() != Eigen::Success) return false;
      const Unknowns at = S.solve(b);
      visit(S, b, at);
      if (last) break;
      const HalfLink &p = links_[i].position, &r = links_[i].rotation;
      const Block U = coupling(links_[i], agility);
      A = information_[i + 1] - U.transpose() * S.solve(U);
      A.topLeftCorner<6, 6>() += p.yy / agility.position;
      A.bottomRightCorner<6, 6>() += r.yy / agility.rotation;
      b.head<6>() = -p.y / agility.position;
      b.tail<6>() = -r.y / agility.rotation;
      b -= U.transpose() * at;
    }
    return true;
  }

  std::vector<Block> information_;
  std::vector<Link> links_;
};

// The densities of greatest likelihood, to a fifth of a decade, by a search along the axes. None
// where they explain motion as noise.
std::optional<Agility> most_likely(const Chain& chain) {
  const auto at = [](double position, double rotation) {
    return Agility{std::pow(10.0, position), std::pow(10.0, rotation)};
  };
  constexpr double kFarthest = 8;  // decades
  double position = 0, rotation = 0;
  std::optional<Chain::Fit> best = chain.fit(at(position, rotation));
  if (!best) return std::nullopt;
  for (double step = 1.6; step >= 0.2;) {
    bool better = false;
    for (const auto& [dp, dr] : {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
      if (std::max(std::abs(position + dp), std::abs(rotation + dr)) > kFarthest) continue;
      const std::optional<Chain::Fit> there = chain.fit(at(position + dp, rotation + dr));
      if (!there || there->surprise >= best->surprise) continue;
      best = there;
      position += dp;
      rotation += dr;
      better = true;
    }
    if (!better) step /= 2;
  }
  if (best->noise > kMostNoise) return std::nullopt;
  return at(position, rotation);
}

void smooth_part(std::span<const MeasuredPose> measured, std::span<Eigen::Isometry3d> poses) {
  if (measured.size() < kFewest) return;
  const Chain chain(measured);
  const std::optional<Agility> agility = most_likely(chain);
  if (!agility) return;
  const std::vector<Unknowns> found = chain.solve(*agility);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (measured[i].is_exact) continue;
    const Eigen::Isometry3d& T = measured[i].T_world_camera;
    poses[i] = make_pose(Eigen::Quaterniond(T.linear()) * so3_exp(found[i].segment<3>(6)),
                         T.translation() + found[i].head<3>());
  }
}

}  // namespace

std::vector<Eigen::Isometry3d> smooth_trajectory(std::span<const MeasuredPose> measured) {
  std::vector<Eigen::Isometry3d> poses;
  for (const MeasuredPose& pose : measured) poses.push_back(pose.T_world_camera);
  for (std::size_t first = 0; first < measured.size(); first += kLongest) {
    const std::size_t count = std::min(kLongest, measured.size() - first);
    smooth_part(measured.subspan(first, count), std::span(poses).subspan(first, count));
  }
  return poses;
}

}  // namespace stillmap
