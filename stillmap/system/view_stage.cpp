// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/view_stage.hpp"

#include <vector>

#include "stillmap/session/session_map.hpp"
#include "stillmap/system/label_image.hpp"

namespace stillmap {

ViewStage::ViewStage(const CloudConfig& config,
                     const CameraModel& camera,
                     int lag_frames,
                     Worker* worker)
    : config_(config),
      camera_(camera),
      rays_(pixel_rays(camera)),
      lag_frames_(lag_frames),
      jobs_(worker) {}

void ViewStage::add(Session& session,
                    const FramePtr& frame,
                    const FrameDynamics& dynamics,
                    bool is_keyframe,
                    std::int64_t frame_number) {
  ++since_last_;
  const int gap = config_.view_gap_frames;
  if (!is_keyframe && (gap == 0 || since_last_ < gap)) return;
  since_last_ = 0;
  const auto index = static_cast<std::uint32_t>(session.frames.size() - 1);
  const DynamicMask mask = dynamics.judged.mask;
  const cv::Mat1b excluded = dynamics.excluded;
  const cv::Mat1b labels = label_image(frame->depth, dynamics);
  jobs_.submit(frame_number + lag_frames_, [frame, mask, excluded, labels, index, this] {
    const NotStatic masks = not_static(mask, excluded);
    return ViewRecord{
        index,
        std::make_shared<const StaticView>(static_view(*frame, rays_, config_, masks, labels))};
  });
}

void ViewStage::collect_due(Session& session, std::int64_t frame_number) {
  for (ViewRecord& made : jobs_.collect_due(frame_number)) {
    if (is_news(session, made)) session.views.push_back(std::move(made));
  }
}

bool ViewStage::is_news(const Session& session, const ViewRecord& made) const {
  if (config_.views.enough == 0) return true;
  const auto posed = [&](const ViewRecord& record) {
    return PosedView{T_world_frame(session, session.frames[record.frame]), record.view.get()};
  };
  const WorldId world = world_of(session, session.frames[made.frame]);
  std::vector<PosedView> held;
  for (const ViewRecord& record : session.views) {
    if (world_of(session, session.frames[record.frame]) == world) held.push_back(posed(record));
  }
  const ViewNews news = news_of(posed(made), held, camera_, config_.views, config_.free);
  return joins(news, config_.views);
}

}  // namespace stillmap
