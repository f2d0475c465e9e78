// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include <poll.h>

namespace stillmap {

/// The system's calls that a video node needs, as the manual pages of Linux describe them: -1 (or a
/// null pointer) and errno where they fail. A test plays a driver in its place.
class VideoSystem {
 public:
  VideoSystem() = default;
  VideoSystem(const VideoSystem&) = delete;
  VideoSystem& operator=(const VideoSystem&) = delete;
  virtual ~VideoSystem() = default;

  /// A descriptor for reading and writing whose calls do not wait.
  [[nodiscard]] virtual int open(const std::string& path) = 0;
  virtual void close(int descriptor) = 0;
  /// An ioctl; one that a signal interrupts goes on.
  [[nodiscard]] virtual int control(int descriptor, std::uint64_t request, void* argument) = 0;
  /// Memory that is shared with the driver; null where that fails.
  [[nodiscard]] virtual void* map(int descriptor, std::size_t bytes, std::int64_t offset) = 0;
  virtual void unmap(void* memory, std::size_t bytes) = 0;
  [[nodiscard]] virtual int poll(std::span<pollfd> descriptors, int timeout_ms) = 0;
};

/// That of this machine.
[[nodiscard]] VideoSystem& linux_video();

}  // namespace stillmap
