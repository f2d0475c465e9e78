// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "tooling/browser/message.hpp"
#include "tooling/browser/point_chunks.hpp"
#include "tooling/browser/scene_message.hpp"
#include "tooling/browser/viewed_frame.hpp"
#include "tooling/view/frame_sample.hpp"
#include "tooling/view/inbox.hpp"

namespace stillmap {

/// What a page already has.
struct PageProgress {
  bool started = false;
  std::uint64_t frames_version = 0, map_version = 0, state_version = 0;
  std::size_t next_frame = 0;            ///< counted from the run's first
  std::vector<std::size_t> points;       ///< of each chunk
  std::optional<std::uint32_t> picture;  ///< the number of its frame
};

/// All that pages show, and the messages that bring a page to it. Used by one thread.
///
/// A page gets what it lacks, never a list of what has happened: one that asks seldom gets more at
/// a time, and only the newest picture.
class ViewState {
 public:
  explicit ViewState(ViewStart start);

  void apply(ViewInbox::Contents news);

  /// The next message to a page, which then has `progress`; empty if it lacks nothing. A message
  /// has at most kMessageFrames records and about kMessagePoints points; `"more"` says that there
  /// is another.
  [[nodiscard]] std::string next_message(PageProgress& progress);

  static constexpr std::size_t kMessageFrames = 500;
  static constexpr std::size_t kMessagePoints = 100'000;
  static constexpr std::size_t kHistoryFrames = 100'000;  ///< older records go

 private:
  void add_frame(ViewedFrame frame);
  void grow(const ViewedSample& sample);
  void find_layout(const PointCloud& map, const Trajectory& cameras);
  void finish(ViewedEnd end);
  bool add_frames(Message& message, PageProgress& progress) const;
  bool add_map(Message& message, PageProgress& progress) const;
  void add_picture(Message& message, PageProgress& progress) const;
  void add_state(Message& message, PageProgress& progress) const;

  ViewStart start_;
  std::optional<ViewedEnd> end_;  // until a page asks for it, which may never be
  std::deque<ViewedFrame> frames_;
  std::size_t first_frame_ = 0;       // the place of frames_[0] among the run's frames
  std::uint64_t frames_version_ = 1;  // grows when records that pages have were changed

  PointChunks map_;
  std::uint64_t map_version_ = 1;  // grows when it is another map
  std::optional<GrowingMap> growing_;

  std::optional<PixelGrid> ghost_grid_;
  std::optional<ViewedSample> newest_;

  std::uint64_t state_version_ = 1;
  SceneState state_;
};

}  // namespace stillmap
