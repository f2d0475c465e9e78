// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <utility>
#include <vector>

#include "stillmap/slam/tracking/tracker.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/simulated_map.hpp"

namespace stillmap {

inline constexpr ObservationNoise kWalkNoise{
    .pixel_sigma_px = 0.7, .inverse_depth_sigma = 0.01, .flipped_bits = 15};
inline constexpr MeasurementConfig kMeasurement{.pixel_sigma_px = 0.7, .inverse_depth_sigma = 0.01};

// A camera in a world whose map is true, so that all errors are those of tracking.
class SimulatedWalk {
 public:
  SimulatedWalk(const CameraPath& path, const TrackerConfig& config, double readout_s = 0)
      : path_(path),
        readout_s_(readout_s),
        simulated_(make_map(path)),
        tracker_(config,
                 {},
                 world().camera(),
                 MeasurementModel(kMeasurement, world().level_scales()),
                 0) {
    const Keyframe& first = simulated_.map.keyframe(KeyframeId(0));
    first_ = tracker_.start(frame_at(0), first.features);
    tracker_.set_reference(KeyframeId(0), simulated_.map);
  }

  [[nodiscard]] static const SimulatedWorld& world() {
    static const SimulatedWorld kWorld({}, simulated_camera());
    return kWorld;
  }

  [[nodiscard]] Observed observe(int k, const ObservationNoise& noise) {
    return world().observe_rolling(path_, time(k), readout_s_, noise, rng_);
  }
  TrackedFrame track(int k, Features features, const MoreFeatures& more = {}) {
    return tracker_.track(
        frame_at(k), std::move(features), simulated_.map, index_of(simulated_.map), more);
  }

  [[nodiscard]] double error_m(const TrackedFrame& frame) const {
    return (frame.T_world_camera.translation() - path_(frame.stamp_s).translation()).norm();
  }

  // Squared error in units of what the inliers' noise implies: 6 on average for an estimate that
  // is as good as its measurements.
  [[nodiscard]] double normalized_error(const TrackedFrame& frame) const {
    const Eigen::Isometry3d truth = path_(frame.stamp_s).inverse();
    const MeasurementModel measure(kMeasurement, world().level_scales());
    Matrix6d information = Matrix6d::Zero();
    for (std::size_t i = 0; i < frame.landmarks.size(); ++i) {
      if (!frame.landmarks[i].valid()) continue;
      const Eigen::Vector3d p = truth * map().landmark(frame.landmarks[i]).p_world;
      const Eigen::Matrix<double, 3, 6> J =
          pose_jacobian(reprojection_jacobian(world().camera(), measure(*frame.features, i), p), p);
      information += J.transpose() * J;
    }
    const Eigen::Isometry3d error = frame.T_world_camera.inverse() * path_(frame.stamp_s);
    Vector6d e;
    e << error.translation(), so3_log(Eigen::Quaterniond(error.linear()));
    return e.dot(information * e);
  }

  [[nodiscard]] const Map& map() const { return simulated_.map; }
  [[nodiscard]] const SimulatedMap& simulated() const { return simulated_; }
  [[nodiscard]] const TrackedFrame& first() const { return first_; }
  void assume(const CameraTimes& times) { tracker_.assume(times); }
  [[nodiscard]] static double time(int k) { return k * kFrameInterval_s; }
  [[nodiscard]] std::mt19937& rng() { return rng_; }

 private:
  [[nodiscard]] static RgbdFrame frame_at(int k) {
    RgbdFrame frame;
    frame.id = FrameId(static_cast<std::uint32_t>(k));
    frame.stamp.seconds = time(k);
    return frame;
  }

  [[nodiscard]] static SimulatedMap make_map(const CameraPath& path) {
    std::vector<Eigen::Isometry3d> poses;
    for (int k = 0; k < 300; k += 15) poses.push_back(path(time(k)));
    std::mt19937 rng(2);
    return make_true_map(world(), poses, kWalkNoise, rng);
  }

  CameraPath path_;
  double readout_s_;
  SimulatedMap simulated_;
  Tracker tracker_;
  TrackedFrame first_;
  std::mt19937 rng_{3};
};

inline Tracker make_tracker() {
  const MeasurementModel measure(kMeasurement, SimulatedWalk::world().level_scales());
  return Tracker({}, {}, simulated_camera(), measure, 0);
}

inline Eigen::Isometry3d path(double t) {
  return swinging(t);
}

}  // namespace stillmap
