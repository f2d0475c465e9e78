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
    visit("min_found_ratio",
          self.min_found_ratio,
          FieldInfo{"a young landmark found less often, of the times expected, goes", "", 0, 1});
    visit("probation_keyframes",
          self.probation_keyframes,
          FieldInfo{"for how many key frames a landmark counts as young", "", 0, 100});
    visit("min_observations",
          self.min_observations,
          FieldInfo{
              "key frames that must see a landmark two key frames after its making", "", 1, 10});
    visit(
        "redundant_ratio",
        self.redundant_ratio,
        FieldInfo{"share of a key frame's landmarks that others must see for it to go", "", 0, 1});
    visit("redundant_observers",
          self.redundant_observers,
          FieldInfo{"how many others must see each, as finely", "", 1, 20});
  }
};

/// Removes young landmarks that tracking rarely finds or that too few key frames see.
/// `newest` is the latest key frame. Returns how many went.
int cull_young_landmarks(Map& map, KeyframeId newest, const CullingConfig& config);

/// Drops those of `candidates` whose landmarks nearly all are seen, on the same or a finer level,
/// by enough other key frames. Never the first key frame or `newest`. Returns how many went.
int cull_redundant_keyframes(Map& map,
                             std::span<const KeyframeId> candidates,
                             KeyframeId newest,
                             const MeasurementModel& measure,
                             const CullingConfig& config);

}  // namespace stillmap
