// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/sequence.hpp"

#include <algorithm>
#include <set>

#include <fmt/core.h>

#include "simulation/scene/office.hpp"
#include "stillmap/core/error.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/stamp_text.hpp"

namespace stillmap {
namespace {

std::shared_ptr<const World> furnished_world(const SyntheticOptions& options) {
  World world = make_office(options.seed, options.assets.get());
  add_people(world, options.activity, options.seed, options.assets.get());
  return std::make_shared<const World>(std::move(world));
}

double mean_distance(const std::vector<Eigen::Vector3f>& a, const std::vector<Eigen::Vector3f>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (b[i] - a[i]).norm();
  return a.empty() ? 0.0 : sum / static_cast<double>(a.size());
}

bool all_in(const std::vector<Person>& people, const std::set<int>& ids) {
  return std::ranges::all_of(people, [&](const Person& p) { return ids.contains(p.id); });
}

}  // namespace

CameraModel synthetic_camera(int width_px, int height_px) {
  const CameraModel original = builtin_camera("tum_fr3");
  const double x_scale = static_cast<double>(width_px) / original.width_px;
  const double y_offset = original.cy + 0.5 - 0.5 * original.height_px;
  CameraModel camera;
  camera.name = "synthetic";
  camera.width_px = width_px;
  camera.height_px = height_px;
  camera.fx = original.fx * x_scale;
  camera.fy = original.fy * x_scale;
  camera.cx = (original.cx + 0.5) * x_scale - 0.5;
  camera.cy = 0.5 * height_px + y_offset * x_scale - 0.5;
  return camera;
}

std::vector<MovableSurface> movable_surfaces(const World& world, const WorldState& state) {
  std::vector<MovableSurface> surfaces;
  for (std::size_t i = 0; i < world.things.size(); ++i) {
    const Thing& thing = world.things[i];
    if (thing.id == 0) continue;
    MovableSurface surface{thing.id, {}};
    surface.p_world.reserve(thing.mesh.positions.size());
    for (const Eigen::Vector3f& p : thing.mesh.positions) {
      surface.p_world.push_back((state.T_world_things[i] * p.cast<double>()).cast<float>());
    }
    surfaces.push_back(std::move(surface));
  }
  for (std::size_t i = 0; i < world.people.size(); ++i) {
    const Person& person = world.people[i];
    surfaces.push_back({person.id, person.body.posed(state.people[i]).positions});
  }
  return surfaces;
}

SyntheticSequence::SyntheticSequence(const SyntheticOptions& options)
    : options_(options),
      world_(furnished_world(options)),
      choreography_(*world_, options.activity),
      renderer_(world_, options.camera, options.render) {
  STILLMAP_CHECK(options.frames_per_second > 0);
}

double SyntheticSequence::time_s(FrameId id) const {
  return id.value / options_.frames_per_second;
}

Stamp SyntheticSequence::stamp(FrameId id) const {
  constexpr double kStart = 1000.0;
  return parse_stamp(fmt::format("{:.6f}", kStart + time_s(id))).value();
}

Stamp SyntheticSequence::depth_stamp(FrameId id) const {
  const ImageDelays& delays = options_.delays;
  const double later_s = delays.depth_stamps_tell ? delays.depth_delay_s : 0;
  return parse_stamp(fmt::format("{:.6f}", stamp(id).seconds + later_s)).value();
}

Eigen::Isometry3d SyntheticSequence::pose(FrameId id) const {
  return T_world_camera(options_.path, time_s(id));
}

WorldState SyntheticSequence::state(FrameId id) const {
  return choreography_.at(time_s(id));
}

CameraExposure SyntheticSequence::camera_exposure(double middle_s) const {
  const double half = 0.5 * options_.sensor.exposure_s;
  return {T_world_camera(options_.path, std::max(0.0, middle_s)),
          T_world_camera(options_.path, std::max(0.0, middle_s - half)),
          T_world_camera(options_.path, std::max(0.0, middle_s + half))};
}

Exposure SyntheticSequence::exposure(double middle_s, double readout_s) const {
  const double half = 0.5 * options_.sensor.exposure_s;
  Exposure exposure{camera_exposure(middle_s),
                    choreography_.at(std::max(0.0, middle_s - half)),
                    choreography_.at(std::max(0.0, middle_s + half))};
  if (readout_s == 0) return exposure;
  const int rows = options_.camera.height_px;
  for (int y = 0; y < rows; ++y) {
    const double row = static_cast<double>(y) / rows - 0.5;
    exposure.rows.push_back(camera_exposure(middle_s + row * readout_s));
  }
  return exposure;
}

SyntheticFrame SyntheticSequence::render(FrameId id) const {
  STILLMAP_CHECK(id.index() < size());
  const ImageDelays& delays = options_.delays;
  const RenderedImage truth = renderer_.render(exposure(time_s(id), 0));
  RenderedImage perfect = truth;
  if (delays.readout_s != 0) perfect = renderer_.render(exposure(time_s(id), delays.readout_s));
  if (!delays.none()) {
    perfect.depth =
        renderer_.depth(exposure(time_s(id) + delays.depth_delay_s, delays.depth_readout_s));
  }
  const RgbdImage measured =
      apply_sensor(perfect, options_.camera, options_.sensor, options_.seed, id);
  RgbdFrame frame;
  frame.id = id;
  frame.stamp = stamp(id);
  frame.depth_stamp_s = depth_stamp(id).seconds;
  frame.color = measured.color;
  frame.depth = measured.depth;
  frame.gray = to_gray(measured.color);
  return {std::make_shared<const RgbdFrame>(std::move(frame)), truth, perfect.ids};
}

ColorImage SyntheticSequence::right_image(FrameId id, double baseline_m) const {
  STILLMAP_CHECK(id.index() < size());
  Exposure moved = exposure(time_s(id), options_.delays.readout_s);
  const Eigen::Translation3d to_the_right(baseline_m, 0, 0);
  const auto move = [&](CameraExposure& camera) {
    for (Eigen::Isometry3d* T :
         {&camera.T_world_camera, &camera.T_world_camera_open, &camera.T_world_camera_close}) {
      *T = *T * to_the_right;
    }
  };
  move(moved);
  for (CameraExposure& row : moved.rows) move(row);
  return apply_second_sensor(renderer_.render(moved).color, options_.sensor, options_.seed, id);
}

Trajectory SyntheticSequence::ground_truth() const {
  Trajectory trajectory;
  trajectory.reserve(size());
  for (std::uint32_t i = 0; i < size(); ++i) {
    trajectory.push_back({stamp(FrameId(i)), pose(FrameId(i))});
  }
  return trajectory;
}

std::vector<ObjectSpeed> SyntheticSequence::speeds(FrameId id) const {
  const double step = 0.5 / options_.frames_per_second;
  const double from = std::max(0.0, time_s(id) - step), to = time_s(id) + step;
  const std::vector<MovableSurface> before = movable_surfaces(*world_, choreography_.at(from));
  const std::vector<MovableSurface> after = movable_surfaces(*world_, choreography_.at(to));
  std::vector<ObjectSpeed> speeds;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double distance = mean_distance(before[i].p_world, after[i].p_world);
    speeds.push_back({before[i].id, distance / (to - from)});
  }
  return speeds;
}

std::vector<int> SyntheticSequence::moved_ids() const {
  std::set<int> moved;
  const WorldState first = state(FrameId(0));
  for (std::uint32_t k = 1; k < size(); ++k) {
    const WorldState now = state(FrameId(k));
    for (std::size_t i = 0; i < world_->things.size(); ++i) {
      const bool stays = now.T_world_things[i].matrix() == first.T_world_things[i].matrix();
      if (!stays) moved.insert(world_->things[i].id);
    }
  }
  for (std::uint32_t k = 0; k < size() && !all_in(world_->people, moved); ++k) {
    for (const ObjectSpeed& object : speeds(FrameId(k))) {
      if (object.speed_mps > kMovingSpeedMps) moved.insert(object.id);
    }
  }
  return {moved.begin(), moved.end()};
}

}  // namespace stillmap
