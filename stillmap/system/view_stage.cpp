// SPDX-License-Identifier: Apache-2.0
#include "stillmap/system/view_stage.hpp"

#include "stillmap/system/label_image.hpp"

namespace stillmap {

namespace {

// Nobody asks for a view before the end: only that frames do not pile up must not be waited for
// long.
constexpr std::int64_t kLagFrames = 30;

}  // namespace

ViewStage::ViewStage(const CloudConfig& config, const CameraModel& camera, bool threaded)
    : config_(config),
      rays_(pixel_rays(camera)),
      worker_(threaded ? std::make_unique<Worker>() : nullptr),
      jobs_(worker_.get()) {}

void ViewStage::add(Session& session, const Candidate& candidate, std::int64_t frame_number) {
  const auto record = static_cast<std::int64_t>(candidate.record);
  if (!last_) last_ = record - 1;
  if (!candidate.is_keyframe && !is_due(record)) return;
  last_ = record;
  const std::size_t index = session.views.size();
  session.views.push_back({static_cast<std::uint32_t>(candidate.record), nullptr});
  const FramePtr frame = candidate.frame;
  const FrameDynamics& dynamics = candidate.dynamics;
  const DynamicMask mask = dynamics.judged.mask;
  const cv::Mat1b excluded = dynamics.excluded;
  const cv::Mat1b labels = label_image(frame->depth, dynamics);
  jobs_.submit(frame_number + kLagFrames, [frame, mask, excluded, labels, index, this] {
    const NotStatic masks = not_static(mask, excluded);
    return FinishedView(
        index,
        std::make_shared<const StaticView>(static_view(*frame, rays_, config_, masks, labels)));
  });
}

bool ViewStage::is_due(std::int64_t record) const {
  return config_.view_gap_frames > 0 && record - *last_ >= config_.view_gap_frames;
}

void ViewStage::collect_due(Session& session, std::int64_t frame_number) {
  for (auto& [i, view] : jobs_.collect_due(frame_number)) session.views[i].view = std::move(view);
}

}  // namespace stillmap
