// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/perception/objects/frame_objects.hpp"
#include "stillmap/system/observer.hpp"
#include "tooling/browser/ghost_points.hpp"

namespace stillmap {

/// Keeps the surface of what moves: the points of dynamic objects in every frame, within 0.6 m of
/// the middle of each object's depths.
class MovingPoints : public Observer {
 public:
  explicit MovingPoints(const CameraModel& camera);

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  /// Gives the points the tracks that their objects are known by at the end.
  void on_end(const RunResult& result) override;

  /// The points as binary PLY: `float x y z`, `uchar red green blue`, `int track`, `double stamp`
  /// (seconds). They are in the world frame under the poses of `final_poses`; frames without one
  /// are left out.
  [[nodiscard]] std::string ply(const Trajectory& final_poses) const;

  /// The points of every frame that has some, for the report; of more than `most` so many, evenly
  /// spread.
  [[nodiscard]] std::vector<StampedGhosts> ghosts(std::size_t most) const;

 private:
  struct Point {
    Eigen::Vector3f p_camera;
    Rgb color;
    TrackId track;
    std::uint8_t place;  // of its object in the frame's list
  };
  struct Frame {
    Stamp stamp;
    std::vector<Point> points;
  };

  cv::Mat2f rays_;
  std::vector<Frame> frames_;
};

}  // namespace stillmap
