// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/map_message.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "tooling/browser/message.hpp"
#include "tooling/browser/scene_message.hpp"
#include "tooling/report/page_text.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMostFrames = 1200;
constexpr std::size_t kMostFramesWithObjects = 400;
constexpr std::size_t kMostKeyframes = 300;

// Evenly spread frames, evenly spread ones of these with their objects.
std::vector<ViewedFrame> drawn_frames(const std::vector<ViewedFrame>& all) {
  std::vector<ViewedFrame> frames;
  for (const std::size_t i : evenly_spread(all.size(), kMostFrames)) frames.push_back(all[i]);
  const std::vector<std::size_t> telling = evenly_spread(frames.size(), kMostFramesWithObjects);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!std::ranges::binary_search(telling, i)) frames[i].objects.clear();
  }
  return frames;
}

// Of the frames that tell their objects: number, positions, colours and count of what moves.
std::string movers_json(Message& message,
                        const std::vector<ViewedFrame>& frames,
                        const std::vector<StampedGhosts>& movers) {
  std::map<std::string_view, const GhostPoints*> ghosts_of;
  for (const StampedGhosts& ghosts : movers) ghosts_of[ghosts.stamp.text] = &ghosts.points;
  std::string list;
  for (const std::size_t i : evenly_spread(frames.size(), kMostFramesWithObjects)) {
    const auto found = ghosts_of.find(frames[i].stamp.text);
    const GhostPoints none;
    const GhostPoints& ghosts = found == ghosts_of.end() ? none : *found->second;
    const auto [positions, colors, count] = attach_ghosts(message, ghosts);
    list += fmt::format(
        "{}[{},[{},{},{}]]", list.empty() ? "" : ",", frames[i].number, positions, colors, count);
  }
  return '[' + list + ']';
}

// The time between frames that tell their objects.
std::optional<double> step_s(const std::vector<ViewedFrame>& frames) {
  const std::size_t telling = std::min(frames.size(), kMostFramesWithObjects);
  if (telling < 2) return std::nullopt;
  return (frames.back().stamp.seconds - frames.front().stamp.seconds) /
         static_cast<double>(telling - 1);
}

}  // namespace

std::string map_message(const RunReport& report, const SceneFrame& scene, std::size_t most_points) {
  const std::vector<std::size_t> inside = points_in_scene(*report.map, scene);
  PointCloud drawn;
  for (const std::size_t i : evenly_spread(inside.size(), most_points)) {
    drawn.positions.push_back(report.map->positions[inside[i]]);
    drawn.colors.push_back(report.map->colors[inside[i]]);
  }
  SceneState state{.finished = true, .layout = scene_layout(scene), .keyframes = report.keyframes};
  if (!drawn.empty()) {
    state.layout.spacing_m *=
        std::sqrt(static_cast<double>(inside.size()) / static_cast<double>(drawn.size()));
  }
  PointChunks chunks;
  chunks.add(drawn);
  const std::vector<ViewedFrame> frames = drawn_frames(report.viewed);
  Message message;
  message.add("start",
              start_json({.title = report.sequence,
                          .frames = frames.size(),
                          .camera = report.camera,
                          .step_s = step_s(frames)}));
  message.add("state", state_json(state, kMostKeyframes));
  message.add("frames", frames_json(frames, 0, frames.size()));
  if (!report.movers.empty()) {
    message.add("movers", movers_json(message, frames, report.movers));
  }
  std::vector<std::size_t> sent;
  add_points(message, chunks, sent, chunks.size());
  const std::string bytes = message.bytes();
  return base64({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

}  // namespace stillmap
