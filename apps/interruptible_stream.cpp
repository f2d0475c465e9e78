// SPDX-License-Identifier: Apache-2.0
#include "apps/interruptible_stream.hpp"

#include <fmt/core.h>

#include "apps/interruption.hpp"

namespace stillmap {

std::optional<std::size_t> InterruptibleStream::size() const {
  return ended_early_ ? std::optional<std::size_t>(frames_) : stream_.size();
}

std::string InterruptibleStream::interruption() const {
  if (!ended_early_) return {};
  const std::optional<std::size_t> total = stream_.size();
  return fmt::format("interrupted after {}{} frames: the results are of these",
                     frames_.load(),
                     total ? fmt::format(" of {}", *total) : "");
}

std::optional<StreamedFrame> InterruptibleStream::next() {
  if (interruption_noted()) {
    const std::optional<std::size_t> total = stream_.size();
    ended_early_ = !total || frames_ < *total;
    return std::nullopt;
  }
  std::optional<StreamedFrame> frame = stream_.next();
  if (frame) ++frames_;
  return frame;
}

}  // namespace stillmap
