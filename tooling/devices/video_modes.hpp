// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <opencv2/core/types.hpp>

namespace stillmap {

/// The rate that is asked for, where a node has it.
inline constexpr double kVideoRateHz = 30;

/// What a video node can give: the code of its pixels (V4L2_PIX_FMT_...), a size and a rate.
struct VideoMode {
  std::uint32_t format = 0;
  cv::Size size;
  double rate_hz = 0;  ///< the highest up to 30; 0: not told
};

/// What the pixels of a format are.
enum class VideoKind { kColor, kDepth, kOther };
[[nodiscard]] VideoKind video_kind(std::uint32_t format);

/// A format by its four characters, such as "YUYV".
[[nodiscard]] std::string format_name(std::uint32_t format);

/// The modes in which two nodes are to run. Of a named camera, the sizes of its images; else the
/// largest size up to 640x480 that both have, at 30 Hz where they have that. Of several formats of
/// colour, one without loss is preferred, then JPEG, then gray. Nothing where none fits.
struct WantedSizes {
  std::optional<cv::Size> color, depth;  ///< of a named camera
};
[[nodiscard]] std::optional<std::pair<VideoMode, VideoMode>> choose_video_modes(
    const std::vector<VideoMode>& color,
    const std::vector<VideoMode>& depth,
    const WantedSizes& wanted);

/// The modes, each once, for messages.
[[nodiscard]] std::string listed_modes(const std::vector<VideoMode>& modes);

}  // namespace stillmap
