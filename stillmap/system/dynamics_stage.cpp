// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/dynamics_stage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

std::optional<DynamicObjects> make_objects(const DynamicsConfig& config,
                                           const CameraModel& camera) {
  if (config.mode == "off") return std::nullopt;
  const DynamicsMode mode = config.mode == "mask"    ? DynamicsMode::kMask
                            : config.mode == "paper" ? DynamicsMode::kPaper
                                                     : DynamicsMode::kFull;
  return DynamicObjects(config.objects, camera, mode);
}

cv::Mat1b covered(const DynamicMask& mask) {
  cv::Mat1b all;
  cv::bitwise_or(mask.extended, mask.jumps, all);
  return all;
}

cv::Mat1b widened(const cv::Mat1b& mask, double margin_px) {
  const int side = 2 * static_cast<int>(std::lround(margin_px)) + 1;
  if (side <= 1) return mask;
  cv::Mat1b wide;
  cv::dilate(mask, wide, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(side, side)));
  return wide;
}

}  // namespace

DynamicsStage::DynamicsStage(const DynamicsConfig& config, const CameraModel& camera)
    : config_(config), objects_(make_objects(config, camera)), motions_(config.motion, camera) {}

// The newest frame that is at least so old.
const DynamicsStage::PastFrame* DynamicsStage::past_frame(std::int64_t frames_ago) const {
  for (auto frame = past_.rbegin(); frame != past_.rend(); ++frame) {
    if (number_ - frame->number >= frames_ago) return &*frame;
  }
  return nullptr;
}

std::vector<PreviousDepth> DynamicsStage::previous(
    const std::optional<Eigen::Isometry3d>& T_world_camera) const {
  std::vector<PreviousDepth> frames;
  if (config_.mode == "paper" && last_) frames.push_back({last_->depth});
  if (config_.mode != "full" || !T_world_camera || past_.empty()) return frames;
  const auto add = [&](const PastFrame& past) {
    frames.push_back({past.depth, T_world_camera->inverse() * past.T_world_camera, past.dynamic});
  };
  for (const int age : {1, 2, 4}) {
    const PastFrame* past = past_frame(std::int64_t{age} * config_.compare_frames);
    if (past != nullptr) add(*past);
  }
  if (frames.empty()) add(past_.front());
  return frames;
}

FrameDynamics DynamicsStage::judge(
    const RgbdFrame& frame,
    FrameObjects objects,
    const std::optional<Eigen::Isometry3d>& T_world_camera_expected) const {
  STILLMAP_CHECK(enabled());
  FrameDynamics dynamics;
  dynamics.judged =
      objects_->judge(frame.depth, objects, previous(T_world_camera_expected), motions_.moving());
  dynamics.objects = std::move(objects);
  dynamics.excluded = widened(covered(dynamics.judged.mask), config_.feature_margin_px);
  return dynamics;
}

void DynamicsStage::remember(const RgbdFrame& frame,
                             const Eigen::Isometry3d& T_world_camera,
                             FrameDynamics& dynamics) {
  dynamics.motions =
      motions_.update(dynamics.objects, frame.depth, dynamics.judged.states, T_world_camera);
  last_ = PastFrame{frame.depth, covered(dynamics.judged.mask), T_world_camera, number_++};
  // A third of the age's precision is enough, and a third of the memory.
  const int step = std::max(1, config_.compare_frames / 3);
  if (last_->number % step == 0) past_.push_back(*last_);
  const std::int64_t oldest = number_ - std::int64_t{4} * config_.compare_frames - step;
  while (!past_.empty() && past_.front().number < oldest) past_.pop_front();
}

}  // namespace stillmap
