// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/sensor/depth_registration.hpp"
#include "stillmap/sensor/sequence_content.hpp"

namespace stillmap {

struct FrameReading {
  FramePtr frame;       ///< not null
  std::string warning;  ///< see ColorFile; empty if nothing is wrong
};

/// Makes the frames of a sequence from its images, as its camera sees them. Where the depth images
/// have a camera of their own, they are brought into the color camera's view.
class FrameReader {
 public:
  explicit FrameReader(const CameraModel& camera = {});

  [[nodiscard]] const CameraModel& camera() const { return camera_; }

  /// The frame `id` of `content`; `place` names the recording where images have no files. May run
  /// in any number of threads. Throws DamagedImage, naming the file, when an image is missing or
  /// broken, and Error when it is of the wrong kind or not of its camera's size.
  [[nodiscard]] FrameReading read(const SequenceContent& content,
                                  FrameId id,
                                  const std::filesystem::path& place) const;

 private:
  CameraModel camera_;
  std::optional<DepthRegistration> registration_;
};

}  // namespace stillmap
