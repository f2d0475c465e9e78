// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/sequence.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/scene/office.hpp"

namespace stillmap {
namespace {

std::shared_ptr<const World> furnished_world(const SyntheticOptions& options) {
  World world = make_office(options.seed);
  add_people(world, options.activity, options.seed);
  return std::make_shared<const World>(std::move(world));
}

// Below these nobody would say that a thing or a person moves: breathing, swaying.
constexpr double kStillThing = 0.005;  // m/s
constexpr double kStillJoint = 0.05;

ObjectMotion thing_motion(const Thing& thing,
                          const Eigen::Isometry3d& before,
                          const Eigen::Isometry3d& after,
                          double duration_s) {
  // Its farthest corner moves fastest.
  double fastest = 0;
  for (const Eigen::Vector3f& corner : thing.mesh.positions) {
    const Eigen::Vector3d p = corner.cast<double>();
    fastest = std::max(fastest, (after * p - before * p).norm());
  }
  const double speed = (after.translation() - before.translation()).norm() / duration_s;
  return {thing.id, speed, fastest / duration_s > kStillThing};
}

ObjectMotion person_motion(const Person& person,
                           const BodyPose& before,
                           const BodyPose& after,
                           double duration_s) {
  const std::array<Eigen::Isometry3d, kJoints> from = person.body.T_world_joints(before);
  const std::array<Eigen::Isometry3d, kJoints> to = person.body.T_world_joints(after);
  double fastest = 0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kJoints; ++k) {
    const Eigen::Vector3d step = to[k].translation() - from[k].translation();
    fastest = std::max(fastest, step.norm());
    mean += step / kJoints;
  }
  return {person.id, mean.norm() / duration_s, fastest / duration_s > kStillJoint};
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
  Stamp stamp;
  stamp.text = fmt::format("{:.6f}", kStart + time_s(id));
  stamp.seconds = std::strtod(stamp.text.c_str(), nullptr);  // the number that a reader would get
  return stamp;
}

Eigen::Isometry3d SyntheticSequence::pose(FrameId id) const {
  return T_world_camera(options_.path, time_s(id));
}

WorldState SyntheticSequence::state(FrameId id) const {
  return choreography_.at(time_s(id));
}

Exposure SyntheticSequence::exposure(FrameId id) const {
  const double middle = time_s(id), half = 0.5 * options_.sensor.exposure_s;
  const double open = std::max(0.0, middle - half), close = middle + half;
  return {T_world_camera(options_.path, middle),
          T_world_camera(options_.path, open),
          T_world_camera(options_.path, close),
          choreography_.at(open),
          choreography_.at(close)};
}

SyntheticFrame SyntheticSequence::render(FrameId id) const {
  STILLMAP_CHECK(id.index() < size());
  const RenderedImage perfect = renderer_.render(exposure(id));
  const RgbdImage measured =
      apply_sensor(perfect, options_.camera, options_.sensor, options_.seed, id);
  RgbdFrame frame;
  frame.id = id;
  frame.stamp = stamp(id);
  frame.depth_stamp_s = frame.stamp.seconds;
  frame.color = measured.color;
  frame.depth = measured.depth;
  cv::cvtColor(measured.color.mat, frame.gray.mat, cv::COLOR_RGB2GRAY);
  return {std::make_shared<const RgbdFrame>(std::move(frame)), perfect.depth, perfect.ids};
}

Trajectory SyntheticSequence::ground_truth() const {
  Trajectory trajectory;
  trajectory.reserve(size());
  for (std::uint32_t i = 0; i < size(); ++i) {
    trajectory.push_back({stamp(FrameId(i)), pose(FrameId(i))});
  }
  return trajectory;
}

std::vector<ObjectMotion> SyntheticSequence::motions(FrameId id) const {
  const double step = 0.5 / options_.frames_per_second;
  const double from = std::max(0.0, time_s(id) - step), to = time_s(id) + step;
  const WorldState before = choreography_.at(from), after = choreography_.at(to);
  std::vector<ObjectMotion> motions;
  for (std::size_t i = 0; i < world_->things.size(); ++i) {
    const Thing& thing = world_->things[i];
    if (thing.id == 0) continue;
    motions.push_back(
        thing_motion(thing, before.T_world_things[i], after.T_world_things[i], to - from));
  }
  for (std::size_t i = 0; i < world_->people.size(); ++i) {
    motions.push_back(
        person_motion(world_->people[i], before.people[i], after.people[i], to - from));
  }
  return motions;
}

}  // namespace stillmap
