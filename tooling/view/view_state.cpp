// SPDX-License-Identifier: Apache-2.0
#include "tooling/view/view_state.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <nlohmann/json.hpp>

#include "tooling/pipeline/lasting_tracks.hpp"
#include "tooling/report/frame_picture.hpp"
#include "tooling/report/map_view_data.hpp"
#include "tooling/report/scene_frame.hpp"

namespace stillmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPictureWidth_px = 320;
constexpr int kMaskWidth_px = 160;
constexpr int kGhostPixels = 160;
// scene_frame() tries some 2000 directions with every point.
constexpr std::size_t kLevelPoints = 4000;

std::string dumped(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json start_json(const ViewStart& start) {
  Json styles = Json::array();
  for (const VerdictStyle& style : verdict_styles()) {
    styles.push_back({{"name", style.name}, {"radius", style.radius_px}, {"color", style.color}});
  }
  Json json = {{"version", 1},
               {"title", start.title},
               {"frames", start.frames ? Json(*start.frames) : Json()},
               {"side", PointChunks::kSide_m},
               {"styles", styles},
               {"masks", {MaskStyle::kNetwork, MaskStyle::kExtended, MaskStyle::kJumps}}};
  if (start.camera) {
    const CameraModel& camera = *start.camera;
    json["camera"] = {{"width", camera.width_px},
                      {"height", camera.height_px},
                      {"fx", camera.fx},
                      {"fy", camera.fy},
                      {"cx", camera.cx},
                      {"cy", camera.cy}};
  }
  return json;
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
    dropped_ += news.dropped;
    left_out_ += news.left_out;
    ++state_version_;
  }
  if (news.end) finish(std::move(*news.end));
}

void ViewState::add_frame(ViewedFrame frame) {
  frames_.push_back(std::move(frame));
  if (frames_.size() <= kHistoryFrames) return;
  frames_.pop_front();
  ++first_frame_;
}

void ViewState::grow(const ViewedSample& sample) {
  if (!growing_ || finished_) return;
  map_.add(growing_->add(sample));
}

void ViewState::find_level(const PointCloud& cloud, const Trajectory& cameras) {
  if (cloud.empty()) return;
  R_level_world_ = scene_frame(cloud, cameras).R_level_world;
  ++state_version_;
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
  keyframes_ = std::move(end.keyframes);
  finished_ = true;
  ++state_version_;
  find_level(spread(end.map, kLevelPoints), end.trajectory);
}

std::string ViewState::next_message(PageProgress& progress) const {
  Message message;
  if (!std::exchange(progress.started, true)) message.add("start", dumped(start_json(start_)));
  add_state(message, progress);
  const bool more_frames = add_frames(message, progress);
  const bool more_points = add_points(message, progress);
  add_picture(message, progress);
  if (message.empty()) return {};
  if (more_frames || more_points) message.add("more", "true");
  return message.bytes();
}

void ViewState::add_state(Message& message, PageProgress& progress) const {
  if (std::exchange(progress.state_version, state_version_) == state_version_) return;
  Json level = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) level.push_back(R_level_world_(row, column));
  }
  Json json = {{"dropped", dropped_}, {"leftOut", left_out_}, {"level", std::move(level)}};
  if (finished_) {
    Json keyframes = Json::array();
    for (const std::size_t i : evenly_spread(keyframes_.size(), 2000)) {
      const ViewedFrame frame{.stamp = keyframes_[i].stamp,
                              .status = TrackingStatus::kTracked,
                              .T_world_camera = keyframes_[i].T_world_camera,
                              .objects = {}};
      keyframes.push_back(Json::parse(frame_json(frame))["p"]);
    }
    json["keyframes"] = std::move(keyframes);
    json["finished"] = true;
  }
  message.add("state", dumped(json));
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
  std::string list = "[";
  for (std::size_t i = begin; i < stop; ++i) {
    if (i > begin) list += ',';
    list += frame_json(frames_[i - first_frame_]);
  }
  message.add("frames", list + ']');
  progress.next_frame = stop;
  return stop < end;
}

bool ViewState::add_points(Message& message, PageProgress& progress) const {
  if (std::exchange(progress.map_version, map_version_) != map_version_) {
    progress.points.clear();
    message.add("pointsAnew", "true");
  }
  progress.points.resize(map_.chunks().size(), 0);
  Json parts = Json::array();
  std::size_t room = kMessagePoints;
  bool more = false;
  for (std::size_t i = 0; i < map_.chunks().size(); ++i) {
    const PointChunk& chunk = map_.chunks()[i];
    std::size_t& sent = progress.points[i];
    const std::size_t count = std::min(chunk.size() - sent, room);
    more = more || count < chunk.size() - sent;
    if (count == 0) continue;
    const auto positions = std::span(chunk.positions).subspan(3 * sent, 3 * count);
    const auto colors = std::span(chunk.colors).subspan(3 * sent, 3 * count);
    const std::size_t positions_at = message.attach(positions);
    const std::size_t colors_at = message.attach(colors);
    parts.push_back(
        {i, chunk.cell[0], chunk.cell[1], chunk.cell[2], count, positions_at, colors_at});
    sent += count;
    room -= count;
  }
  if (!parts.empty()) message.add("points", dumped(parts));
  return more;
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
    const GhostPoints ghosts = ghost_points(*newest_, *ghost_grid_);
    json["ghosts"] = {
        message.attach(ghosts.positions), message.attach(ghosts.colors), ghosts.size()};
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
