// SPDX-License-Identifier: Apache-2.0
#include "apps/sensor_camera.hpp"

#include <vector>

#include <fmt/core.h>

#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/depth_unit.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kLookedAt = 5;

// The first depth images of a part of a sequence, as stored. Damaged ones are the run's concern.
std::vector<DepthImage> first_stored_depths(const Sequence& sequence,
                                            const FrameSelection& selection) {
  std::vector<DepthImage> images;
  const std::size_t end = selection.end.value_or(sequence.size());
  for (std::size_t i = selection.begin; i < end && i < sequence.size(); i += selection.stride) {
    if (images.size() == kLookedAt) break;
    try {
      images.push_back(sequence.stored_depth(FrameId(static_cast<std::uint32_t>(i))));
    } catch (const DamagedImage&) {
      continue;
    }
  }
  return images;
}

}  // namespace

SensorCamera sensor_camera(const Sequence& sequence,
                           const FrameSelection& selection,
                           std::optional<double> depth_factor) {
  SensorCamera sensor{sequence.camera(), ""};
  CameraModel& camera = sensor.camera;
  if (!depth_factor && camera.depth_factor_given) return sensor;
  if (!depth_factor) {
    const DepthUnitEvidence evidence =
        depth_unit_evidence(first_stored_depths(sequence, selection));
    depth_factor = evidence.depth_factor();
    if (!depth_factor) {
      throw UnknownDepthUnit(
          "camera '{}' gives no depth_factor, and the depth images do not tell it: half of their "
          "pixels are nearer than {:.2f} m at 1000, {:.2f} m at 5000; give --depth-factor",
          camera.name,
          evidence.median / 1000,
          evidence.median / 5000);
    }
    sensor.depth_unit = fmt::format(
        "camera '{}' gives no depth_factor: {} it is, as half of the depth images' pixels are then "
        "nearer than {:.2f} m",
        camera.name,
        *depth_factor,
        evidence.median / *depth_factor);
  }
  camera.depth_factor = *depth_factor;
  camera.depth_factor_given = true;
  return sensor;
}

}  // namespace stillmap
