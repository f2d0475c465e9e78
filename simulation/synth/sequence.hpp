// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "simulation/render/renderer.hpp"
#include "simulation/scene/assets.hpp"
#include "simulation/scene/choreography.hpp"
#include "simulation/synth/camera_path.hpp"
#include "simulation/synth/sensor.hpp"
#include "simulation/synth/truth.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// A camera like fr3 of TUM, without distortion, for images of another size, with the same
/// horizontal field of view and relative optical centre. Stored depth has 5000 units per metre.
[[nodiscard]] CameraModel synthetic_camera(int width_px, int height_px);

/// When the rows of a frame's images are taken. The middle row of the colour image is taken at the
/// frame's stamp; things that move are shown as they are then in all rows of it.
struct ImageDelays {
  double readout_s = 0;        ///< rolling shutter of colour: from the first row to the last
  double depth_readout_s = 0;  ///< the same of depth
  double depth_delay_s = 0;    ///< how much later than colour the middle row of depth is taken
  /// Whether the stamps of depth images are the times at which they are taken; else they are those
  /// of the colour images.
  bool depth_stamps_tell = true;

  [[nodiscard]] bool none() const {
    return readout_s == 0 && depth_readout_s == 0 && depth_delay_s == 0;
  }
};

struct SyntheticOptions {
  PathKind path = PathKind::kXyz;
  Activity activity = Activity::kNone;
  CameraModel camera = synthetic_camera(640, 480);
  std::size_t frames = 300;
  double frames_per_second = 30.0;
  std::uint32_t seed = 0;                ///< seed of pictures, clothes and sensor noise
  std::shared_ptr<const Assets> assets;  ///< people and furniture; null: none
  RenderOptions render;                  ///< effects of light
  SensorOptions sensor;                  ///< faults of a Kinect unless SensorOptions::clean()
  ImageDelays delays;                    ///< when the rows of the images are taken
};

/// A frame of the sensor with its truth.
struct SyntheticFrame {
  FramePtr frame;
  RenderedImage truth;  ///< all rows at the frame's time, without the sensor's faults
  cv::Mat1b ids;        ///< mask ids of the pixels of the colour image
};

/// The vertices of a movable object at one time.
struct MovableSurface {
  std::uint8_t id = 0;
  std::vector<Eigen::Vector3f> p_world;
};

/// The surfaces of all movable objects: things in the order of the world, then people.
[[nodiscard]] std::vector<MovableSurface> movable_surfaces(const World& world,
                                                           const WorldState& state);

/// A sequence along a path in the office of make_office(), with exact truth. Frames are rendered on
/// demand; the same frame always has the same bytes. Safe to use from several threads.
class SyntheticSequence {
 public:
  explicit SyntheticSequence(const SyntheticOptions& options);

  [[nodiscard]] std::size_t size() const { return options_.frames; }
  [[nodiscard]] const CameraModel& camera() const { return options_.camera; }
  [[nodiscard]] const SyntheticOptions& options() const { return options_; }
  [[nodiscard]] const World& world() const { return *world_; }

  /// Frame `id`, which must be below size().
  [[nodiscard]] SyntheticFrame render(FrameId id) const;
  [[nodiscard]] FramePtr frame(FrameId id) const { return render(id).frame; }

  /// The colour image of frame `id` from a second camera, `baseline_m` to the right of the first.
  [[nodiscard]] ColorImage right_image(FrameId id, double baseline_m) const;

  /// The stamp of frame `id`, the middle of its exposure, with six decimals. The first is 1000 s.
  [[nodiscard]] Stamp stamp(FrameId id) const;
  /// The stamp of the depth image of frame `id`.
  [[nodiscard]] Stamp depth_stamp(FrameId id) const;

  /// The true pose of frame `id` in the coordinates of the office.
  [[nodiscard]] Eigen::Isometry3d pose(FrameId id) const;

  /// The stamps and poses of all frames.
  [[nodiscard]] Trajectory ground_truth() const;

  /// The state of the world in frame `id`.
  [[nodiscard]] WorldState state(FrameId id) const;

  /// The speeds of the movable objects in frame `id`, as means over their vertices, in the order of
  /// movable_surfaces().
  [[nodiscard]] std::vector<ObjectSpeed> speeds(FrameId id) const;

  /// The ids of the objects that move in any frame, ascending.
  [[nodiscard]] std::vector<int> moved_ids() const;

 private:
  [[nodiscard]] double time_s(FrameId id) const;
  [[nodiscard]] Exposure exposure(double middle_s, double readout_s) const;
  [[nodiscard]] CameraExposure camera_exposure(double middle_s) const;

  SyntheticOptions options_;
  std::shared_ptr<const World> world_;
  Choreography choreography_;
  Renderer renderer_;
};

}  // namespace stillmap
