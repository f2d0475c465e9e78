// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/replayed_stream.hpp"

#include "stillmap/core/error.hpp"

namespace stillmap {

std::optional<StreamedFrame> ReplayedStream::next() {
  if (next_ == record_.size()) return std::nullopt;
  const LiveStep& step = record_[next_++];
  std::optional<StreamedFrame> frame = stream_.next();
  for (; frame && id_of(*frame) < step.frame; frame = stream_.next()) ++dropped_;
  if (!frame && stream_.ended_early()) return std::nullopt;
  if (!frame || id_of(*frame) != step.frame) {
    throw Error("{}:{}: frame {}, which this sequence lacks; is it the record of another?",
                name_,
                next_,
                step.frame.value);
  }
  const std::string& stamp = stamp_of(*frame).text;
  if (!step.stamp.empty() && step.stamp != stamp) {
    throw Error("{}:{}: frame {} of this sequence has the stamp {}; is it the record of another?",
                name_,
                next_,
                step.frame.value,
                stamp);
  }
  if (const DamagedFrame* const damaged = std::get_if<DamagedFrame>(&*frame)) {
    throw Error("{} (it was read when the run was recorded)", damaged->damage);
  }
  return frame;
}

}  // namespace stillmap
