// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "tooling/pipeline/run_observer.hpp"
#include "tooling/view/view_server.hpp"

namespace stillmap {

/// Shows a run in the pages of a ViewServer. It hands over values that share their pixels with the
/// run's; all work on them is the server's.
class ViewObserver : public RunObserver {
 public:
  /// `server` outlives it.
  ViewObserver(ViewServer& server, const CameraModel& camera);

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_damaged(const DamagedFrame&) override { on_dropped(1); }
  void on_dropped(std::size_t frames) override;
  void on_end(const RunResult& result) override;

 private:
  [[nodiscard]] bool adds_to_map(const FrameResult& result) const;

  ViewServer& server_;
  CameraModel camera_;
  std::optional<Eigen::Isometry3d> T_world_camera_;  // of the last frame for the growing map
};

}  // namespace stillmap
