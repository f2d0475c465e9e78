// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/video_modes.hpp"

#include <algorithm>
#include <array>

#include <fmt/core.h>
#include <linux/videodev2.h>

#include "stillmap/core/joined.hpp"

namespace stillmap {
namespace {

// Formats of colour, the preferred ones first.
constexpr std::array<std::uint32_t, 5> kColorFormats = {V4L2_PIX_FMT_RGB24,
                                                        V4L2_PIX_FMT_YUYV,
                                                        V4L2_PIX_FMT_UYVY,
                                                        V4L2_PIX_FMT_MJPEG,
                                                        V4L2_PIX_FMT_GREY};

bool fits(const VideoMode& mode, VideoKind kind, const std::optional<cv::Size>& wanted) {
  if (video_kind(mode.format) != kind) return false;
  return wanted ? mode.size == *wanted : mode.size.width <= 640 && mode.size.height <= 480;
}

// A rate that is not told counts as fast enough.
bool is_fast(const VideoMode& mode) {
  return mode.rate_hz == 0 || mode.rate_hz > kVideoRateHz - 1;
}

int place_of(std::uint32_t color_format) {
  return static_cast<int>(std::ranges::find(kColorFormats, color_format) - kColorFormats.begin());
}

}  // namespace

VideoKind video_kind(std::uint32_t format) {
  if (format == V4L2_PIX_FMT_Z16) return VideoKind::kDepth;
  return std::ranges::find(kColorFormats, format) != kColorFormats.end() ? VideoKind::kColor
                                                                         : VideoKind::kOther;
}

std::string format_name(std::uint32_t format) {
  std::string name;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    name += static_cast<char>(format >> shift & 0x7FU);
  }
  name.erase(name.find_last_not_of(' ') + 1);
  return name;
}

std::optional<std::pair<VideoMode, VideoMode>> choose_video_modes(
    const std::vector<VideoMode>& color,
    const std::vector<VideoMode>& depth,
    const WantedSizes& wanted) {
  std::optional<std::pair<VideoMode, VideoMode>> best;
  std::array<double, 4> best_rank{};
  for (const VideoMode& c : color) {
    for (const VideoMode& d : depth) {
      if (!fits(c, VideoKind::kColor, wanted.color) || !fits(d, VideoKind::kDepth, wanted.depth)) {
        continue;
      }
      if (!wanted.color && c.size != d.size) continue;
      const std::array<double, 4> rank = {is_fast(c) && is_fast(d) ? 1.0 : 0.0,
                                          static_cast<double>(c.size.area()),
                                          std::min(c.rate_hz, d.rate_hz),
                                          static_cast<double>(-place_of(c.format))};
      if (best && rank <= best_rank) continue;
      best = {c, d};
      best_rank = rank;
    }
  }
  return best;
}

std::string listed_modes(const std::vector<VideoMode>& modes) {
  std::vector<std::string> names;
  for (const VideoMode& mode : modes) {
    std::string name =
        fmt::format("{} {}x{}", format_name(mode.format), mode.size.width, mode.size.height);
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  }
  return names.empty() ? "none" : joined(names, ", ");
}

}  // namespace stillmap
