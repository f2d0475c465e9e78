// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/view_state.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "tooling/pipeline/lasting_tracks.hpp"
#include "tooling/report/frame_picture.hpp"
#include "tooling/report/scene_frame.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPictureWidth_px = 320;
constexpr int kMaskWidth_px = 160;
constexpr int kGhostPixels = 160;
constexpr std::size_t kMostKeyframes = 2000;
constexpr std::size_t kLayoutPoints = 40'000;  // enough to know how a map lies

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json legend_json() {
  Json styles = Json::array();
  for (const VerdictStyle& style : verdict_styles()) {
    styles.push_back({{"name", style.name}, {"radius", style.radius_px}, {"color", style.color}});
  }
  return {{"styles", styles},
          {"masks", {MaskStyle::kNetwork, MaskStyle::kExtended, MaskStyle::kJumps}}};
}

PointCloud spread(const PointCloud& cloud, std::size_t limit) {
  PointCloud some;
  for (const std::size_t i : evenly_spread(cloud.size(), limit)) {
    some.positions.push_back(cloud.positions[i]);
    some.colors.push_back(cloud.colors[i]);
  }
  return some;
}

// Moves a frame, and what it saw, to its final pose.
void move_to(ViewedFrame& frame, const Eigen::Isometry3d& T_world_camera) {
  const Eigen::Isometry3d T_final_then = T_world_camera * frame.T_world_camera.inverse();
  frame.T_world_camera = T_world_camera;
  for (ViewedObject& object : frame.objects) {
    if (object.p_world) object.p_world = T_final_then * *object.p_world;
    object.velocity_m_s = T_final_then.linear() * object.velocity_m_s;
  }
}

}  // namespace

ViewState::ViewState(ViewStart start) : start_(std::move(start)) {
  if (!start_.camera) return;
  growing_.emplace(*start_.camera);
  ghost_grid_.emplace(*start_.camera, kGhostPixels);
}

void ViewState::apply(ViewInbox::Contents news) {
  for (ViewedFrame& frame : news.frames) add_frame(std::move(frame));
  if (news.newest) newest_ = std::move(news.newest);
  for (const ViewedSample& sample : news.for_map) grow(sample);
  if (news.dropped + news.left_out > 0) {
    state_.dropped += news.dropped;
    state_.left_out += news.left_out;
    ++state_version_;
  }
  if (news.end) end_ = std::move(news.end);
}

void ViewState::add_frame(ViewedFrame frame) {
  frames_.push_back(std::move(frame));
  if (frames_.size() <= kHistoryFrames) return;
  frames_.pop_front();
  ++first_frame_;
}

void ViewState::grow(const ViewedSample& sample) {
  if (!growing_) return;
  map_.add(growing_->add(sample));
}

void ViewState::find_layout(const PointCloud& map, const Trajectory& cameras) {
  if (map.empty()) return;
  const PointCloud some = spread(map, kLayoutPoints);
  state_.layout = scene_layout(scene_frame(some, cameras));
  state_.layout.spacing_m *=
      std::sqrt(static_cast<double>(some.size()) / static_cast<double>(map.size()));
}

void ViewState::finish(ViewedEnd end) {
  const LastingTracks lasting(end.united_tracks);
  std::map<std::string, const StampedPose*> poses;
  for (const StampedPose& pose : end.trajectory) poses[pose.stamp.text] = &pose;
  for (ViewedFrame& frame : frames_) {
    const auto pose = poses.find(frame.stamp.text);
    if (pose != poses.end()) {
      move_to(frame, pose->second->T_world_camera);
    } else if (frame.status != TrackingStatus::kLost) {
      frame.status = TrackingStatus::kLost;  // in a submap that the results do not have
      for (ViewedObject& object : frame.objects) object.p_world.reset();
    }
    for (ViewedObject& object : frame.objects) {
      object.track = lasting.of(TrackId(object.track)).value;
    }
  }
  ++frames_version_;
  map_ = PointChunks();
  map_.add(end.map);
  ++map_version_;
  growing_.reset();
  state_.keyframes = std::move(end.keyframes);
  state_.finished = true;
  ++state_version_;
  find_layout(end.map, end.trajectory);
}

std::string ViewState::next_message(PageProgress& progress) {
  if (end_) finish(*std::exchange(end_, std::nullopt));
  Message message;
  if (!std::exchange(progress.started, true)) {
    message.add("start", start_json(start_));
    message.add("legend", dumped(legend_json()));
  }
  add_state(message, progress);
  const bool more_frames = add_frames(message, progress);
  const bool more_points = add_map(message, progress);
  add_picture(message, progress);
  if (message.empty()) return {};
  if (more_frames || more_points) message.add("more", "true");
  return message.bytes();
}

void ViewState::add_state(Message& message, PageProgress& progress) const {
  if (std::exchange(progress.state_version, state_version_) == state_version_) return;
  message.add("state", state_json(state_, kMostKeyframes));
}

bool ViewState::add_frames(Message& message, PageProgress& progress) const {
  const std::size_t end = first_frame_ + frames_.size();
  if (std::exchange(progress.frames_version, frames_version_) != frames_version_) {
    progress.next_frame = 0;
    message.add("framesAnew", "true");
  }
  const std::size_t begin = std::max(progress.next_frame, first_frame_);
  if (begin >= end) return false;
  const std::size_t stop = std::min(end, begin + kMessageFrames);
  message.add("frames", frames_json(frames_, begin - first_frame_, stop - first_frame_));
  progress.next_frame = stop;
  return stop < end;
}

bool ViewState::add_map(Message& message, PageProgress& progress) const {
  if (std::exchange(progress.map_version, map_version_) != map_version_) {
    progress.points.clear();
    message.add("pointsAnew", "true");
  }
  return add_points(message, map_, progress.points, kMessagePoints);
}

void ViewState::add_picture(Message& message, PageProgress& progress) const {
  if (!newest_ || progress.picture == newest_->first.id.value) return;
  const auto& [frame, result] = *newest_;
  progress.picture = frame.id.value;
  const std::vector<std::uint8_t> jpeg = picture_jpeg(frame.color, kPictureWidth_px);
  const std::vector<std::uint16_t> features = feature_marks(*newest_);
  const MaskRuns masks = mask_runs(*newest_, kMaskWidth_px);
  Json json = {
      {"n", frame.id.value},
      {"jpeg", {message.attach(jpeg), jpeg.size()}},
      {"features", {message.attach(features), features.size() / 3}},
      {"masks", {message.attach(masks.runs), masks.runs.size(), masks.width_px, masks.height_px}}};
  if (has_pose(result) && ghost_grid_) {
    json["ghosts"] = attach_ghosts(message, ghost_points(*newest_, *ghost_grid_));
  }
  Json stages = Json::object();
  for (const StageTime& time : result.stages) {
    const double before = stages.value(std::string(time.stage), 0.0);
    stages[std::string(time.stage)] = std::round((before + time.ms) * 100) / 100;
  }
  json["stages"] = std::move(stages);
  message.add("picture", dumped(json));
}

}  // namespace stillmap
