// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/live_log.hpp"

#include <cstdint>
#include <utility>

#include "stillmap/session/bytes.hpp"

namespace stillmap {

void LiveLog::push_back(const LiveStep& step) {
  ByteWriter out;
  out.number(step.frame.value);
  out.text(step.stamp);
  out.count(step.objects_of.size());
  for (const FrameId id : step.objects_of) out.number(id.value);
  steps_.push_back(out.bytes());
}

LiveRecord LiveLog::record() const {
  LiveRecord record;
  steps_.visit([&](std::string_view bytes) {
    ByteReader in(std::string(bytes), "the record of a live run");
    LiveStep step;
    step.frame = FrameId(in.number<std::uint32_t>());
    step.stamp = in.text();
    step.objects_of.resize(in.count(sizeof(std::uint32_t)));
    for (FrameId& id : step.objects_of) id = FrameId(in.number<std::uint32_t>());
    record.push_back(std::move(step));
  });
  return record;
}

}  // namespace stillmap
