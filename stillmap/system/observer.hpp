// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "stillmap/core/point_cloud.hpp"
#include "stillmap/core/rgbd_frame.hpp"
#include "stillmap/system/results.hpp"

namespace stillmap {

/// Observes a System: as a log, a progress bar, a viewer, a node of another framework.
///
/// Every call is made on the thread that calls the System, with const values that the observer may
/// copy. An observer must not call the System that it observes. Exceptions reach the System's
/// caller.
class Observer {
 public:
  Observer() = default;
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  virtual ~Observer() = default;

  /// A frame was processed.
  virtual void on_frame(const RgbdFrame& /*frame*/, const FrameResult& /*result*/) {}
  /// The frame of the preceding on_frame() has become a key frame.
  virtual void on_keyframe(const FrameResult& /*result*/) {}
  /// The dense map so far: every SystemOptions::snapshot_every_frames frames, and at the end.
  /// `frames` counts those processed.
  virtual void on_map(const PointCloud& /*map*/, std::int64_t /*frames*/) {}
  /// The run has ended.
  virtual void on_end(const RunResult& /*result*/) {}
};

}  // namespace stillmap
