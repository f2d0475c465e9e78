// SPDX-License-Identifier: Apache-2.0
#include "tests/relocation_trial.hpp"

#include <algorithm>
#include <numbers>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/se3.hpp"
#include "tooling/eval/map_alignment.hpp"

namespace stillmap {

RelocationTrial::RelocationTrial(const SystemConfig& config, const CameraModel& camera)
    : camera_(camera),
      system_(std::make_unique<System>(config, camera, SystemOptions{.threads = 1})),
      objects_(config.dynamics.object_tracking(), FillRule::kBothWays) {}

void RelocationTrial::show(const TrialView& view) {
  push(*view.frame, view.detections, view.T_truth_camera);
}

void RelocationTrial::cover(int frames) {
  RgbdFrame dark;
  dark.color = ColorImage(cv::Mat3b(camera_.height_px, camera_.width_px, cv::Vec3b(0, 0, 0)));
  dark.gray = GrayImage(cv::Mat1b(camera_.height_px, camera_.width_px, std::uint8_t{0}));
  dark.depth = DepthImage(cv::Mat1f(camera_.height_px, camera_.width_px, 0.0F));
  for (int i = 0; i < frames; ++i) push(dark, {}, std::nullopt);
}

void RelocationTrial::push(const RgbdFrame& picture,
                           FrameDetections detections,
                           const std::optional<Eigen::Isometry3d>& T_truth_camera) {
  RgbdFrame frame = picture;
  frame.id = FrameId(static_cast<std::uint32_t>(shown_.size()));
  frame.stamp.seconds = 1000.0 + static_cast<double>(shown_.size()) / 30.0;
  frame.stamp.text = fmt::format("{:.6f}", frame.stamp.seconds);
  frame.depth_stamp_s = frame.stamp.seconds;
  detections.stamp = frame.stamp;
  TrialFrame result;
  result.stamp = frame.stamp;
  result.T_truth_camera = T_truth_camera;
  frames_.push_back(result);
  shown_.push_back(std::make_shared<const RgbdFrame>(std::move(frame)));
  const RgbdFrame& shown = *shown_.back();
  if (auto ready = objects_.push({shown.id, std::move(detections), shown.depth})) {
    process(std::move(*ready));
  }
}

void RelocationTrial::process(FrameObjects objects) {
  STILLMAP_CHECK(shown_[processed_]->id == objects.frame);
  const FrameResult result = system_->process(shown_[processed_], std::move(objects));
  shown_[processed_].reset();  // its images take much room
  TrialFrame& frame = frames_[processed_++];
  frame.status = result.status;
  frame.inliers = result.tracked_features;
  frame.T_world_camera = result.T_world_camera;
}

std::vector<TrialFrame> RelocationTrial::finish() {
  for (FrameObjects& objects : objects_.flush()) process(std::move(objects));
  return std::move(frames_);
}

TrialOutcome judge_trial(const std::vector<TrialFrame>& frames) {
  const auto dark = [](const TrialFrame& frame) { return !frame.T_truth_camera; };
  const auto covered = std::ranges::find_if(frames, dark);
  const auto uncovered = std::find_if_not(covered, frames.end(), dark);
  const auto posed = [](const TrialFrame& frame) { return frame.status != TrackingStatus::kLost; };
  Trajectory truth, estimate;
  for (auto frame = frames.begin(); frame != covered; ++frame) {
    truth.push_back({frame->stamp, *frame->T_truth_camera});
    if (posed(*frame)) estimate.push_back({frame->stamp, frame->T_world_camera});
  }
  const std::optional<Eigen::Isometry3d> T_truth_world = map_alignment(truth, estimate);
  if (!T_truth_world) throw Error("a trial with fewer than three tracked frames before it");
  TrialOutcome outcome;
  outcome.invented = static_cast<int>(std::count_if(covered, uncovered, posed));
  outcome.shown = static_cast<int>(frames.end() - uncovered);
  for (auto frame = uncovered; frame != frames.end(); ++frame) {
    if (!posed(*frame)) continue;
    ++outcome.tracked;
    const Eigen::Isometry3d error =
        frame->T_truth_camera->inverse() * *T_truth_world * frame->T_world_camera;
    const double error_m = error.translation().norm();
    const double error_deg = rotation_angle(error.linear()) * 180.0 / std::numbers::pi;
    if (outcome.found_at == 0) {
      outcome.found_at = static_cast<int>(frame - uncovered) + 1;
      outcome.error_m = error_m;
      outcome.error_deg = error_deg;
    }
    outcome.largest_error_m = std::max(outcome.largest_error_m, error_m);
    outcome.largest_error_deg = std::max(outcome.largest_error_deg, error_deg);
  }
  return outcome;
}

}  // namespace stillmap
