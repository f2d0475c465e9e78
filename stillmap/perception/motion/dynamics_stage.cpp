// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/dynamics_stage.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

DynamicsMode mode_of(const DynamicsConfig& config) {
  return config.mode == "mask"    ? DynamicsMode::kMask
         : config.mode == "paper" ? DynamicsMode::kPaper
                                  : DynamicsMode::kFull;
}

/// Where there is something dynamic.
std::vector<PixelBox> dynamic_boxes(const std::vector<ObjectState>& states) {
  std::vector<PixelBox> boxes;
  for (const ObjectState& state : states) {
    if (state.dynamic) boxes.push_back(state.box);
  }
  return boxes;
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

ObjectTrackerConfig DynamicsConfig::object_tracking() const {
  ObjectTrackerConfig tracking = tracker;
  if (mode == "paper") tracking.min_sightings = 1;
  if (!fill_boxes) tracking.search_frames = 0;
  return tracking;
}

DynamicsStage::DynamicsStage(const DynamicsConfig& config,
                             const CameraModel& camera,
                             std::uint32_t seed)
    : config_(config), motions_(config.motion, camera) {
  if (config.mode == "off") return;
  objects_.emplace(config.objects, camera, mode_of(config));
  filter_.emplace(config.features, camera, mode_of(config), seed);
}

// The newest frame that is at least so old.
const DynamicsStage::PastFrame* DynamicsStage::past_frame(std::int64_t frames_ago) const {
  for (auto frame = past_.rbegin(); frame != past_.rend(); ++frame) {
    if (number_ - frame->number >= frames_ago) return &*frame;
  }
  return nullptr;
}

const DynamicsStage::PastFrame* DynamicsStage::first_since_lost() const {
  const auto frame = std::ranges::find_if(
      past_, [&](const PastFrame& past) { return past.number >= found_again_; });
  return frame != past_.end() ? &*frame : nullptr;
}

std::vector<PreviousDepth> DynamicsStage::previous(
    const std::optional<Eigen::Isometry3d>& T_world_camera) const {
  std::vector<PreviousDepth> frames;
  if (config_.mode == "paper" && last_) frames.push_back({last_->depth});
  if (config_.mode != "full" || !T_world_camera || past_.empty()) return frames;
  const auto add = [&](const PastFrame& past) {
    frames.push_back(
        {past.view.depth, T_world_camera->inverse() * past.view.T_world_camera, past.dynamic});
  };
  for (const int age : {1, 2, 4}) {
    const PastFrame* past = past_frame(std::int64_t{age} * config_.compare_frames);
    if (past != nullptr) add(*past);
  }
  if (number_ - found_again_ < config_.compare_frames) {
    const PastFrame* first = first_since_lost();
    if (first != nullptr) add(*first);
  }
  return frames;
}

MeasuredObjects DynamicsStage::measure(const RgbdFrame& frame, const FrameObjects& objects) const {
  STILLMAP_CHECK(enabled());
  return objects_->measure(frame.depth, objects);
}

FrameDynamics DynamicsStage::judge(
    const RgbdFrame& frame,
    FrameObjects objects,
    const MeasuredObjects& measured,
    const std::optional<Eigen::Isometry3d>& T_world_camera_expected) const {
  STILLMAP_CHECK(enabled());
  FrameDynamics dynamics;
  dynamics.judged = objects_->judge(
      frame.depth, objects, measured, previous(T_world_camera_expected), motions_.moving());
  dynamics.objects = std::move(objects);
  dynamics.excluded = widened(covered(dynamics.judged.mask), config_.feature_margin_px);
  return dynamics;
}

FilteredFeatures DynamicsStage::filter(
    const RgbdFrame& frame,
    Features features,
    const FrameDynamics& dynamics,
    const std::optional<Eigen::Isometry3d>& T_world_camera_expected) {
  STILLMAP_CHECK(enabled());
  const FeaturesPtr current = std::make_shared<const Features>(std::move(features));
  FeatureScene scene{*current,
                     frame.depth,
                     dynamic_boxes(dynamics.judged.states),
                     std::exchange(features_, current),
                     std::nullopt,
                     frame.id};
  if (T_world_camera_expected && last_) {
    scene.T_current_previous = T_world_camera_expected->inverse() * last_->T_world_camera;
  }
  return filter_->filter(scene);
}

void DynamicsStage::remember(const RgbdFrame& frame,
                             const Eigen::Isometry3d& T_world_camera,
                             FrameDynamics& dynamics) {
  learn_motions(frame, T_world_camera, dynamics);
  last_ = {frame.depth, T_world_camera};
  // A third of the age's precision is enough, and a third of the memory.
  const int step = std::max(1, config_.compare_frames / 3);
  if ((number_ - found_again_) % step == 0) {
    past_.push_back({*last_, covered(dynamics.judged.mask), number_});
  }
  ++number_;
  const std::int64_t oldest = number_ - std::int64_t{4} * config_.compare_frames - step;
  while (!past_.empty() && past_.front().number < oldest) past_.pop_front();
}

}  // namespace stillmap
