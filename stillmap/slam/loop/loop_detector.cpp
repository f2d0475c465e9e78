// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/loop/loop_detector.hpp"

#include "stillmap/slam/map/covisibility.hpp"

namespace stillmap {
namespace {

constexpr int kMinShared = 10;  // fewer common landmarks may be wrong matches

std::vector<KeyframeId> neighbours(const Map& map, KeyframeId id) {
  std::vector<KeyframeId> ids;
  for (const CovisibleKeyframe& other : covisible_keyframes(map, id)) {
    if (other.shared_landmarks >= kMinShared) ids.push_back(other.id);
  }
  return ids;
}

}  // namespace

LoopDetector::LoopDetector(const LoopConfig& config,
                           const CameraModel& camera,
                           MeasurementModel measure,
                           std::uint32_t seed)
    : config_(config),
      camera_(camera),
      measure_(std::move(measure)),
      gate_(config.gate),
      verifier_(config.verifier, camera, measure_, seed) {}

std::optional<LoopMatch> LoopDetector::advance(const Map& map,
                                               const PlaceIndex& places,
                                               KeyframeId newest) {
  const Keyframe& keyframe = map.keyframe(newest);
  std::vector<KeyframeId> known = neighbours(map, newest);
  known.push_back(newest);
  std::vector<GateCandidate> candidates;
  for (const PlaceCandidate& found : places.query(
           keyframe.features->descriptors, static_cast<std::size_t>(config_.candidates), known)) {
    candidates.push_back({found.keyframe, neighbours(map, found.keyframe)});
  }
  const std::vector<KeyframeId> passed = gate_.advance(candidates);
  if (passed.empty()) return std::nullopt;
  const LoopView here = loop_view(keyframe, map, camera_, measure_);
  for (const KeyframeId candidate : passed) {
    const LoopView there = loop_view(map.keyframe(candidate), map, camera_, measure_);
    std::optional<LoopMatch> loop = verifier_.verify(keyframe.frame, there, here);
    if (loop) return loop;
  }
  return std::nullopt;
}

}  // namespace stillmap
