// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"
#include "stillmap/slam/optim/time_evidence.hpp"

namespace stillmap {

struct ShutterConfig {
  bool calibrate = true;
  double max_readout_s = 0.04;
  double max_depth_delay_s = 0.06;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("calibrate",
          self.calibrate,
          common_setting(FieldInfo{"whether the readout time of the camera's rolling shutter and "
                                   "the delay of its depth images are learnt in a run"}));
    visit("max_readout_s",
          self.max_readout_s,
          FieldInfo{"longest readout time that is learnt", "s", 0, 0.2});
    visit("max_depth_delay_s",
          self.max_depth_delay_s,
          FieldInfo{"longest delay of depth images, or lead, that is learnt", "s", 0, 0.2});
  }
};

/// What an adjusted window of the map tells of the camera's times: the evidence of its core and of
/// its latest key frames, as far as their velocities are known.
[[nodiscard]] TimeEvidence time_evidence_of(const Map& window,
                                            std::span<const KeyframeId> core,
                                            const CameraModel& camera,
                                            const MeasurementModel& measure);

/// Corrects the features of key frames for the times as known now. Key frames of a loaded map,
/// whose timing is not known, stay.
void correct_times(Map& window,
                   std::span<const KeyframeId> core,
                   const CameraModel& camera,
                   const CameraTimes& times);

/// Learns the times of a camera from the windows of the map, one after the other.
///
/// A time is believed when it differs from what the camera's file states by more than four standard
/// deviations (and a millisecond); until then the file is. Windows overlap, so that an observation
/// takes part in many: their mean counts as one of them.
class CameraTimesEstimator {
 public:
  CameraTimesEstimator(const ShutterConfig& config, const CameraModel& camera);

  void add(const TimeEvidence& window);
  [[nodiscard]] const CameraTimes& times() const { return times_; }

 private:
  ShutterConfig config_;
  CameraTimes stated_;
  CameraTimes times_;
  TimeEvidence sum_;
  double windows_ = 0;
};

}  // namespace stillmap
