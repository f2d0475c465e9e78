// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/sensor/tum_sequence.hpp"

namespace stillmap {

/// A frame of a sequence, or why it could not be read.
struct SourcedFrame {
  FrameId id;
  FramePtr frame;      ///< null when its images are damaged
  std::string damage;  ///< then: what is wrong, in one line
  double reading_ms = 0;
};

/// Frames of a sequence in a given order.
class FrameSource {
 public:
  /// The sequence outlives the source.
  FrameSource(const TumSequence& sequence, std::vector<FrameId> frames, StageProbe probe = {});

  /// The next frame; nothing at the end. Throws Error for an image of the wrong kind or size.
  [[nodiscard]] std::optional<SourcedFrame> next();

 private:
  const TumSequence& sequence_;
  std::vector<FrameId> frames_;
  StageProbe probe_;
  std::size_t next_ = 0;
};

}  // namespace stillmap
