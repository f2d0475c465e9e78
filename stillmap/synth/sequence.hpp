// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "stillmap/core/camera.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/synth/camera_path.hpp"
#include "stillmap/synth/renderer.hpp"
#include "stillmap/synth/sensor.hpp"

namespace stillmap {

/// A camera like TUM's fr3, without distortion, for images of another size: the field of view
/// across stays, the optical centre keeps its place. Stored depth: 5000 units a metre.
[[nodiscard]] CameraModel synthetic_camera(int width_px, int height_px);

struct SyntheticOptions {
  PathKind path = PathKind::kXyz;
  CameraModel camera = synthetic_camera(640, 480);
  std::size_t frames = 300;
  double frames_per_second = 30.0;
  std::uint32_t seed = 0;  ///< of the scene's textures and the sensor's noise
  SensorOptions sensor;    ///< a Kinect's effects unless SensorOptions::clean()
};

/// A sequence of the room of make_room() along a path, with exact truth. Frames are rendered when
/// asked for; asking for the same frame twice gives equal bytes. Safe to use from several threads.
class SyntheticSequence {
 public:
  explicit SyntheticSequence(const SyntheticOptions& options);

  [[nodiscard]] std::size_t size() const { return options_.frames; }
  [[nodiscard]] const CameraModel& camera() const { return options_.camera; }
  [[nodiscard]] const SyntheticOptions& options() const { return options_; }

  /// Frame `id`, which is below size(). Its depth is taken at the same time as its colour.
  [[nodiscard]] FramePtr frame(FrameId id) const;

  /// When frame `id` was taken; six decimals, the first at 1000 s.
  [[nodiscard]] Stamp stamp(FrameId id) const;

  /// The true pose of frame `id`, in the room's coordinates.
  [[nodiscard]] Eigen::Isometry3d pose(FrameId id) const;

  /// stamp() and pose() of every frame.
  [[nodiscard]] Trajectory ground_truth() const;

 private:
  SyntheticOptions options_;
  Renderer renderer_;
};

/// Writes a sequence in the layout of the TUM RGB-D benchmark, with PNG images, associations.txt,
/// camera.yaml and groundtruth.txt. `on_progress`, where given, is called with the number of frames
/// done and of all. Throws Error for a folder that holds something already, and when anything
/// cannot be written; the lists come last, so that a folder with rgb.txt is complete.
void write_tum_sequence(const SyntheticSequence& sequence,
                        const std::filesystem::path& folder,
                        const std::function<void(std::size_t, std::size_t)>& on_progress = nullptr);

}  // namespace stillmap
