// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/dense_stage.hpp"

#include <vector>

#include "stillmap/core/depth_stamp.hpp"
#include "stillmap/dense/label_image.hpp"
#include "stillmap/session/session_map.hpp"

namespace stillmap {

namespace {

// Views are needed only at the end of a run. The lag is limited so that pending frames do not pile
// up.
constexpr std::int64_t kLagFrames = 30;

}  // namespace

DenseStage::DenseStage(const CloudConfig& config,
                       const CameraModel& camera,
                       const StageOptions& options)
    : config_(config),
      camera_(camera),
      rays_(pixel_rays(camera)),
      missed_(config.missed),
      jobs_(options.worker, [probe = options.probe] { begin_work(probe, Stage::kViews); }) {}

DenseStage DenseStage::inline_copy() const {
  DenseStage copy = *this;
  copy.jobs_ = jobs_.inline_copy();
  return copy;
}

void DenseStage::add(const Candidate& candidate, std::int64_t frame_number) {
  const auto record = static_cast<std::int64_t>(candidate.record);
  if (!last_) last_ = record - 1;
  if (!candidate.is_keyframe && !is_due(record)) return;
  last_ = record;
  const auto index = static_cast<std::uint32_t>(candidate.record);
  const FramePtr frame = candidate.frame;
  const FrameDynamics& dynamics = candidate.dynamics;
  const DynamicMask mask = dynamics.judged.mask;
  const Mask excluded = dynamics.excluded;
  const LabelImage labels = label_image(frame->depth, dynamics);
  jobs_.submit(frame_number + kLagFrames, [frame, mask, excluded, labels, index, this] {
    const DynamicRegions masks = dynamic_regions(mask, excluded);
    return ViewRecord{
        index,
        std::make_shared<const StaticView>(static_view(*frame, rays_, config_, masks, labels)),
        depth_stamp_after_color_s(*frame)};
  });
}

bool DenseStage::is_due(std::int64_t record) const {
  return config_.view_gap_frames > 0 && record - *last_ >= config_.view_gap_frames;
}

void DenseStage::leave_out_missed(ViewRecord& made,
                                  const Session& session,
                                  const Eigen::Isometry3d& T_odometry_world) {
  if (config_.missed_people != "on") return;
  const FrameRecord frame = session.frames[made.frame];
  const Eigen::Isometry3d T_camera_odometry =
      (T_odometry_world * T_world_frame(session, frame)).inverse();
  std::vector<Eigen::Vector3d> places =
      standing_.unseen_in(*made.view, camera_, T_camera_odometry, frame.stamp.seconds);
  const std::vector<Eigen::Vector3d> moving = missed_.places_at(frame.stamp.seconds);
  places.insert(places.end(), moving.begin(), moving.end());
  if (places.empty()) return;
  for (Eigen::Vector3d& p : places) p = T_camera_odometry * p;
  made.view = std::make_shared<const StaticView>(
      without_places(*made.view, places, config_.missed.reach_m));
}

void DenseStage::collect_due(Session& session,
                             const Eigen::Isometry3d& T_odometry_world,
                             std::int64_t frame_number) {
  for (ViewRecord& made : jobs_.collect_due(frame_number)) {
    leave_out_missed(made, session, T_odometry_world);
    keep_if_worth(session, std::move(made));
  }
}

void DenseStage::keep_if_worth(Session& session, ViewRecord made) const {
  if (config_.views.enough > 0) {
    const FrameRecord frame = session.frames[made.frame];
    const PosedView view{T_world_frame(session, frame), made.view.get()};
    const std::vector<PosedView> held = posed_views(session, submap_of(session, frame));
    const ViewGain gain = gain_of(view, held, camera_, config_.views, config_.free);
    if (!is_worth_keeping(gain, config_.views)) return;
    if (gain.replaces != nullptr) {
      std::erase_if(session.views,
                    [&](const ViewRecord& v) { return v.view.get() == gain.replaces; });
    }
  }
  session.views.push_back(std::move(made));
  keep_within_budget(session);
}

// Views go from the submap of the newest; from others when it has no more.
void DenseStage::keep_within_budget(Session& session) const {
  if (config_.views.most_mb == 0) return;
  std::vector<ViewRecord>& views = session.views;
  std::size_t bytes = 0;
  for (const ViewRecord& record : views) bytes += record.view->bytes();
  while (static_cast<double>(bytes) > config_.views.most_mb * 1e6 && views.size() > 1) {
    std::vector<PosedView> held =
        posed_views(session, submap_of(session, session.frames[views.back().frame]));
    const PosedView newest = held.back();
    held.pop_back();
    const StaticView* gone = held.empty()
                                 ? views.front().view.get()
                                 : least_needed(held, newest, camera_, config_.views, config_.free);
    bytes -= gone->bytes();
    std::erase_if(views, [gone](const ViewRecord& record) { return record.view.get() == gone; });
  }
}

}  // namespace stillmap
