// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/sample_log.hpp"

#include <utility>

namespace stillmap {
namespace {

constexpr std::size_t kSamples = 8;

}  // namespace

// Where the total is not known, every second sample is dropped when there are twice too many.
bool SampleLog::wants_next() {
  if (total_) return frames_ * kSamples / *total_ != (frames_ + 1) * kSamples / *total_;
  if (frames_ % stride_ != 0) return false;
  if (samples_.size() + 1 < 2 * kSamples) return true;
  std::vector<ReportSample> every_second;
  for (std::size_t i = 0; i < samples_.size(); i += 2) {
    every_second.push_back(std::move(samples_[i]));
  }
  samples_ = std::move(every_second);
  stride_ *= 2;
  return frames_ % stride_ == 0;
}

void SampleLog::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  if (wants_next()) {
    RgbdFrame shown;  // without its other images, so that they need not be kept
    shown.id = frame.id;
    shown.stamp = frame.stamp;
    shown.color = frame.color;
    samples_.emplace_back(std::move(shown), result);
  }
  ++frames_;
}

void SampleLog::fill(RunReport& report) {
  report.samples = std::move(samples_);
}

}  // namespace stillmap
