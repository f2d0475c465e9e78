// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/frame_watch.hpp"

#include <fmt/core.h>
#include <opencv2/core.hpp>

#include "stillmap/sensor/stamp_interval.hpp"

namespace stillmap {
namespace {

// Fewer pixels with depth than this share of an image are as good as none.
constexpr double kLeastShare = 0.01;
constexpr std::size_t kLeastCorners = 50;

}  // namespace

void FrameWatch::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  last_stamp_s_ = frame.stamp.seconds;
  if (frames_++ == 0) first_stamp_s_ = frame.stamp.seconds;
  any_pose_ = any_pose_ || has_pose(result);
  if (any_pose_) return;
  const cv::Mat1f& depth = frame.depth.mat;
  const double least = kLeastShare * static_cast<double>(depth.total());
  std::size_t measured = 0, usable = 0;
  for (const float metres : depth) {
    measured += metres > 0 ? 1U : 0U;
    usable += metres > 0 && static_cast<double>(metres) <= max_depth_m_ ? 1U : 0U;
  }
  if (static_cast<double>(measured) < least) {
    ++without_depth_;
  } else if (static_cast<double>(usable) < least) {
    ++too_far_;
  } else if (result.features.size() < kLeastCorners) {
    ++without_corners_;
  }
}

void FrameWatch::warn_of_untracked() const {
  const std::string of_all = fmt::format("of the {} frames", frames_);
  if (2 * without_depth_ > frames_) {
    warn_(
        fmt::format("no frame could be tracked: the depth images of {} {} measure nothing (0 in "
                    "nearly all pixels)",
                    without_depth_,
                    of_all));
  } else if (2 * too_far_ > frames_) {
    warn_(
        fmt::format("no frame could be tracked: the depth of {} {} is beyond {} m nearly "
                    "everywhere; is the camera's depth_factor right?",
                    too_far_,
                    of_all,
                    max_depth_m_));
  } else if (2 * without_corners_ > frames_) {
    warn_(
        fmt::format("no frame could be tracked: {} {} have hardly any corners; are the images "
                    "dark, blurred or covered?",
                    without_corners_,
                    of_all));
  }
}

void FrameWatch::on_end(const RunResult& /*result*/) {
  if (frames_ > 0 && !any_pose_) warn_of_untracked();
  const double intervals = static_cast<double>(frames_) - 1;
  const double interval_s = intervals > 0 ? (last_stamp_s_ - first_stamp_s_) / intervals : 0;
  if (is_absurd_interval(interval_s)) {
    warn_(
        fmt::format("the frames are {:.3g} s apart on average: are the stamps in another unit "
                    "than seconds? Figures and settings with times are of no use then",
                    interval_s));
  }
}

}  // namespace stillmap
