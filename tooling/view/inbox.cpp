// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/inbox.hpp"

namespace stillmap {

template <class Change>
bool ViewInbox::put(const Change& change) {
  const std::lock_guard lock(mutex_);
  change();
  return !std::exchange(waiting_, true);
}

bool ViewInbox::put_frame(ViewedFrame frame, std::optional<ViewedSample> sample) {
  return put([&] {
    contents_.frames.push_back(std::move(frame));
    if (contents_.frames.size() > kFrames) {
      contents_.frames.pop_front();
      ++contents_.left_out;
    }
    if (sample) contents_.newest = std::move(sample);
  });
}

bool ViewInbox::put_for_map(ViewedSample sample) {
  return put([&] {
    contents_.for_map.push_back(std::move(sample));
    if (contents_.for_map.size() > kForMap) {
      contents_.for_map.pop_front();
      ++contents_.left_out;
    }
  });
}

bool ViewInbox::put_dropped(std::size_t frames) {
  return put([&] { contents_.dropped += frames; });
}

bool ViewInbox::put_end(ViewedEnd end) {
  return put([&] { contents_.end = std::move(end); });
}

ViewInbox::Contents ViewInbox::take() {
  const std::lock_guard lock(mutex_);
  waiting_ = false;
  return std::exchange(contents_, {});
}

}  // namespace stillmap
