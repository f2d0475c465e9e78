// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/frame_log.hpp"

#include <string_view>
#include <utility>

namespace stillmap {
namespace {

std::string_view match_judge_name(MatchJudge judge) {
  switch (judge) {
    case MatchJudge::kNotAsked:
      break;
    case MatchJudge::kNothing:
      return "nothing";
    case MatchJudge::kFundamental:
      return "fundamental matrix";
    case MatchJudge::kRotation:
      return "rotation";
    case MatchJudge::kPrediction:
      return "prediction";
  }
  return "not asked";
}

}  // namespace

void FrameLog::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  ++frames_;
  tracked_features_.push_back(result.tracked_features);
  if (!has_pose(result)) lost_.push_back(frame.stamp);
  if (result.match_judge == MatchJudge::kNotAsked) return;
  ++matches_judged_by_[std::string(match_judge_name(result.match_judge))];
}

void FrameLog::on_damaged(const DamagedFrame& frame) {
  ++frames_;
  damaged_.push_back(frame);
}

void FrameLog::on_dropped(std::size_t frames) {
  frames_ += frames;
}

void FrameLog::on_warning(const std::string& warning) {
  warnings_.push_back(warning);
}

void FrameLog::fill(RunReport& report) {
  report.skipped = std::move(damaged_);
  report.lost = std::move(lost_);
  report.matches_judged_by = std::move(matches_judged_by_);
  report.tracked_features = std::move(tracked_features_);
  report.warnings = std::move(warnings_);
}

}  // namespace stillmap
