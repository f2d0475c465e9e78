// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <linux/videodev2.h>
#include <opencv2/core/types.hpp>

#include "stillmap/sensor/clock.hpp"
#include "tooling/devices/video_system.hpp"

namespace stillmap {

/// A kernel with the video nodes that a test describes, by the documentation of V4L2. What a test
/// has written down happens while somebody waits in poll(); time is that of the test's clock.
class FakeVideo : public VideoSystem {
 public:
  struct Format {
    std::uint32_t format = 0;
    std::vector<cv::Size> sizes;
    std::vector<std::uint32_t> rates_hz = {30};
  };
  struct Node {
    std::vector<Format> formats;
    std::uint32_t can = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    std::uint32_t row_padding = 0;                   ///< bytes at the end of each row
    std::optional<std::uint32_t> given_format = {};  ///< whatever is asked for
    std::optional<cv::Size> given_size = {};         ///< whatever is asked for
    bool there = true;
  };
  /// One thing that happens, `after_s` after the thing before it.
  struct Event {
    double after_s = 0;
    std::string node;
    enum class What { kImage, kUnplugged, kPluggedIn } what = What::kImage;
    double stamp_s = 0;
    std::vector<std::uint8_t> bytes = {};
    std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  };

  explicit FakeVideo(Clock& clock) : clock_(clock) {}

  std::map<std::string, Node> nodes;
  std::deque<Event> events;
  int opened = 0, mapped = 0;  ///< and not closed or unmapped since

  [[nodiscard]] int open(const std::string& path) override {
    const auto node = nodes.find(path);
    if (node == nodes.end() || !node->second.there) return failed(ENOENT);
    ++opened;
    open_[next_descriptor_].path = path;
    return next_descriptor_++;
  }
  void close(int descriptor) override { opened -= static_cast<int>(open_.erase(descriptor)); }
  [[nodiscard]] void* map(int descriptor, std::size_t bytes, std::int64_t offset) override {
    std::vector<std::uint8_t>& memory =
        open_.at(descriptor).memory.at(static_cast<std::size_t>(offset) / kOffset);
    ++mapped;
    return bytes == memory.size() ? memory.data() : nullptr;
  }
  void unmap(void* /*memory*/, std::size_t /*bytes*/) override { --mapped; }

  [[nodiscard]] int poll(std::span<pollfd> descriptors, int timeout_ms) override {
    const double until_s = clock_.now_s() + 1e-3 * timeout_ms;
    for (;;) {
      const int ready = count_ready(descriptors);
      if (ready > 0) return ready;
      if (!next_s_ && !events.empty()) next_s_ = clock_.now_s() + events.front().after_s;
      if (!next_s_ || *next_s_ > until_s) {
        clock_.wait_until_s(until_s);
        return 0;
      }
      clock_.wait_until_s(*next_s_);
      next_s_.reset();
      happen(std::exchange(events.front(), {}));
      events.pop_front();
    }
  }

  [[nodiscard]] int control(int descriptor, std::uint64_t request, void* argument) override {
    Open& open = open_.at(descriptor);
    Node& node = nodes.at(open.path);
    if (!node.there) return failed(ENODEV);
    switch (request) {
      case VIDIOC_QUERYCAP:
        return capability(node, *static_cast<v4l2_capability*>(argument));
      case VIDIOC_ENUM_FMT:
        return list(node, *static_cast<v4l2_fmtdesc*>(argument));
      case VIDIOC_ENUM_FRAMESIZES:
        return list(node, *static_cast<v4l2_frmsizeenum*>(argument));
      case VIDIOC_ENUM_FRAMEINTERVALS:
        return list(node, *static_cast<v4l2_frmivalenum*>(argument));
      case VIDIOC_S_FMT:
        return set_format(node, open, static_cast<v4l2_format*>(argument)->fmt.pix);
      case VIDIOC_S_PARM:
        return failed(ENOTTY);  // as a driver with one rate
      case VIDIOC_REQBUFS:
        open.memory.assign(static_cast<v4l2_requestbuffers*>(argument)->count,
                           std::vector<std::uint8_t>(open.image_bytes));
        return 0;
      case VIDIOC_QUERYBUF:
        return describe(open, *static_cast<v4l2_buffer*>(argument));
      case VIDIOC_QBUF:
        open.free.push_back(static_cast<v4l2_buffer*>(argument)->index);
        return 0;
      case VIDIOC_DQBUF:
        return take(open, *static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
      case VIDIOC_STREAMOFF:
        open.streams = request == VIDIOC_STREAMON;
        return 0;
      default:
        return failed(ENOTTY);
    }
  }

 private:
  static constexpr std::uint32_t kOffset = 1U << 24U;  // between buffers, as drivers number them
  struct Open {
    std::string path;
    bool streams = false;
    std::uint32_t image_bytes = 0;
    std::vector<std::vector<std::uint8_t>> memory;
    std::deque<std::uint32_t> free;
    std::deque<v4l2_buffer> filled;
  };

  static int failed(int number) {
    errno = number;
    return -1;
  }

  int count_ready(std::span<pollfd> descriptors) {
    int ready = 0;
    for (pollfd& descriptor : descriptors) {
      const Open& open = open_.at(descriptor.fd);
      const bool there = nodes.at(open.path).there;
      descriptor.revents = 0;
      if (!there) descriptor.revents = POLLERR | POLLHUP;
      if (there && !open.filled.empty()) descriptor.revents = POLLIN;
      if (descriptor.revents != 0) ++ready;
    }
    return ready;
  }

  void happen(const Event& event) {
    Node& node = nodes.at(event.node);
    if (event.what != Event::What::kImage) node.there = event.what == Event::What::kPluggedIn;
    if (event.what != Event::What::kImage || !node.there) return;
    for (auto& [descriptor, open] : open_) {
      if (open.path != event.node || !open.streams || open.free.empty()) continue;
      v4l2_buffer buffer{};
      buffer.index = open.free.front();
      open.free.pop_front();
      std::vector<std::uint8_t>& memory = open.memory.at(buffer.index);
      std::copy_n(event.bytes.begin(), std::min(event.bytes.size(), memory.size()), memory.begin());
      buffer.bytesused = static_cast<std::uint32_t>(event.bytes.size());
      buffer.flags = event.flags;
      buffer.timestamp.tv_sec = static_cast<time_t>(event.stamp_s);
      buffer.timestamp.tv_usec = std::lround(1e6 * (event.stamp_s - std::floor(event.stamp_s)));
      open.filled.push_back(buffer);
    }
  }

  static int capability(const Node& node, v4l2_capability& told) {
    told.capabilities = node.can | V4L2_CAP_META_CAPTURE | V4L2_CAP_DEVICE_CAPS;
    told.device_caps = node.can;
    return 0;
  }
  static int list(const Node& node, v4l2_fmtdesc& told) {
    if (told.index >= node.formats.size()) return failed(EINVAL);
    told.pixelformat = node.formats[told.index].format;
    return 0;
  }
  static const Format* find(const Node& node, std::uint32_t format) {
    const auto found = std::ranges::find(node.formats, format, &Format::format);
    return found == node.formats.end() ? nullptr : &*found;
  }
  static int list(const Node& node, v4l2_frmsizeenum& told) {
    const Format* const format = find(node, told.pixel_format);
    if (format == nullptr || told.index >= format->sizes.size()) return failed(EINVAL);
    const cv::Size size = format->sizes[told.index];
    told.type = V4L2_FRMSIZE_TYPE_DISCRETE;
    told.discrete = {static_cast<std::uint32_t>(size.width),
                     static_cast<std::uint32_t>(size.height)};
    return 0;
  }
  static int list(const Node& node, v4l2_frmivalenum& told) {
    const Format* const format = find(node, told.pixel_format);
    if (format == nullptr || told.index >= format->rates_hz.size()) return failed(EINVAL);
    told.type = V4L2_FRMIVAL_TYPE_DISCRETE;
    told.discrete = {1, format->rates_hz[told.index]};
    return 0;
  }
  static int set_format(const Node& node, Open& open, v4l2_pix_format& pix) {
    pix.pixelformat = node.given_format.value_or(pix.pixelformat);
    if (node.given_size) {
      pix.width = static_cast<std::uint32_t>(node.given_size->width);
      pix.height = static_cast<std::uint32_t>(node.given_size->height);
    }
    const std::uint32_t pixel_bytes = pix.pixelformat == V4L2_PIX_FMT_RGB24  ? 3
                                      : pix.pixelformat == V4L2_PIX_FMT_GREY ? 1
                                                                             : 2;
    pix.bytesperline = pix.width * pixel_bytes + node.row_padding;
    pix.sizeimage = pix.bytesperline * pix.height;
    open.image_bytes = pix.sizeimage;
    return 0;
  }
  static int describe(const Open& open, v4l2_buffer& told) {
    if (told.index >= open.memory.size()) return failed(EINVAL);
    told.length = static_cast<std::uint32_t>(open.memory[told.index].size());
    told.m.offset = told.index * kOffset;
    return 0;
  }
  static int take(Open& open, v4l2_buffer& told) {
    if (open.filled.empty()) return failed(EAGAIN);
    told = open.filled.front();
    open.filled.pop_front();
    return 0;
  }

  Clock& clock_;
  std::map<int, Open> open_;
  int next_descriptor_ = 10;
  std::optional<double> next_s_;  // when the first event happens, by the clock
};

}  // namespace stillmap
