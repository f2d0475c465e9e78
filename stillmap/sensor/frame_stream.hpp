// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "stillmap/core/ids.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/core/trajectory.hpp"
#include "stillmap/geometry/camera.hpp"

namespace stillmap {

/// A frame whose images could not be read.
struct DamagedFrame {
  FrameId id;          ///< its position in the sequence
  Stamp stamp;         ///< of its colour image
  std::string damage;  ///< one line that says which image is damaged, and how
};

/// A frame, never null, or the reason why it could not be read.
using StreamedFrame = std::variant<FramePtr, DamagedFrame>;

/// The id of a frame, damaged or not.
[[nodiscard]] inline FrameId id_of(const StreamedFrame& streamed) {
  const FramePtr* const frame = std::get_if<FramePtr>(&streamed);
  return frame != nullptr ? (*frame)->id : std::get<DamagedFrame>(streamed).id;
}

/// The stamp of a frame, damaged or not.
[[nodiscard]] inline const Stamp& stamp_of(const StreamedFrame& streamed) {
  const FramePtr* const frame = std::get_if<FramePtr>(&streamed);
  return frame != nullptr ? (*frame)->stamp : std::get<DamagedFrame>(streamed).stamp;
}

/// The sensor as the rest of stillmap sees it: one RGB-D frame after another, of one camera. A
/// camera's driver, a recording and a folder of images implement it; no other module knows which of
/// them gives the frames.
///
/// Every frame has colour, grey and depth images of the camera's size, depth in metres with 0 where
/// nothing was measured. Ids and stamps of frames strictly increase, over damaged frames too; ids
/// need not be consecutive.
class FrameStream {
 public:
  FrameStream() = default;
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;
  virtual ~FrameStream() = default;

  /// The camera that takes the frames. May be called on any thread.
  [[nodiscard]] virtual const CameraModel& camera() const = 0;

  /// The number of frames from the first to the end, damaged ones included; nothing where it is not
  /// known. May be called on any thread. For progress, and for the share of damaged frames.
  [[nodiscard]] virtual std::optional<std::size_t> size() const { return std::nullopt; }

  /// Whether the end came before that of the recording, because somebody asked for it. May be
  /// called on any thread.
  [[nodiscard]] virtual bool ended_early() const { return false; }

  /// The next frame; waits for one that has not been taken yet. Nothing at the end. Called by one
  /// thread at a time. Throws Error for an image of the wrong kind or size, and for a sensor that
  /// has failed: after that there is no next frame.
  [[nodiscard]] virtual std::optional<StreamedFrame> next() = 0;

  /// What was wrong with the frames so far although every pixel could be read, in one line for each
  /// kind. Not to be called during next().
  [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
};

}  // namespace stillmap
