// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/sensor/frame_stream.hpp"
#include "stillmap/system/observer.hpp"

namespace stillmap {

/// An observer that is also told of the events of a run outside of the System. All calls come on
/// the thread of the run; warnings and times may come after on_end().
class RunObserver : public Observer {
 public:
  /// A frame could not be read and was left out.
  virtual void on_damaged(const DamagedFrame& /*frame*/) {}
  /// Frames of a live run were dropped while others were being processed.
  virtual void on_dropped(std::size_t /*frames*/) {}
  /// A warning to the readers of the results, in one line.
  virtual void on_warning(const std::string& /*warning*/) {}
  /// A stage outside the System has done a piece of work: reading, the network, the end of the run.
  virtual void on_stage_time(std::string_view /*stage*/, double /*ms*/) {}
};

/// Passes every call on to several observers, in their order. Observers that are no RunObserver get
/// only the calls of the system.
class ObserverList : public RunObserver {
 public:
  /// The observers outlive the list.
  explicit ObserverList(std::span<Observer* const> observers);

  void on_frame(const RgbdFrame& frame, const FrameResult& result) override;
  void on_keyframe(const FrameResult& result) override;
  void on_map(const PointCloud& map, std::int64_t frames) override;
  void on_end(const RunResult& result) override;
  void on_damaged(const DamagedFrame& frame) override;
  void on_dropped(std::size_t frames) override;
  void on_warning(const std::string& warning) override;
  void on_stage_time(std::string_view stage, double ms) override;

 private:
  std::vector<Observer*> observers_;
  std::vector<RunObserver*> of_runs_;  // those that are RunObservers
};

}  // namespace stillmap
