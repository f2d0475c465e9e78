// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "stillmap/system/observer.hpp"

namespace stillmap {

/// Says why no frame of a run could be tracked, where the images tell it, and warns of stamps that
/// cannot be seconds.
class FrameWatch : public Observer {
 public:
  using Warn = std::function<void(const std::string& warning)>;

  /// Depth beyond `max_depth_m` is not used. `warn` gets each warning, once, in one line.
  FrameWatch(double max_depth_m, Warn warn) : max_depth_m_(max_depth_m), warn_(std::move(warn)) {}

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_end(const RunResult& result) override;

 private:
  void warn_of_untracked() const;

  double max_depth_m_;
  Warn warn_;
  std::size_t frames_ = 0;
  double first_stamp_s_ = 0, last_stamp_s_ = 0;
  bool any_pose_ = false;
  // Of the frames until the first with a pose:
  std::size_t without_depth_ = 0, too_far_ = 0, without_corners_ = 0;
};

}  // namespace stillmap
