// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/objects/object_identities.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stillmap/perception/objects/similar_classes.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kFewestPoints = 8;      // of a look that tells a place
constexpr std::size_t kPointsForColors = 40;  // of a look that tells colors
constexpr double kForgetTrackletAfter_s = 10;
constexpr double kSoon_s = 5;              // within it a person near the last place is the same
constexpr double kLeastShareOfArea = 0.2;  // of the largest sighting, to be found by colors
constexpr double kSamePlace_m = 0.25;      // two things are not in one place
constexpr double kMostOfWhole = 0.7;       // least area of a sighting that tells the extent
constexpr double kPartOfWhole = 0.5;       // greatest area of a part
constexpr double kBetweenRuns_s = 3600;    // then a person may be anywhere
constexpr int kYoung = 5;                  // sightings after which an object is known
constexpr float kColorGain = 0.1F;
constexpr float kSureScore = 0.5F;  // below it, most people of the default networks are none

/// The box around the points between the 5th and the 95th percentile of each coordinate.
Eigen::AlignedBox3d extent_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d least, most;
  std::vector<double> values(points.size());
  const std::size_t tail = points.size() / 20;
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(
        points, values.begin(), [axis](const Eigen::Vector3d& p) { return p[axis]; });
    std::ranges::sort(values);
    least[axis] = values[tail];
    most[axis] = values[values.size() - 1 - tail];
  }
  return {least, most};
}

}  // namespace

KnownObject moved(KnownObject object, const Eigen::Isometry3d& T) {
  for (Eigen::Vector3d& p : object.surface) p = T * p;
  if (!object.extent.isEmpty()) object.extent = object.extent.transformed(T);
  return object;
}

ObjectIdentities::ObjectIdentities(const IdentityConfig& config,
                                   const CategoryTable& categories,
                                   const CameraModel& camera)
    : config_(config), categories_(categories), camera_(camera) {}

std::vector<ObjectIdentities::Sighting> ObjectIdentities::sightings_of(
    const RgbdFrame& frame,
    const FrameObjects& objects,
    const MaskAreas& areas,
    std::span<const ObjectDepths> depths,
    const std::optional<Eigen::Isometry3d>& T_odometry_camera) const {
  std::vector<Sighting> sightings;
  for (std::size_t i = 0; i < objects.objects.size(); ++i) {
    const TrackedObject& object = objects.objects[i];
    const DetectedObject& detection = object.detection;
    Sighting sighting;
    sighting.tracklet = object.track;
    sighting.class_name = detection.class_name;
    sighting.detected = !object.filled;
    if (T_odometry_camera && i < depths.size() && depths[i].interval) {
      const ObjectView view{frame.depth, objects.mask, detection.id, detection.box};
      const cv::Rect& area = areas[static_cast<std::size_t>(detection.id)].bounds;
      sighting.look = look_of(frame, view, area, *depths[i].interval, camera_);
      for (Eigen::Vector3d& p : sighting.look.surface) p = *T_odometry_camera * p;
      if (!sighting.look.surface.empty()) sighting.middle = median_point(sighting.look.surface);
    }
    sightings.push_back(std::move(sighting));
  }
  return sightings;
}

// A person cannot have jumped: then boxes of two people were taken for each other.
bool ObjectIdentities::has_jumped(const Sighting& sighting,
                                  const KnownObject& object,
                                  double now_s) const {
  if (!mobile(object) || object.surface.empty()) return false;
  if (sighting.look.surface.size() < kPointsForColors) return false;
  const double walked = config_.walking_m_s * std::abs(now_s - object.seen_s);
  return gap(sighting, object) > config_.reach_m + walked;
}

void ObjectIdentities::continue_tracks(std::vector<Sighting>& sightings, double now_s) {
  for (Sighting& sighting : sightings) {
    const auto joined = std::ranges::find(joined_, sighting.tracklet, &Joined::tracklet);
    if (joined == joined_.end()) continue;
    const std::size_t known = place_of(joined->track);
    if (has_jumped(sighting, known_[known], now_s)) {
      joined_.erase(joined);
    } else {
      sighting.known = known;
    }
  }
}

std::size_t ObjectIdentities::place_of(TrackId track) const {
  const auto object = std::ranges::lower_bound(known_, track, {}, &KnownObject::track);
  return static_cast<std::size_t>(object - known_.begin());
}

// How badly a sighting fits an object that is not in the frame; nothing if it cannot be that.
std::optional<double> ObjectIdentities::cost_of_return(const Sighting& sighting,
                                                       const KnownObject& object,
                                                       double now_s) const {
  const ObjectLook& look = sighting.look;
  if (look.surface.size() < kFewestPoints ||
      !similar_classes(sighting.class_name, object.class_name)) {
    return std::nullopt;
  }
  const double distance = gap(sighting, object);
  const double colors = color_distance(look.colors, object.colors);
  if (!mobile(object)) {
    if (distance > config_.reach_m) return std::nullopt;
    return distance / config_.reach_m + colors;
  }
  const double away_s = std::abs(now_s - object.seen_s);
  const double walked = config_.reach_m + config_.walking_m_s * away_s;
  const bool near = away_s <= kSoon_s && distance <= config_.reach_m;
  const bool looks_alike = colors <= config_.most_color_distance &&
                           look.surface.size() >= kPointsForColors &&
                           look.area_m2 >= kLeastShareOfArea * object.extent_area_m2;
  if (distance > walked || !(near || looks_alike)) return std::nullopt;
  return distance / walked + colors;
}

bool ObjectIdentities::mobile(const KnownObject& object) const {
  return categories_.of(object.class_name) == Category::kDynamic;
}

// From the middle of a sighting to the object's surface or, for a thing, to where it was seen best.
double ObjectIdentities::gap(const Sighting& sighting, const KnownObject& object) const {
  const double to_surface = distance_to(object.surface, sighting.middle);
  if (mobile(object) || object.extent.isEmpty()) return to_surface;
  return std::min(to_surface, object.extent.exteriorDistance(sighting.middle));
}

// The best pairs of a sighting and an object that is not in the frame, each at most once. An object
// that has been seen in few frames may turn out to be one that was known before.
std::vector<ObjectIdentities::Pair> ObjectIdentities::returns(
    const std::vector<Sighting>& sightings, double now_s) const {
  std::vector<bool> present(known_.size(), false);
  for (const Sighting& s : sightings) {
    if (s.known != kNone) present[s.known] = true;
  }
  std::vector<Pair> pairs, best;
  for (std::size_t s = 0; s < sightings.size(); ++s) {
    const std::size_t own = sightings[s].known;
    if (own != kNone && known_[own].sightings > kYoung) continue;
    for (std::size_t k = 0; k < (own == kNone ? known_.size() : own); ++k) {
      if (present[k]) continue;
      if (const auto cost = cost_of_return(sightings[s], known_[k], now_s)) {
        pairs.push_back({*cost, s, k});
      }
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::cost);
  for (const Pair& pair : pairs) {
    const bool taken = std::ranges::any_of(best, [&](const Pair& other) {
      return other.sighting == pair.sighting || other.known == pair.known;
    });
    if (!taken) best.push_back(pair);
  }
  return best;
}

void ObjectIdentities::find_again(std::vector<Sighting>& sightings, double now_s) {
  std::vector<std::pair<TrackId, TrackId>> one;  // later and earlier track of one object
  for (const Pair& pair : returns(sightings, now_s)) {
    std::size_t& known = sightings[pair.sighting].known;
    if (known != kNone) one.emplace_back(known_[known].track, known_[pair.known].track);
    known = pair.known;
  }
  for (const auto& [later, earlier] : one) unite(later, earlier, sightings);
}

// Two things in one place are one.
void ObjectIdentities::unite_by_place(std::vector<Sighting>& sightings) {
  std::vector<std::pair<TrackId, TrackId>> one;
  for (const Sighting& sighting : sightings) {
    const KnownObject& later = known_[sighting.known];
    if (sighting.look.surface.size() < kFewestPoints || mobile(later)) continue;
    for (const KnownObject& earlier : known_) {
      if (earlier.track >= later.track) break;
      if (!similar_classes(earlier.class_name, later.class_name) || earlier.extent.isEmpty())
        continue;
      if (earlier.extent.exteriorDistance(sighting.middle) > 0 ||
          later.extent.exteriorDistance(earlier.extent.center()) > kSamePlace_m) {
        continue;
      }
      one.emplace_back(later.track, earlier.track);
      break;
    }
  }
  for (const auto& [later, earlier] : one) unite(later, earlier, sightings);
}

// Sightings of the later one become sightings of the earlier one, from its beginning on.
void ObjectIdentities::unite(TrackId later, TrackId earlier, std::vector<Sighting>& sightings) {
  const std::size_t from = place_of(later), to = place_of(earlier);
  if (from >= known_.size() || known_[from].track != later) return;  // united in this frame
  known_[to].sightings += known_[from].sightings;
  if (known_[from].extent_area_m2 > known_[to].extent_area_m2) {
    known_[to].extent = known_[from].extent;
    known_[to].extent_area_m2 = known_[from].extent_area_m2;
  }
  for (Joined& joined : joined_) {
    if (joined.track == later) joined.track = earlier;
  }
  for (Sighting& sighting : sightings) {
    if (sighting.known == kNone) continue;
    if (sighting.known == from) sighting.known = to;
    if (sighting.known > from) --sighting.known;
  }
  known_.erase(known_.begin() + static_cast<std::ptrdiff_t>(from));
  united_.push_back({later, earlier});
}

// The object in the frame of which a sighting is a part: the nearest one.
std::size_t ObjectIdentities::whole_of(const Sighting& part,
                                       const std::vector<Sighting>& sightings) const {
  std::size_t nearest = kNone;
  if (part.look.surface.empty()) return nearest;
  const bool walks = categories_.of(part.class_name) == Category::kDynamic;
  double least = config_.part_reach_m;
  for (const Sighting& whole : sightings) {
    if (whole.known == kNone || !similar_classes(whole.class_name, part.class_name)) continue;
    const double distance = distance_to(whole.look.surface, part.middle);
    const double whole_m2 = std::max(whole.look.area_m2, known_[whole.known].extent_area_m2);
    const bool small = part.look.area_m2 <= kPartOfWhole * whole_m2;
    const bool same_place = !walks && distance <= kSamePlace_m;
    if (!(small || same_place) || distance > least) continue;
    least = distance;
    nearest = whole.known;
  }
  return nearest;
}

// The largest comes first, because the others may be parts of it.
void ObjectIdentities::begin_tracks(std::vector<Sighting>& sightings) {
  std::vector<Sighting*> unknown;
  for (Sighting& sighting : sightings) {
    if (sighting.known == kNone) unknown.push_back(&sighting);
  }
  std::ranges::stable_sort(
      unknown, std::ranges::greater{}, [](const Sighting* s) { return s->look.area_m2; });
  for (Sighting* const sighting : unknown) {
    sighting->known = whole_of(*sighting, sightings);
    if (sighting->known != kNone) continue;
    sighting->known = known_.size();
    KnownObject fresh;
    fresh.track = TrackId(next_track_++);
    fresh.class_name = sighting->class_name;
    known_.push_back(std::move(fresh));
  }
}

void ObjectIdentities::remember(const std::vector<Sighting>& sightings, double now_s) {
  for (const Sighting& sighting : sightings) {
    KnownObject& object = known_[sighting.known];
    const auto joined = std::ranges::find(joined_, sighting.tracklet, &Joined::tracklet);
    if (joined != joined_.end()) {
      joined->seen_s = now_s;
    } else {
      joined_.push_back({sighting.tracklet, object.track, now_s});
    }
    if (!sighting.detected) continue;
    const bool of_this_frame = object.sightings > 0 && object.seen_s == now_s;  // another part is
    const ObjectLook& look = sighting.look;
    if (of_this_frame && look.surface.size() <= object.surface.size()) continue;
    object.class_name = sighting.class_name;
    object.seen_s = now_s;
    object.sightings += of_this_frame ? 0 : 1;
    if (look.surface.size() < kFewestPoints) continue;
    object.surface = look.surface;
    if (look.area_m2 >= kMostOfWhole * object.extent_area_m2) {
      object.extent = extent_of(look.surface);
      object.extent_area_m2 = std::max(look.area_m2, object.extent_area_m2);
    }
    const float gain = object.sightings == 1 ? 1.0F : kColorGain;
    for (std::size_t i = 0; i < object.colors.size(); ++i) {
      object.colors[i] += gain * (look.colors[i] - object.colors[i]);
    }
  }
  std::erase_if(joined_,
                [&](const Joined& j) { return now_s - j.seen_s > kForgetTrackletAfter_s; });
}

IdentifiedObjects ObjectIdentities::identify(
    const RgbdFrame& frame,
    const FrameObjects& objects,
    const MaskAreas& areas,
    std::span<const ObjectDepths> depths,
    const std::optional<Eigen::Isometry3d>& T_odometry_camera) {
  IdentifiedObjects identified;
  if (!config_.enabled) {
    for (const TrackedObject& object : objects.objects) identified.tracks.push_back(object.track);
    return identified;
  }
  const double now_s = objects.stamp.seconds;
  std::vector<Sighting> sightings = sightings_of(frame, objects, areas, depths, T_odometry_camera);
  continue_tracks(sightings, now_s);
  find_again(sightings, now_s);
  begin_tracks(sightings);
  remember(sightings, now_s);
  unite_by_place(sightings);
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    Sighting& sighting = sightings[i];
    const KnownObject& object = known_[sighting.known];
    identified.tracks.push_back(object.track);
    if (!mobile(object)) continue;
    // A mask filled in where the network saw nobody may lie on who hides that person.
    const TrackedObject& found = objects.objects[i];
    const bool sure = !found.filled && found.detection.score >= kSureScore;
    if (!sure) sighting.look.surface.clear();
    identified.movers.push_back({object.track, std::move(sighting.look.surface)});
  }
  return identified;
}

void ObjectIdentities::know(std::vector<KnownObject> objects) {
  unplaced_ = std::move(objects);
  if (!unplaced_.empty()) next_track_ = unplaced_.back().track.value + 1;
}

void ObjectIdentities::place(const Eigen::Isometry3d& T_odometry_world, double now_s) {
  for (KnownObject& object : unplaced_) {
    object = moved(std::move(object), T_odometry_world);
    object.seen_s = now_s - kBetweenRuns_s;
  }
  known_.insert(known_.begin(), unplaced_.begin(), unplaced_.end());
  unplaced_.clear();
}

std::vector<KnownObject> ObjectIdentities::all_in_world(
    const Eigen::Isometry3d& T_odometry_world) const {
  std::vector<KnownObject> objects = unplaced_;
  for (const KnownObject& object : known_) {
    objects.push_back(moved(object, T_odometry_world.inverse()));
  }
  return objects;
}

}  // namespace stillmap
