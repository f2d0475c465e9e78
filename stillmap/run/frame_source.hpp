// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "stillmap/core/channel.hpp"
#include "stillmap/io/tum_sequence.hpp"

namespace stillmap {

/// A frame of a sequence, or why it could not be read.
struct SourcedFrame {
  FrameId id;
  FramePtr frame;      ///< null when its images are damaged
  std::string damage;  ///< then: what is wrong, in one line
};

/// Frames of a sequence in a given order, read ahead on a thread of its own or one at a time.
class FrameSource {
 public:
  /// The sequence outlives the source.
  FrameSource(const TumSequence& sequence, std::vector<FrameId> frames, bool read_ahead);
  ~FrameSource();
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  /// The next frame; nothing at the end. Throws Error for an image of the wrong kind or size.
  [[nodiscard]] std::optional<SourcedFrame> next();

 private:
  [[nodiscard]] SourcedFrame read(FrameId id) const;
  void run();

  static constexpr std::size_t kAhead = 4;
  const TumSequence& sequence_;
  std::vector<FrameId> frames_;
  std::size_t next_ = 0;
  Channel<SourcedFrame> channel_{kAhead};
  std::jthread reader_;  // last: it runs while the rest lives
};

}  // namespace stillmap
