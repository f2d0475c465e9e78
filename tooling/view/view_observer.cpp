// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/view_observer.hpp"

namespace stillmap {

ViewObserver::ViewObserver(ViewServer& server, const CameraModel& camera)
    : server_(server), camera_(camera) {}

// In a live run key frames are made of earlier frames, whose images are gone by then, so that the
// camera's motion decides what the growing map is made of.
bool ViewObserver::adds_to_map(const FrameResult& result) const {
  constexpr double kMoved_m = 0.1, kTurned_rad = 0.15;
  if (!has_pose(result)) return false;
  if (!T_world_camera_) return true;
  const Eigen::Isometry3d T = T_world_camera_->inverse() * result.T_world_camera;
  return T.translation().norm() > kMoved_m || Eigen::AngleAxisd(T.linear()).angle() > kTurned_rad;
}

void ViewObserver::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  ViewInbox& inbox = server_.inbox();
  const ViewedSample sample(frame, result);
  bool wake = inbox.put_frame(viewed_frame(result, camera_), sample);
  if (adds_to_map(result)) {
    T_world_camera_ = result.T_world_camera;
    wake = inbox.put_for_map(sample) || wake;
  }
  if (wake) server_.wake();
}

void ViewObserver::on_dropped(std::size_t frames) {
  if (server_.inbox().put_dropped(frames)) server_.wake();
}

void ViewObserver::on_end(const RunResult& result) {
  const bool wake = server_.inbox().put_end(
      {result.map, result.trajectory, result.keyframes, result.united_tracks});
  if (wake) server_.wake();
}

}  // namespace stillmap
