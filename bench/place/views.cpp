// SPDX-License-Identifier: Apache-2.0
#include "bench/place/views.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stillmap/core/error.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "stillmap/slam/features/orb_extractor.hpp"

namespace stillmap {
namespace {

const StampedPose* nearest(const Trajectory& truth, double stamp_s) {
  const StampedPose* best = nullptr;
  for (const StampedPose& pose : truth) {
    const double apart = std::abs(pose.stamp.seconds - stamp_s);
    if (apart < 0.02 && (best == nullptr || apart < std::abs(best->stamp.seconds - stamp_s))) {
      best = &pose;
    }
  }
  return best;
}

}  // namespace

std::vector<PlaceView> read_views(const std::string& text, std::size_t gap) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw Error("{}: expected ROOM=FOLDER", text);
  const std::string label = text.substr(0, equals);
  const std::size_t at = label.find('@');
  SequenceOptions options;
  if (at != std::string::npos) options.camera = builtin_camera(label.substr(at + 1));
  const Sequence sequence = Sequence::open(text.substr(equals + 1), options);
  const Trajectory truth = sequence.groundtruth().value().poses;
  OrbExtractor extractor({}, sequence.camera());
  std::vector<PlaceView> views;
  for (std::size_t i = 0; i < sequence.size(); i += gap) {
    const FrameId id(static_cast<std::uint32_t>(i));
    const double stamp_s = sequence.entry(id).stamp.seconds;
    const StampedPose* pose = nearest(truth, stamp_s);
    if (pose == nullptr) continue;
    const FramePtr frame = sequence.read(id);
    views.push_back({label.substr(0, at),
                     stamp_s - sequence.entry(FrameId(0)).stamp.seconds,
                     pose->T_world_camera,
                     std::make_shared<const Features>(extractor.extract(frame->gray, frame->depth)),
                     sequence.camera()});
  }
  return views;
}

double angle_deg(const PlaceView& a, const PlaceView& b) {
  const double cosine = a.T_world_camera.linear().col(2).dot(b.T_world_camera.linear().col(2));
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

Relation relation(const PlaceView& a, const PlaceView& b) {
  if (a.room.substr(0, a.room.find('.')) != b.room.substr(0, b.room.find('.'))) {
    return Relation::kDifferent;
  }
  const double apart_m = (a.T_world_camera.translation() - b.T_world_camera.translation()).norm();
  const double apart_deg = angle_deg(a, b);
  if (apart_m < 0.5 && apart_deg < 30) {
    return a.room == b.room ? Relation::kSame : Relation::kNeither;
  }
  return apart_m > 1.5 || apart_deg > 60 ? Relation::kDifferent : Relation::kNeither;
}

}  // namespace stillmap
