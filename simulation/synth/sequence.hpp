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

/// A camera like TUM's fr3, without distortion, for images of another size: the field of view
/// across stays, the optical centre keeps its place. Stored depth: 5000 units a metre.
[[nodiscard]] CameraModel synthetic_camera(int width_px, int height_px);

struct SyntheticOptions {
  PathKind path = PathKind::kXyz;
  Activity activity = Activity::kNone;
  CameraModel camera = synthetic_camera(640, 480);
  std::size_t frames = 300;
  double frames_per_second = 30.0;
  std::uint32_t seed = 0;  ///< of the pictures on things, the people's clothes, the sensor's noise
  std::shared_ptr<const Assets> assets;  ///< people and furniture to use; null: none
  RenderOptions render;                  ///< effects of light
  SensorOptions sensor;                  ///< a Kinect's effects unless SensorOptions::clean()
};

/// A frame as the sensor gives it, and the truth about it.
struct SyntheticFrame {
  FramePtr frame;
  RenderedImage truth;  ///< without the sensor's faults
};

/// The corners of something that can move, where it is at one time.
struct MovableSurface {
  std::uint8_t id = 0;
  std::vector<Eigen::Vector3f> p_world;
};

/// The surfaces of all that can move: things by their order in the world, then people.
[[nodiscard]] std::vector<MovableSurface> movable_surfaces(const World& world,
                                                           const WorldState& state);

/// A sequence in the office of make_office() along a path, with exact truth. Frames are rendered
/// when asked for; asking for the same frame twice gives equal bytes. Safe to use from several
/// threads.
class SyntheticSequence {
 public:
  explicit SyntheticSequence(const SyntheticOptions& options);

  [[nodiscard]] std::size_t size() const { return options_.frames; }
  [[nodiscard]] const CameraModel& camera() const { return options_.camera; }
  [[nodiscard]] const SyntheticOptions& options() const { return options_; }
  [[nodiscard]] const World& world() const { return *world_; }

  /// Frame `id`, which is below size(). Its depth is taken at the same time as its colour.
  [[nodiscard]] SyntheticFrame render(FrameId id) const;
  [[nodiscard]] FramePtr frame(FrameId id) const { return render(id).frame; }

  /// When frame `id` was taken (the middle of its exposure); six decimals, the first at 1000 s.
  [[nodiscard]] Stamp stamp(FrameId id) const;

  /// The true pose of frame `id`, in the office's coordinates.
  [[nodiscard]] Eigen::Isometry3d pose(FrameId id) const;

  /// stamp() and pose() of every frame.
  [[nodiscard]] Trajectory ground_truth() const;

  /// Where everything is in frame `id`.
  [[nodiscard]] WorldState state(FrameId id) const;

  /// How fast what can move is in frame `id`, as the mean over its corners; in the order of
  /// movable_surfaces().
  [[nodiscard]] std::vector<ObjectSpeed> speeds(FrameId id) const;

  /// The ids of what moves in any frame, ascending.
  [[nodiscard]] std::vector<int> moved_ids() const;

 private:
  [[nodiscard]] double time_s(FrameId id) const;
  [[nodiscard]] Exposure exposure(FrameId id) const;

  SyntheticOptions options_;
  std::shared_ptr<const World> world_;
  Choreography choreography_;
  Renderer renderer_;
};

}  // namespace stillmap
