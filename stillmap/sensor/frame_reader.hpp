// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/depth_registration.hpp"
#include "stillmap/sensor/tum_sequence.hpp"

namespace stillmap {

/// Reads the images of a frame from their files. Where the depth images have a camera of their own,
/// they are brought into the color camera's view.
class FrameReader {
 public:
  explicit FrameReader(const CameraModel& camera);

  [[nodiscard]] const CameraModel& camera() const { return camera_; }

  /// May run in any number of threads. Throws Error, naming the file, when an image is missing,
  /// broken, of the wrong kind or not of its camera's size.
  [[nodiscard]] FramePtr read(const SequenceEntry& files, FrameId id) const;

 private:
  CameraModel camera_;
  std::optional<DepthRegistration> registration_;
};

}  // namespace stillmap
