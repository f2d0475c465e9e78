// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/tracking_gaps.hpp"

#include <algorithm>

#include <fmt/core.h>

#include "tooling/report/display_text.hpp"

namespace stillmap {

std::vector<TrackingGap> tracking_gaps(std::span<const Stamp> lost, const Trajectory& estimate) {
  std::vector<TrackingGap> gaps;
  std::size_t next_lost = 0;
  auto found = estimate.begin();
  while (next_lost < lost.size()) {
    const double first_s = lost[next_lost].seconds;
    found = std::find_if(found, estimate.end(), [&](const StampedPose& frame) {
      return frame.stamp.seconds > first_s;
    });
    TrackingGap gap;
    gap.first_lost = lost[next_lost];
    for (; next_lost < lost.size(); ++next_lost) {
      if (found != estimate.end() && lost[next_lost].seconds > found->stamp.seconds) break;
      ++gap.frames;
      gap.seconds = lost[next_lost].seconds - first_s;
    }
    if (found != estimate.end()) {
      gap.found = found->stamp;
      gap.seconds = found->stamp.seconds - first_s;
      if (found != estimate.begin()) {
        gap.moved_m =
            (found->T_world_camera.translation() - std::prev(found)->T_world_camera.translation())
                .norm();
      }
    }
    gaps.push_back(gap);
  }
  return gaps;
}

std::string gap_text(const TrackingGap& gap) {
  std::string text = fmt::format("{} frame{} from {}, {}; ",
                                 count_text(gap.frames),
                                 gap.frames == 1 ? "" : "s",
                                 gap.first_lost.text,
                                 duration_text(1000 * gap.seconds));
  if (!gap.found) return text + "not found again";
  if (!gap.moved_m) return text + fmt::format("begun at {}", gap.found->text);
  return text + fmt::format("found again at {}, {} from where it was lost",
                            gap.found->text,
                            length_text(*gap.moved_m));
}

}  // namespace stillmap
