// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/video_node.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <system_error>

#include <linux/videodev2.h>

namespace stillmap {
namespace {

constexpr std::uint32_t kMostListed = 256;  // of formats, sizes and rates

std::string reason(int number) {
  return std::generic_category().message(number);
}

// Of nodes that scale to any size.
constexpr std::array<std::array<std::uint32_t, 2>, 5> kUsualSizes = {
    {{640, 480}, {848, 480}, {640, 360}, {424, 240}, {320, 240}}};

bool in_steps(std::uint32_t value, std::uint32_t least, std::uint32_t most, std::uint32_t step) {
  return value >= least && value <= most && (value - least) % std::max(step, 1U) == 0;
}

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double rate_of_interval(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0
                                 : static_cast<double>(interval.denominator) / interval.numerator;
}

}  // namespace

VideoNode::VideoNode(VideoSystem& system, const std::string& path, const std::string& place)
    : system_(system), path_(path), place_(place), descriptor_(system.open(path)) {
  if (descriptor_ < 0) {
    throw Error("{}: {} cannot be opened: {}", place_, path_, reason(errno));
  }
  try {
    check_capability();
    list_modes();
  } catch (...) {
    system_.close(descriptor_);
    throw;
  }
}

VideoNode::~VideoNode() {
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  (void)control(VIDIOC_STREAMOFF, type);  // fails where it never began, and where the node is gone
  for (const Buffer& buffer : buffers_) system_.unmap(buffer.memory, buffer.bytes);
  system_.close(descriptor_);
}

template <class Argument>
bool VideoNode::control(std::uint64_t request, Argument& argument) {
  return system_.control(descriptor_, request, &argument) == 0;
}

template <class Argument>
void VideoNode::demand(std::uint64_t request, Argument& argument, const char* what) {
  if (control(request, argument)) return;
  throw Error("{}: {} {}: {}", place_, path_, what, reason(errno));
}

bool VideoNode::gives(VideoKind kind) const {
  return std::ranges::any_of(
      modes_, [&](const VideoMode& mode) { return video_kind(mode.format) == kind; });
}

void VideoNode::check_capability() {
  v4l2_capability told{};
  if (!control(VIDIOC_QUERYCAP, told)) throw Error("{}: {} is no video node", place_, path_);
  const std::uint32_t can =
      (told.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? told.device_caps : told.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    throw Error("{}: {} takes no images (cameras have other nodes for metadata)", place_, path_);
  }
  if ((can & V4L2_CAP_STREAMING) == 0) throw Error("{}: {} does not stream", place_, path_);
}

void VideoNode::list_modes() {
  v4l2_fmtdesc told{};
  told.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  for (told.index = 0; told.index < kMostListed && control(VIDIOC_ENUM_FMT, told); ++told.index) {
    list_sizes(told.pixelformat);
  }
}

void VideoNode::list_sizes(std::uint32_t format) {
  v4l2_frmsizeenum told{};
  told.pixel_format = format;
  for (told.index = 0; told.index < kMostListed && control(VIDIOC_ENUM_FRAMESIZES, told);
       ++told.index) {
    if (told.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      add_mode(format,
               {static_cast<int>(told.discrete.width), static_cast<int>(told.discrete.height)});
      continue;
    }
    const v4l2_frmsize_stepwise& range = told.stepwise;
    for (const auto& [width, height] : kUsualSizes) {
      if (in_steps(width, range.min_width, range.max_width, range.step_width) &&
          in_steps(height, range.min_height, range.max_height, range.step_height)) {
        add_mode(format, {static_cast<int>(width), static_cast<int>(height)});
      }
    }
    return;
  }
}

void VideoNode::add_mode(std::uint32_t format, cv::Size size) {
  constexpr int kMostSidePx = 8192;
  if (size.width < 1 || size.height < 1 || size.width > kMostSidePx || size.height > kMostSidePx) {
    return;
  }
  modes_.push_back({format, size, rate_of(format, size)});
}

double VideoNode::rate_of(std::uint32_t format, cv::Size size) {
  v4l2_frmivalenum told{};
  told.pixel_format = format;
  told.width = static_cast<std::uint32_t>(size.width);
  told.height = static_cast<std::uint32_t>(size.height);
  double best_hz = 0;
  for (told.index = 0; told.index < kMostListed && control(VIDIOC_ENUM_FRAMEINTERVALS, told);
       ++told.index) {
    if (told.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
      return std::min(kVideoRateHz, rate_of_interval(told.stepwise.min));
    }
    const double rate_hz = rate_of_interval(told.discrete);
    if (rate_hz < kVideoRateHz + 1) best_hz = std::max(best_hz, rate_hz);
  }
  return best_hz;
}

void VideoNode::set_format(const VideoMode& mode) {
  v4l2_format asked{};
  asked.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  asked.fmt.pix.width = static_cast<std::uint32_t>(mode.size.width);
  asked.fmt.pix.height = static_cast<std::uint32_t>(mode.size.height);
  asked.fmt.pix.pixelformat = mode.format;
  asked.fmt.pix.field = V4L2_FIELD_NONE;
  demand(VIDIOC_S_FMT, asked, "refuses its format");
  const v4l2_pix_format& given = asked.fmt.pix;
  if (given.pixelformat != mode.format ||
      given.width != static_cast<std::uint32_t>(mode.size.width) ||
      given.height != static_cast<std::uint32_t>(mode.size.height)) {
    throw Error("{}: {} gives {} of {}x{} pixels, asked for {} of {}x{}",
                place_,
                path_,
                format_name(given.pixelformat),
                given.width,
                given.height,
                format_name(mode.format),
                mode.size.width,
                mode.size.height);
  }
  layout_ = {mode.format, mode.size, given.bytesperline};
  v4l2_streamparm rate{};
  rate.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  rate.parm.capture.timeperframe = {1000,
                                    static_cast<std::uint32_t>(std::lround(
                                        1000 * (mode.rate_hz > 0 ? mode.rate_hz : kVideoRateHz)))};
  (void)control(VIDIOC_S_PARM, rate);  // some drivers have one rate only and refuse the question
}

void VideoNode::map_buffers() {
  v4l2_requestbuffers asked{};
  asked.count = 4;
  asked.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  asked.memory = V4L2_MEMORY_MMAP;
  demand(VIDIOC_REQBUFS, asked, "gives no buffers");
  if (asked.count < 2 || asked.count > 32) {
    throw Error("{}: {} gives {} buffers, expected 2 or more", place_, path_, asked.count);
  }
  for (std::uint32_t index = 0; index < asked.count; ++index) {
    v4l2_buffer told{};
    told.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    told.memory = V4L2_MEMORY_MMAP;
    told.index = index;
    demand(VIDIOC_QUERYBUF, told, "does not tell its buffers");
    void* const memory = system_.map(descriptor_, told.length, told.m.offset);
    if (memory == nullptr) {
      throw Error("{}: {} does not share its buffers: {}", place_, path_, reason(errno));
    }
    buffers_.push_back({memory, told.length});
    give_back(index);
  }
}

void VideoNode::give_back(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  if (control(VIDIOC_QBUF, buffer)) return;
  throw VideoNodeGone("{}: {} takes no buffer: {}", place_, path_, reason(errno));
}

void VideoNode::start(const VideoMode& mode) {
  set_format(mode);
  map_buffers();
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  demand(VIDIOC_STREAMON, type, "does not begin");
}

std::optional<RawVideo> VideoNode::read() {
  v4l2_buffer filled{};
  filled.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  filled.memory = V4L2_MEMORY_MMAP;
  if (!control(VIDIOC_DQBUF, filled)) {
    if (errno == EAGAIN) return std::nullopt;
    throw VideoNodeGone("{}: {} is gone: {}", place_, path_, reason(errno));
  }
  if (filled.index >= buffers_.size()) {
    throw VideoNodeGone("{}: {} gives a buffer that it has not", place_, path_);
  }
  const Buffer& buffer = buffers_[filled.index];
  const auto* const bytes = static_cast<const std::uint8_t*>(buffer.memory);
  RawVideo raw;
  const bool monotonic =
      (filled.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  raw.stamp_s = monotonic ? static_cast<double>(filled.timestamp.tv_sec) +
                                1e-6 * static_cast<double>(filled.timestamp.tv_usec)
                          : steady_s();
  raw.damaged = (filled.flags & V4L2_BUF_FLAG_ERROR) != 0;
  raw.bytes.assign(bytes, bytes + std::min<std::size_t>(filled.bytesused, buffer.bytes));
  give_back(filled.index);
  return raw;
}

}  // namespace stillmap
