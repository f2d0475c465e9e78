// SPDX-License-Identifier: Apache-2.0
#include "tooling/pipeline/run_observer.hpp"

namespace stillmap {

ObserverList::ObserverList(std::span<Observer* const> observers)
    : observers_(observers.begin(), observers.end()) {
  for (Observer* const observer : observers_) {
    if (auto* const of_runs = dynamic_cast<RunObserver*>(observer)) of_runs_.push_back(of_runs);
  }
}

void ObserverList::on_frame(const RgbdFrame& frame, const FrameResult& result) {
  for (Observer* const observer : observers_) observer->on_frame(frame, result);
}

void ObserverList::on_keyframe(const FrameResult& result) {
  for (Observer* const observer : observers_) observer->on_keyframe(result);
}

void ObserverList::on_map(const PointCloud& map, std::int64_t frames) {
  for (Observer* const observer : observers_) observer->on_map(map, frames);
}

void ObserverList::on_end(const RunResult& result) {
  for (Observer* const observer : observers_) observer->on_end(result);
}

void ObserverList::on_damaged(const DamagedFrame& frame) {
  for (RunObserver* const observer : of_runs_) observer->on_damaged(frame);
}

void ObserverList::on_dropped(std::size_t frames) {
  for (RunObserver* const observer : of_runs_) observer->on_dropped(frames);
}

void ObserverList::on_warning(const std::string& warning) {
  for (RunObserver* const observer : of_runs_) observer->on_warning(warning);
}

void ObserverList::on_stage_time(std::string_view stage, double ms) {
  for (RunObserver* const observer : of_runs_) observer->on_stage_time(stage, ms);
}

}  // namespace stillmap
