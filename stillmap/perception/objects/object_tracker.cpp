// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_tracker.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/detections/box_overlap.hpp"
#include "stillmap/perception/objects/box_mask.hpp"
#include "stillmap/perception/objects/boxes.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMostObjects = 255;  // the number of ids of a mask

/// The objects of a frame with their tracks, numbered by their position, and a copy of the mask.
FrameObjects detected_objects(const ObjectTracker::Observation& frame,
                              const std::vector<TrackId>& tracks,
                              const std::vector<MaskSource>& sources) {
  FrameObjects result{frame.id, frame.detections.stamp, {}, {}};
  std::array<std::uint8_t, 256> place{};
  for (const DetectedObject& object : frame.detections.objects) {
    STILLMAP_CHECK(object.id > 0 && object.id <= 255);
    const std::size_t number = result.objects.size() + 1;
    place[static_cast<std::size_t>(object.id)] = static_cast<std::uint8_t>(number);
    TrackedObject tracked{object, tracks[number - 1], std::nullopt, sources[number - 1]};
    tracked.detection.id = static_cast<int>(number);
    result.objects.push_back(std::move(tracked));
  }
  const cv::Mat1b& ids = frame.detections.mask.mat;
  if (ids.empty()) return result;
  result.mask = ObjectMask(cv::Mat1b(ids.size()));
  for (int row = 0; row < ids.rows; ++row) {
    const std::uint8_t* from = ids[row];
    std::transform(
        from, from + ids.cols, result.mask.mat[row], [&](std::uint8_t id) { return place[id]; });
  }
  return result;
}

}  // namespace

ObjectTracker::ObjectTracker(const ObjectTrackerConfig& config, FillRule rule)
    : config_(config), rule_(rule) {}

PixelBox ObjectTracker::predicted_box(const Track& track, double stamp_s) {
  const double elapsed = stamp_s - track.seen_s;
  PixelBox box = track.box;
  box.x0 += track.velocity.x0 * elapsed;
  box.y0 += track.velocity.y0 * elapsed;
  box.x1 += track.velocity.x1 * elapsed;
  box.y1 += track.velocity.y1 * elapsed;
  // Sides that move towards each other must not meet; then the last box is the prediction.
  return box.width() < 1 || box.height() < 1 ? track.box : box;
}

void ObjectTracker::see(Track& track, const DetectedObject& object, double stamp_s) const {
  const double elapsed = stamp_s - track.seen_s;
  if (track.sightings > 0) {
    // The first velocity is taken as it is. Later ones are averaged, because boxes jitter.
    const double gain = track.sightings == 1 ? 1.0 : config_.velocity_gain;
    const auto mix = [&](double& velocity, double from, double to) {
      velocity += gain * ((to - from) / elapsed - velocity);
    };
    mix(track.velocity.x0, track.box.x0, object.box.x0);
    mix(track.velocity.y0, track.box.y0, object.box.y0);
    mix(track.velocity.x1, track.box.x1, object.box.x1);
    mix(track.velocity.y1, track.box.y1, object.box.y1);
  }
  track.box = object.box;
  track.seen_s = stamp_s;
  track.seen_at = pushed_;
  ++track.sightings;
}

std::vector<TrackId> ObjectTracker::associate(const Observation& frame) {
  struct Pair {
    double iou;
    std::size_t track, object;
  };
  const std::vector<DetectedObject>& objects = frame.detections.objects;
  const double now = frame.detections.stamp.seconds;
  std::vector<Pair> pairs;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const PixelBox expected = predicted_box(tracks_[t], now);
    for (std::size_t o = 0; o < objects.size(); ++o) {
      if (objects[o].class_name != tracks_[t].class_name) continue;
      const double iou = box_iou(expected, objects[o].box);
      if (iou >= config_.min_iou) pairs.push_back({iou, t, o});
    }
  }
  // The sort is stable: among equals the order of tracks and objects decides.
  std::ranges::stable_sort(pairs, std::ranges::greater{}, &Pair::iou);
  std::vector<TrackId> found(objects.size());
  std::vector<bool> taken(tracks_.size(), false);
  for (const Pair& pair : pairs) {
    if (taken[pair.track] || found[pair.object].valid()) continue;
    taken[pair.track] = true;
    found[pair.object] = tracks_[pair.track].id;
    see(tracks_[pair.track], objects[pair.object], now);
  }
  for (std::size_t o = 0; o < objects.size(); ++o) {
    if (found[o].valid()) continue;
    found[o] = TrackId(next_track_++);
    Track track;
    track.id = found[o];
    track.class_name = objects[o].class_name;
    see(track, objects[o], now);
    tracks_.push_back(std::move(track));
  }
  return found;
}

// The object's depth in its track's last frame tells its layer from others in the box.
std::vector<MaskSource> ObjectTracker::complete(Observation& frame,
                                                const std::vector<TrackId>& tracks) const {
  std::vector<MaskSource> sources(tracks.size(), MaskSource::kDetected);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const bool by_depth = frame.detections.objects[i].pixel_source == PixelSource::kDepth;
    if (by_depth) sources[i] = MaskSource::kDepth;  // as read from a folder
  }
  if (!config_.masks_from_depth || frame.depth.mat.empty()) return sources;
  std::vector<std::optional<float>> expected;
  for (const TrackId id : tracks) {
    expected.push_back(std::ranges::find(tracks_, id, &Track::id)->depth_m);
  }
  const std::vector<bool> completed = complete_masks(frame.detections, frame.depth, expected);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    if (completed[i]) sources[i] = MaskSource::kDepth;
  }
  return sources;
}

void ObjectTracker::remember_depths(const Held& held) {
  const FrameDetections& detections = held.frame.detections;
  for (std::size_t i = 0; i < held.tracks.size(); ++i) {
    if (held.sources[i] != MaskSource::kDepth) continue;
    const int id = detections.objects[i].id;
    const MaskArea& area = (*held.areas)[static_cast<std::size_t>(id)];
    const ObjectDepths depths =
        object_depths(held.frame.depth, detections.mask, id, area, OutlierRule{});
    if (depths.measured > 0) {
      std::ranges::find(tracks_, held.tracks[i], &Track::id)->depth_m = depths.median_m;
    }
  }
}

std::optional<FrameObjects> ObjectTracker::push(Observation frame) {
  STILLMAP_CHECK(held_.empty() ||
                 held_.back().frame.detections.stamp.seconds < frame.detections.stamp.seconds);
  STILLMAP_CHECK(frame.detections.mask.mat.empty() ||
                 frame.detections.mask.mat.size() == frame.depth.mat.size());
  const auto search = static_cast<std::size_t>(config_.search_frames);
  // A gap may be as long as the searches of both directions together.
  const std::size_t longest_gap = std::max<std::size_t>(2 * search, 1);
  std::erase_if(tracks_, [&](const Track& t) { return pushed_ - t.seen_at > longest_gap; });
  std::vector<TrackId> tracks = associate(frame);
  std::vector<MaskSource> sources = complete(frame, tracks);
  auto areas = std::make_shared<const MaskAreas>(mask_areas(frame.detections.mask));
  held_.push_back(
      {std::move(frame), pushed_, std::move(tracks), std::move(sources), std::move(areas)});
  remember_depths(held_.back());
  ++pushed_;
  const std::size_t delay = rule_ == FillRule::kBothWays ? search : 0;
  if (pushed_ <= delay) return std::nullopt;
  const std::size_t leaving = left_++;
  FrameObjects result = leave(held_[leaving - held_.front().position]);
  // carry_to() always needs the last frame.
  const std::size_t keep = rule_ == FillRule::kCausal ? std::max<std::size_t>(search, 1) : search;
  while (!held_.empty() && held_.front().position + keep <= leaving) held_.pop_front();
  return result;
}

FrameObjects ObjectTracker::carry_to(FrameId frame,
                                     const Stamp& stamp,
                                     const DepthImage& depth) const {
  STILLMAP_CHECK(rule_ == FillRule::kCausal);
  if (held_.empty()) return {frame, stamp, {}, {}};
  STILLMAP_CHECK(held_.back().frame.detections.stamp.seconds < stamp.seconds);
  return leave({{frame, {stamp, {}, {}}, depth}, pushed_, {}, {}, nullptr, false});
}

std::vector<FrameObjects> ObjectTracker::flush() {
  std::vector<FrameObjects> rest;
  for (; left_ < pushed_; ++left_) {
    rest.push_back(leave(held_[left_ - held_.front().position]));
  }
  held_.clear();
  return rest;
}

std::optional<ObjectTracker::Sighting> ObjectTracker::sighting(const Track& track,
                                                               const Held& held,
                                                               int direction) const {
  const std::size_t here = held.position - held_.front().position;
  // The last frame that the network saw serves a frame that it did not see, at any distance.
  const int reach = held.looked_at ? config_.search_frames : std::max(config_.search_frames, 1);
  for (int distance = 1; distance <= reach; ++distance) {
    const auto step = static_cast<std::size_t>(distance);
    if (direction < 0 ? step > here : here + step >= held_.size()) break;
    const Held& other = held_[direction < 0 ? here - step : here + step];
    const auto place = std::ranges::find(other.tracks, track.id);
    if (place == other.tracks.end()) continue;
    return Sighting{&other, static_cast<std::size_t>(place - other.tracks.begin()), distance};
  }
  return std::nullopt;
}

std::optional<ObjectTracker::Fill> ObjectTracker::fill_of(const Track& track,
                                                          const Held& held) const {
  const auto box_of = [](const Sighting& s) {
    return s.held->frame.detections.objects[s.object].box;
  };
  const std::optional<Sighting> before = sighting(track, held, -1);
  const std::optional<Sighting> after = sighting(track, held, +1);
  if (!before && !after) return std::nullopt;
  Fill fill;
  fill.nearest = before && (!after || before->distance <= after->distance) ? *before : *after;
  if (before && after) {
    fill.box = box_between(box_of(*before), before->distance, box_of(*after), after->distance);
  } else if (rule_ == FillRule::kCausal) {
    fill.box = predicted_box(track, held.frame.detections.stamp.seconds);
  } else {
    fill.box = box_of(fill.nearest);
  }
  if (before) fill.origin.before = before->held->frame.id;
  if (after) fill.origin.after = after->held->frame.id;
  return fill;
}

// The object was detected under the class of the track, or under another class with a much higher
// score.
bool ObjectTracker::is_duplicate(const Track& track, const Fill& fill, const Held& held) const {
  constexpr float kSurer = 1.5F;
  const float score = fill.nearest.held->frame.detections.objects[fill.nearest.object].score;
  return std::ranges::any_of(held.frame.detections.objects, [&](const DetectedObject& object) {
    return (object.class_name == track.class_name || object.score > kSurer * score) &&
           box_iou(object.box, fill.box) > config_.duplicate_iou;
  });
}

PropagatedMask ObjectTracker::carried_mask(const Fill& fill, const Held& held) const {
  const Observation& source = fill.nearest.held->frame;
  const DetectedObject& object = source.detections.objects[fill.nearest.object];
  const ObjectView view{source.depth, source.detections.mask, object.id, object.box};
  const MaskArea& area = (*fill.nearest.held->areas)[static_cast<std::size_t>(object.id)];
  PropagationRule rule;
  rule.depth_margin_m = config_.carry_depth_margin_m;
  return propagate_mask(view, area, fill.box, held.frame.depth, rule);
}

// A single detection may be an error of the network. For a frame that the network did not see,
// though, there is no other source.
bool ObjectTracker::is_real(const Track& track, const Held& held) const {
  return track.sightings >= config_.min_sightings ||
         (!held.looked_at && track.seen_at + 1 == held.position);
}

FrameObjects ObjectTracker::leave(const Held& held) const {
  FrameObjects result = detected_objects(held.frame, held.tracks, held.sources);
  for (const Track& track : tracks_) {
    if (!is_real(track, held) || result.objects.size() == kMostObjects) continue;
    if (std::ranges::find(held.tracks, track.id) != held.tracks.end()) continue;
    const std::optional<Fill> fill = fill_of(track, held);
    if (!fill || is_duplicate(track, *fill, held)) continue;
    const cv::Size image = held.frame.depth.mat.size();
    if (pixels_of(fill->box, image).empty()) continue;  // the object has left the image
    const DetectedObject& nearest =
        fill->nearest.held->frame.detections.objects[fill->nearest.object];
    const PropagatedMask carried = carried_mask(*fill, held);
    const std::size_t number = result.objects.size() + 1;
    TrackedObject object{nearest, track.id, fill->origin, carried.source};
    object.detection.id = static_cast<int>(number);
    object.detection.box = fill->box;
    result.objects.push_back(std::move(object));
    if (result.mask.mat.empty()) result.mask = ObjectMask(cv::Mat1b(image, std::uint8_t{0}));
    paint(result.mask, carried.patch, static_cast<std::uint8_t>(number));
  }
  return result;
}

}  // namespace stillmap
