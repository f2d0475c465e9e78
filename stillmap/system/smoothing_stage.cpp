// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/smoothing_stage.hpp"

#include <limits>
#include <map>
#include <utility>

#include "stillmap/session/session_map.hpp"
#include "stillmap/slam/tracking/trajectory_smoother.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kPart = 1000;          // frames that are smoothed together
constexpr std::int64_t kPartLagFrames = 30;  // its work is far shorter

/// Consecutive frames of one submap, their records, and the poses that these have.
struct Stretch {
  std::vector<std::size_t> records;
  std::vector<Eigen::Isometry3d> T_world_recorded;
  std::vector<MeasuredPose> measured;
};

bool is_identity(const Eigen::Isometry3d& T) {
  return T.matrix() == Eigen::Isometry3d::Identity().matrix();
}

/// The first `count` frames from a record on, by submap.
std::vector<Stretch> stretches(const Session& session,
                               std::size_t first_record,
                               const std::deque<PoseEvidence>& measured,
                               const CameraTimes& times,
                               std::size_t count) {
  std::map<SubmapId, Stretch> by_submap;
  for (std::size_t i = 0; i < count; ++i) {
    const FrameRecord frame = session.frames[first_record + i];
    const Eigen::Isometry3d T_recorded = T_world_frame(session, frame);
    const bool defines_axes = is_identity(T_recorded);
    Eigen::Isometry3d T = T_recorded;
    // The map has corrected the key frames.
    if (!is_identity(frame.T_reference_frame)) {
      T = perturb_left(T.inverse(), measured[i].time_correction.step(times)).inverse();
    }
    Stretch& stretch = by_submap[submap_of(session, frame)];
    stretch.records.push_back(first_record + i);
    stretch.T_world_recorded.push_back(T_recorded);
    stretch.measured.push_back({frame.stamp.seconds, T, measured[i].information, defines_axes});
  }
  std::vector<Stretch> all;
  for (auto& [submap, stretch] : by_submap) all.push_back(std::move(stretch));
  return all;
}

}  // namespace

SmoothingStage::SmoothingStage(bool smooths, const StageOptions& options, std::size_t most)
    : smooths_(smooths),
      most_(most),
      jobs_(options.worker, [probe = options.probe] { begin_work(probe, Stage::kAdjustment); }) {}

SmoothingStage SmoothingStage::inline_copy() const {
  SmoothingStage copy = *this;
  copy.jobs_ = jobs_.inline_copy();
  return copy;
}

void SmoothingStage::add(const PoseEvidence& frame) {
  if (smooths_) waiting_.push_back(frame);
}

void SmoothingStage::take_over(Session& session, std::int64_t frame_number) {
  for (const Corrections& corrections : jobs_.collect_due(frame_number)) {
    for (const auto& [record, T_before_after] : corrections) {
      FrameRecord frame = session.frames[record];
      frame.T_reference_frame = frame.T_reference_frame * T_before_after;
      session.frames.set(record, std::move(frame));
    }
  }
}

void SmoothingStage::process(Session& session,
                             const CameraTimes& times,
                             std::int64_t frame_number) {
  take_over(session, frame_number);
  if (waiting_.size() < most_ + kPart) return;
  jobs_.submit(frame_number + kPartLagFrames,
               [parts = stretches(session, first_record_, waiting_, times, kPart)] {
                 Corrections corrections;
                 for (const Stretch& part : parts) {
                   const std::vector<Eigen::Isometry3d> poses = smooth_trajectory(part.measured);
                   for (std::size_t i = 0; i < poses.size(); ++i) {
                     const Eigen::Isometry3d& T_world_before = part.T_world_recorded[i];
                     corrections.push_back({part.records[i], T_world_before.inverse() * poses[i]});
                   }
                 }
                 return corrections;
               });
  first_record_ += kPart;
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(kPart));
}

void SmoothingStage::finish(Session& session, const CameraTimes& times) {
  take_over(session, std::numeric_limits<std::int64_t>::max());
  for (const Stretch& part : stretches(session, first_record_, waiting_, times, waiting_.size())) {
    const std::vector<Eigen::Isometry3d> poses = smooth_trajectory(part.measured);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      FrameRecord frame = session.frames[part.records[i]];
      frame.T_reference_frame = session.map.T_world_keyframe(frame.reference).inverse() * poses[i];
      session.frames.set(part.records[i], std::move(frame));
    }
  }
  first_record_ += waiting_.size();
  waiting_.clear();
}

}  // namespace stillmap
