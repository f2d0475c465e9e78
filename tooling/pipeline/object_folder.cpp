// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/object_folder.hpp"

#include <utility>

namespace stillmap {

void ObjectFolder::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  FrameDetections detections{frame.stamp, {}, result.object_mask};
  for (const ObjectState& state : result.objects) {
    const int id = static_cast<int>(detections.objects.size()) + 1;
    detections.objects.push_back({id, state.class_name, state.score, state.box});
  }
  writer_.add(detections);
}

}  // namespace stillmap
