// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/motion/motion_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/perception/objects/boxes.hpp"
#include "stillmap/perception/objects/object_look.hpp"

namespace stillmap {
namespace {

constexpr double kForgetAfter_s = 2.0;
constexpr double kLongestGap_s = 0.5;

double lower_median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The median column or row of a histogram.
int median_place(const std::vector<int>& counts, int total) {
  int before = 0, place = 0;
  while (before + counts[static_cast<std::size_t>(place)] <= (total - 1) / 2) {
    before += counts[static_cast<std::size_t>(place++)];
  }
  return place;
}

/// The middle of the pixels of an id with depths in the interval; nothing where there are none.
std::optional<Eigen::Vector2d> middle_pixel(const ObjectMask& mask,
                                            int id,
                                            const cv::Rect& area,
                                            const DepthImage& depth,
                                            DepthInterval of) {
  std::vector<int> columns(static_cast<std::size_t>(area.width), 0);
  std::vector<int> rows(static_cast<std::size_t>(area.height), 0);
  int total = 0;
  for (int v = 0; v < area.height; ++v) {
    const std::uint8_t* ids = mask.mat[area.y + v] + area.x;
    const float* z = depth.mat[area.y + v] + area.x;
    int in_row = 0;
    for (int u = 0; u < area.width; ++u) {
      const int hit = ids[u] == id && of.contains(z[u]) ? 1 : 0;
      columns[static_cast<std::size_t>(u)] += hit;
      in_row += hit;
    }
    rows[static_cast<std::size_t>(v)] = in_row;
    total += in_row;
  }
  if (total == 0) return std::nullopt;
  return Eigen::Vector2d(area.x + median_place(columns, total), area.y + median_place(rows, total));
}

bool reaches_border(const PixelBox& box, cv::Size image) {
  return box.x0 < 2 || box.y0 < 2 || box.x1 > image.width - 2 || box.y1 > image.height - 2;
}

}  // namespace

RobustVelocity robust_velocity(std::span<const double> stamps_s,
                               std::span<const Eigen::Vector3d> positions,
                               double least_noise_m) {
  const std::size_t n = positions.size();
  STILLMAP_CHECK(n >= 2 && stamps_s.size() == n);
  RobustVelocity result;
  double spread = 0, scatter = 0;  // sums of squares: stamps, and positions about the line
  const double middle_s = (stamps_s.front() + stamps_s.back()) / 2;
  for (const double stamp : stamps_s) spread += (stamp - middle_s) * (stamp - middle_s);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> slopes;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = i + (n + 1) / 2; j < n; ++j) {  // near ones differ mostly by noise
        slopes.push_back((positions[j][axis] - positions[i][axis]) / (stamps_s[j] - stamps_s[i]));
      }
    }
    const double slope = lower_median(slopes);
    std::vector<double> rests, sizes;
    for (std::size_t i = 0; i < n; ++i) {
      rests.push_back(positions[i][axis] - slope * (stamps_s[i] - middle_s));
    }
    const double offset = lower_median(rests);
    for (const double rest : rests) sizes.push_back(std::abs(rest - offset));
    const double deviation = 1.4826 * lower_median(sizes);
    scatter += deviation * deviation;
    result.velocity[axis] = slope;
  }
  const double noise = std::max(std::sqrt(scatter), least_noise_m);
  result.error = noise / std::sqrt(spread);
  return result;
}

MotionEstimator::MotionEstimator(const MotionStateConfig& config, const CameraModel& camera)
    : config_(config), camera_(camera) {}

MotionEstimator::Track& MotionEstimator::track_of(TrackId id) {
  const auto place = std::ranges::lower_bound(tracks_, id, {}, &Track::id);
  if (place != tracks_.end() && place->id == id) return *place;
  Track fresh;
  fresh.id = id;
  return *tracks_.insert(place, std::move(fresh));
}

std::optional<MotionEstimator::Position> MotionEstimator::position_of(
    const View& view, const TrackedObject& object, const ObjectState& state) const {
  if (!state.depths || view.objects.mask.mat.empty()) return std::nullopt;
  const cv::Rect area = pixels_of(object.detection.box, view.depth.mat.size());
  const std::optional<Eigen::Vector2d> pixel =
      middle_pixel(view.objects.mask, object.detection.id, area, view.depth, *state.depths);
  if (!pixel) return std::nullopt;
  const Eigen::Vector2d ideal_px = camera_.undistort(*pixel);
  if (!camera_.has_ray(ideal_px)) return std::nullopt;
  const auto z = static_cast<double>(state.median_depth_m);
  const Eigen::Vector3d p_camera = camera_.unproject(ideal_px, z);
  return Position{view.objects.stamp.seconds,
                  view.T_world_camera * p_camera,
                  config_.depth_noise_per_m * z * z,
                  surface_of(view, object, state)};
}

std::vector<Eigen::Vector3d> MotionEstimator::surface_of(const View& view,
                                                         const TrackedObject& object,
                                                         const ObjectState& state) const {
  const DetectedObject& detection = object.detection;
  const cv::Rect area = pixels_of(detection.box, view.depth.mat.size());
  const ObjectView pixels{view.depth, view.objects.mask, detection.id, detection.box};
  std::vector<Eigen::Vector3d> points;
  for_each_sample(pixels, area, *state.depths, [&](int row, int x, float z) {
    points.push_back(view.T_world_camera *
                     camera_.unproject(camera_.undistort({x, row}), static_cast<double>(z)));
  });
  return points;
}

double MotionEstimator::vacated(const Position& old, const View& view, int id) const {
  const Eigen::Isometry3d T_camera_world = view.T_world_camera.inverse();
  int there = 0, gone = 0;
  for (const Eigen::Vector3d& p_world : old.surface) {
    const Eigen::Vector3d p = T_camera_world * p_world;
    if (!(p.z() > 0.01)) continue;
    const Eigen::Vector2d pixel = camera_.distort(camera_.project(p));
    const int x = static_cast<int>(std::lround(pixel.x()));
    const int row = static_cast<int>(std::lround(pixel.y()));
    if (x < 0 || row < 0 || x >= camera_.width_px || row >= camera_.height_px) continue;
    const float z = view.depth.mat(row, x);
    if (!(z > 0)) continue;
    const double change = static_cast<double>(z) - p.z();
    const double noise = 3 * config_.depth_noise_per_m * p.z() * p.z();
    const bool same = std::abs(change) <= config_.vacated_m + noise;
    there += same ? 1 : 0;
    // Nearer depth hides the surface, unless the object itself came nearer.
    if (!same && (change > 0 || view.objects.mask.mat(row, x) == id)) ++gone;
  }
  return gone == 0 ? 0.0 : static_cast<double>(gone) / (gone + there);
}

void MotionEstimator::decide(Track& track, bool cut_off, double vacated_share) const {
  const double speed = track.velocity.velocity.norm();
  const double factor = cut_off ? config_.border_factor : 1.0;
  const double error = config_.certainty * track.velocity.error;
  const bool left = vacated_share >= config_.vacated_share;
  track.known = true;
  track.has_left = track.has_left || left;
  ++track.stood;
  if (left && speed > factor * config_.moving_m_s + error) {
    track.moving = true;
    track.calm = 0;
  } else if (left && speed > factor * config_.still_m_s + error) {
    track.calm = 0;
  } else if (++track.calm >= config_.calm_frames) {
    track.moving = false;
  }
}

RobustVelocity MotionEstimator::velocity_of(const Track& track) const {
  std::vector<double> stamps;
  std::vector<Eigen::Vector3d> places;
  for (const Position& position : track.positions) {
    stamps.push_back(position.stamp_s);
    places.push_back(position.p_world);
  }
  return robust_velocity(stamps, places, track.positions.back().noise_m);
}

void MotionEstimator::add_position(Track& track, Position position) const {
  // After a long time out of sight the path to this position is unknown.
  const double last_s = track.positions.empty() ? position.stamp_s : track.positions.back().stamp_s;
  if (position.stamp_s - last_s > kLongestGap_s) track.positions.clear();
  track.positions.push_back(std::move(position));
  while (track.positions.size() > static_cast<std::size_t>(config_.window_frames)) {
    track.positions.pop_front();
  }
}

Motion MotionEstimator::motion_of(const Track& track, const ObjectState& state) const {
  Motion motion;
  motion.velocity_m_s = track.velocity.velocity;
  motion.velocity_error_m_s = track.velocity.error;
  if (!track.known) return motion;
  motion.state = track.moving ? MotionState::kMoving : MotionState::kStill;
  const bool touched =
      state.reason == StateReason::kTouching || state.reason == StateReason::kDepthUnknown;
  if (track.moving && touched) {
    motion.state = MotionState::kMovedBySomeone;
    motion.by = state.person;
  }
  return motion;
}

std::vector<Motion> MotionEstimator::update(const FrameObjects& objects,
                                            const DepthImage& depth,
                                            std::span<const ObjectState> states,
                                            const Eigen::Isometry3d& T_world_camera) {
  STILLMAP_CHECK(states.size() == objects.objects.size());
  const double now = objects.stamp.seconds;
  std::erase_if(tracks_, [now](const Track& t) { return now - t.last_seen_s > kForgetAfter_s; });
  const View view{objects, depth, T_world_camera};
  const auto enough = static_cast<std::size_t>(config_.min_frames);
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const TrackedObject& object = objects.objects[i];
    Track& track = track_of(object.track);
    track.last_seen_s = now;
    std::optional<Position> position = position_of(view, object, states[i]);
    std::optional<Eigen::Vector3d> p_world;
    if (position) p_world = position->p_world;
    if (position && !object.filled) {
      add_position(track, *std::move(position));
      if (track.positions.size() >= enough) {
        track.velocity = velocity_of(track);
        const bool cut_off = reaches_border(object.detection.box, depth.mat.size());
        decide(track, cut_off, vacated(track.positions.front(), view, object.detection.id));
      }
    }
    motions.push_back(motion_of(track, states[i]));
    motions.back().p_world = p_world;
  }
  return motions;
}

std::vector<TrackId> MotionEstimator::moving() const {
  std::vector<TrackId> ids;
  for (const Track& track : tracks_) {
    if (track.moving) ids.push_back(track.id);
  }
  return ids;
}

std::vector<TrackId> MotionEstimator::standing() const {
  std::vector<TrackId> ids;
  for (const Track& track : tracks_) {
    if (!track.has_left && track.stood >= config_.standing_frames) ids.push_back(track.id);
  }
  return ids;
}

}  // namespace stillmap
