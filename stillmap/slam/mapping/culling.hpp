// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/slam/optim/measurement_model.hpp"

namespace stillmap {

struct CullingConfig {
  double min_found_ratio = 0.25;
  int probation_keyframes = 3;
  int min_observations = 2;
  double redundant_ratio = 0.9;
  int redundant_observers = 3;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit(
        "min_found_ratio",
        self.min_found_ratio,
        FieldInfo{"ratio of found to expected below which a young landmark is removed", "", 0, 1});
    visit("probation_keyframes",
          self.probation_keyframes,
          FieldInfo{"number of key frames during which a landmark is young", "", 0, 100});
    visit(
        "min_observations",
        self.min_observations,
        FieldInfo{"number of observations that a landmark needs two key frames after its creation",
                  "",
                  1,
                  10});
    visit("redundant_ratio",
          self.redundant_ratio,
          FieldInfo{"share of redundant landmarks above which a key frame is removed", "", 0, 1});
    visit("redundant_observers",
          self.redundant_observers,
          FieldInfo{"number of other key frames, at the same or a finer level, that make a "
                    "landmark redundant",
                    "",
                    1,
                    20});
  }
};

/// Removes young landmarks that tracking rarely finds or that too few key frames observe. `newest`
/// is the latest key frame. Returns the number removed.
int cull_young_landmarks(Map& map, KeyframeId newest, const CullingConfig& config);

/// Drops the key frames of `candidates` of whose landmarks nearly all are observed, on the same or
/// a finer level, by enough other key frames. Never drops an origin or `newest`. Returns the number
/// dropped.
int cull_redundant_keyframes(Map& map,
                             std::span<const KeyframeId> candidates,
                             KeyframeId newest,
                             const MeasurementModel& measure,
                             const CullingConfig& config);

}  // namespace stillmap
