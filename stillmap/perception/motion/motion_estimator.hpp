// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/fields.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/perception/objects/object_state.hpp"

namespace stillmap {

struct MotionStateConfig {
  int window_frames = 10;
  int min_frames = 5;
  double moving_m_s = 0.25;
  double still_m_s = 0.12;
  double certainty = 3.0;
  double depth_noise_per_m = 0.0015;
  double border_factor = 2.0;
  int calm_frames = 5;
  double vacated_share = 0.15;
  double vacated_m = 0.05;
  int standing_frames = 30;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("window_frames",
          self.window_frames,
          FieldInfo{"greatest number of positions for an object's velocity", "frames", 3, 100});
    visit("min_frames",
          self.min_frames,
          FieldInfo{"least number of positions for an object's velocity", "frames", 3, 100});
    visit(
        "moving_m_s",
        self.moving_m_s,
        FieldInfo{"speed, beyond its error, at which a still object becomes moving", "m/s", 0, 10});
    visit("still_m_s",
          self.still_m_s,
          FieldInfo{
              "speed below which a moving object becomes still after calm_frames", "m/s", 0, 10});
    visit("certainty",
          self.certainty,
          FieldInfo{"error of a velocity, in standard errors", "", 0, 100});
    visit("depth_noise_per_m",
          self.depth_noise_per_m,
          FieldInfo{"least standard deviation of a position, per depth squared", "1/m", 0, 1});
    visit(
        "border_factor",
        self.border_factor,
        FieldInfo{"factor on moving_m_s for an object cut off by the image's border", "", 1, 100});
    visit(
        "calm_frames",
        self.calm_frames,
        FieldInfo{"number of slow frames after which a moving object is still", "frames", 1, 1000});
    visit(
        "vacated_share",
        self.vacated_share,
        FieldInfo{"share of its earlier pixels that a moving object must have vacated", "", 0, 1});
    visit(
        "vacated_m",
        self.vacated_m,
        FieldInfo{"change of depth that shows a pixel vacated, in addition to noise", "m", 0, 10});
    visit("standing_frames",
          self.standing_frames,
          FieldInfo{"number of frames after which an object that has stood where it was first seen "
                    "is static for the pose and the map",
                    "frames",
                    1,
                    100000});
  }
};

/// The median of the slopes between all pairs of positions over time (Theil-Sen), for each axis,
/// with its standard error.
struct RobustVelocity {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  double error = 0;
};
[[nodiscard]] RobustVelocity robust_velocity(std::span<const double> stamps_s,
                                             std::span<const Eigen::Vector3d> positions,
                                             double least_noise_m);

/// Estimates the motion of each tracked object from the positions of its middle.
///
/// The middle of an object is the median column and row of its pixels at the median of their
/// depths. Its velocity is the median slope over the last frames (Theil-Sen), with an error from
/// the scatter around it, at least that of depth noise. A far object, or one with a flickering
/// mask, must therefore be faster to count as moving. It must also have vacated a part of its
/// surface of some frames ago: the camera now sees farther there, or another part of the object. An
/// object that is gradually occluded, or cut off by the border of the image, does not count as
/// moving. Filled boxes are not used.
class MotionEstimator {
 public:
  MotionEstimator(const MotionStateConfig& config, const CameraModel& camera);

  /// Adds a frame with the states of its objects and returns the motion of each, in their order.
  /// Frames with detected (not only filled) objects must be in the order of their stamps.
  /// `T_world_camera` is in a coordinate frame that never jumps: the odometry frame.
  [[nodiscard]] std::vector<Motion> update(const FrameObjects& objects,
                                           const DepthImage& depth,
                                           std::span<const ObjectState> states,
                                           const Eigen::Isometry3d& T_world_camera);

  /// The tracks that move in the last frame, by number.
  [[nodiscard]] std::vector<TrackId> moving() const;
  /// The tracks that have stood still for long, without interruption since they were first seen; by
  /// number.
  [[nodiscard]] std::vector<TrackId> standing() const;

 private:
  struct Position {
    double stamp_s = 0;
    Eigen::Vector3d p_world;
    double noise_m = 0;
    std::vector<Eigen::Vector3d> surface;  // a sample of its visible surface, in the world frame
  };
  struct View {
    const FrameObjects& objects;
    const DepthImage& depth;
    const Eigen::Isometry3d& T_world_camera;
  };
  struct Track {
    TrackId id;
    std::deque<Position> positions;
    RobustVelocity velocity;
    bool moving = false, known = false;
    int calm = 0;           // number of consecutive slow frames
    int stood = 0;          // number of frames in which its surface was where it had been
    bool has_left = false;  // its first position, or a part of it
    double last_seen_s = 0;
  };

  [[nodiscard]] Track& track_of(TrackId id);
  [[nodiscard]] std::optional<Position> position_of(const View& view,
                                                    const TrackedObject& object,
                                                    const ObjectState& state) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> surface_of(const View& view,
                                                        const TrackedObject& object,
                                                        const ObjectState& state) const;
  [[nodiscard]] double vacated(const Position& old, const View& view, int id) const;
  [[nodiscard]] RobustVelocity velocity_of(const Track& track) const;
  [[nodiscard]] Motion motion_of(const Track& track, const ObjectState& state) const;
  void add_position(Track& track, Position position) const;
  void decide(Track& track, bool cut_off, double vacated_share) const;

  MotionStateConfig config_;
  CameraModel camera_;
  std::vector<Track> tracks_;  // by id
};

}  // namespace stillmap
