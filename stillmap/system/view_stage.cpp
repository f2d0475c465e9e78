// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/view_stage.hpp"

#include <vector>

#include "stillmap/dense/label_image.hpp"
#include "stillmap/session/session_map.hpp"

namespace stillmap {

namespace {

// Nobody asks for a view before the end: only that frames do not pile up must not be waited for
// long.
constexpr std::int64_t kLagFrames = 30;

}  // namespace

ViewStage::ViewStage(const CloudConfig& config,
                     const CameraModel& camera,
                     const StageOptions& options)
    : config_(config),
      camera_(camera),
      rays_(pixel_rays(camera)),
      worker_(options.threaded ? std::make_unique<Worker>(Worker::Priority::kLow) : nullptr),
      jobs_(worker_.get(), [probe = options.probe] { begin_work(probe, Stage::kViews); }) {}

void ViewStage::add(const Candidate& candidate, std::int64_t frame_number) {
  const auto record = static_cast<std::int64_t>(candidate.record);
  if (!last_) last_ = record - 1;
  if (!candidate.is_keyframe && !is_due(record)) return;
  last_ = record;
  const auto index = static_cast<std::uint32_t>(candidate.record);
  const FramePtr frame = candidate.frame;
  const FrameDynamics& dynamics = candidate.dynamics;
  const DynamicMask mask = dynamics.judged.mask;
  const cv::Mat1b excluded = dynamics.excluded;
  const cv::Mat1b labels = label_image(frame->depth, dynamics);
  jobs_.submit(frame_number + kLagFrames, [frame, mask, excluded, labels, index, this] {
    const DynamicRegions masks = dynamic_regions(mask, excluded);
    return ViewRecord{
        index,
        std::make_shared<const StaticView>(static_view(*frame, rays_, config_, masks, labels))};
  });
}

bool ViewStage::is_due(std::int64_t record) const {
  return config_.view_gap_frames > 0 && record - *last_ >= config_.view_gap_frames;
}

void ViewStage::collect_due(Session& session, std::int64_t frame_number) {
  for (ViewRecord& made : jobs_.collect_due(frame_number)) {
    if (is_worth_keeping(session, made)) session.views.push_back(std::move(made));
  }
}

bool ViewStage::is_worth_keeping(const Session& session, const ViewRecord& made) const {
  if (config_.views.enough == 0) return true;
  const auto posed = [&](const ViewRecord& record) {
    return PosedView{T_world_frame(session, session.frames[record.frame]), record.view.get()};
  };
  const SubmapId world = submap_of(session, session.frames[made.frame]);
  std::vector<PosedView> held;
  for (const ViewRecord& record : session.views) {
    if (submap_of(session, session.frames[record.frame]) == world) held.push_back(posed(record));
  }
  const ViewGain news = gain_of(posed(made), held, camera_, config_.views, config_.free);
  return stillmap::is_worth_keeping(news, config_.views);
}

}  // namespace stillmap
