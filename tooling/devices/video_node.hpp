// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stillmap/core/error.hpp"
#include "stillmap/core/images.hpp"
#include "tooling/devices/video_modes.hpp"
#include "tooling/devices/video_system.hpp"

namespace stillmap {

/// The error of a video node that has vanished, as one that was unplugged.
class VideoNodeGone : public Error {
 public:
  using Error::Error;
};

/// An image as the driver gave it.
struct RawVideo {
  double stamp_s = 0;  ///< by the clock that Linux calls monotonic
  std::vector<std::uint8_t> bytes;
  bool damaged = false;  ///< the driver says so
};

/// How the bytes of a node's images are to be read.
struct VideoLayout {
  std::uint32_t format = 0;
  cv::Size size;
  std::size_t row_bytes = 0;
};

/// A video node of Linux, such as /dev/video0 (V4L2, one plane, streaming).
class VideoNode {
 public:
  /// Opens it. Messages begin with `place`. Throws Error where it cannot be opened, or is no source
  /// of images. `system` outlives the object.
  VideoNode(VideoSystem& system, const std::string& path, const std::string& place);
  VideoNode(const VideoNode&) = delete;
  VideoNode& operator=(const VideoNode&) = delete;
  ~VideoNode();

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::vector<VideoMode>& modes() const { return modes_; }
  /// Whether a mode has pixels of the kind.
  [[nodiscard]] bool gives(VideoKind kind) const;

  /// Begins to take images. Throws Error where the driver refuses the mode or gives another.
  void start(const VideoMode& mode);
  [[nodiscard]] const VideoLayout& layout() const { return layout_; }
  /// To be waited for until it is ready for reading.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// The oldest image that waits; nothing where none does. Throws VideoNodeGone.
  [[nodiscard]] std::optional<RawVideo> read();

 private:
  struct Buffer {
    void* memory = nullptr;
    std::size_t bytes = 0;
  };
  template <class Argument>
  [[nodiscard]] bool control(std::uint64_t request, Argument& argument);
  template <class Argument>
  void demand(std::uint64_t request, Argument& argument, const char* what);
  void check_capability();
  void list_modes();
  void list_sizes(std::uint32_t format);
  void add_mode(std::uint32_t format, cv::Size size);
  [[nodiscard]] double rate_of(std::uint32_t format, cv::Size size);
  void set_format(const VideoMode& mode);
  void map_buffers();
  void give_back(std::uint32_t index);

  VideoSystem& system_;
  std::string path_, place_;
  int descriptor_ = -1;
  std::vector<VideoMode> modes_;
  VideoLayout layout_;
  std::vector<Buffer> buffers_;
};

/// The pixels of an image: RGB24, YUYV, UYVY, MJPG, GREY. Throws DamagedImage, beginning with
/// `place`, for fewer bytes than its size needs.
[[nodiscard]] ColorImage video_color(const RawVideo& raw,
                                     const VideoLayout& layout,
                                     const std::string& place);
/// The depth of an image (Z16, in units of 1 / `depth_factor` metres); 0 and 65535 mean that
/// nothing was measured. Throws as above.
[[nodiscard]] DepthImage video_depth(const RawVideo& raw,
                                     const VideoLayout& layout,
                                     double depth_factor,
                                     const std::string& place);

}  // namespace stillmap
