// SPDX-License-Identifier: Apache-2.0
// Growth of the map where the camera sees nothing new: it goes through a rendered room and back.
#include <algorithm>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "stillmap/concurrency/stage_probe.hpp"
#include "stillmap/perception/objects/object_tracker.hpp"
#include "stillmap/session/session.hpp"
#include "stillmap/session/system_config.hpp"
#include "stillmap/slam/map/map.hpp"
#include "stillmap/system/prepared_frame.hpp"
#include "stillmap/system/system.hpp"
#include "tests/support/rendered_room.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/eval/map_quality.hpp"

namespace stillmap {
namespace {

std::uint32_t at_step(std::uint32_t step) {
  const std::uint32_t at = step % (2 * (kRoomFrames - 1));
  return at < kRoomFrames ? at : 2 * (kRoomFrames - 1) - at;
}

/// The surfaces that the camera has seen, in the coordinates of the first camera.
MapTruth truth() {
  const cv::Mat2f rays = pixel_rays(empty_room().camera());
  PointCloud surface;
  for (std::uint32_t k = 0; k < kRoomFrames; k += 5) {
    const Eigen::Isometry3d T = empty_room().pose(0).inverse() * empty_room().pose(k);
    const SyntheticFrame rendered = empty_room().sequence().render(FrameId(k));
    const cv::Mat1f& depth = rendered.truth.depth.mat;
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const double z = depth(v, u);
        if (!(z > 0 && z < 4)) continue;
        const Eigen::Vector3d p(rays(v, u)[0] * z, rays(v, u)[1] * z, z);
        surface.positions.push_back((T * p).cast<float>());
        surface.colors.push_back({});
      }
    }
  }
  return {surface, {}};
}

struct Outcome {
  int inserted = 0;  ///< key frames, also those culled since
  std::size_t views = 0;
  double views_mb = 0;
  double ate_m = 0;
  MapQuality map;
};

Outcome go(std::uint32_t ways, const SystemConfig& config) {
  System system(config, empty_room().camera(), {.threads = 1});
  Outcome outcome;
  Trajectory ground_truth;
  for (std::uint32_t step = 0; step < ways * kRoomFrames; ++step) {
    const std::uint32_t k = at_step(step);
    RgbdFrame frame = *empty_room().frame(k);
    frame.id = FrameId(step);
    frame.stamp = {1000 + step / 30.0, fmt::format("{:.6f}", 1000 + step / 30.0)};
    ground_truth.push_back({frame.stamp, empty_room().pose(k)});
    const FrameResult result = system.process(std::make_shared<const RgbdFrame>(std::move(frame)));
    outcome.inserted += result.is_keyframe ? 1 : 0;
  }
  const RunResult result = system.finish();
  const std::optional<AteResult> ate = absolute_trajectory_error(ground_truth, result.trajectory);
  outcome.ate_m =
      ate && result.trajectory.size() == ways * kRoomFrames ? ate->translation_m.rmse : 1;
  static const MapTruth kTruth = truth();
  outcome.map = map_quality(result.map, kTruth);
  const Session session = system.take_session();
  outcome.views = session.views.size();
  for (const ViewRecord& record : session.views)
    outcome.views_mb += static_cast<double>(record.view->bytes()) / 1e6;
  fmt::print(
      "{} ways: {} key frames inserted, {} views of {:.2f} MB, ATE {:.4f} m, sa {:.4f}, {:.4f} m\n",
      ways,
      outcome.inserted,
      outcome.views,
      outcome.views_mb,
      outcome.ate_m,
      outcome.map.sa,
      outcome.map.accuracy_m.value_or(1));
  return outcome;
}

SystemConfig settings() {
  SystemConfig config;
  config.dynamics.mode = "full";
  // The sequence is short, so places must count as known sooner than by default.
  config.cloud.views.enough = 8;
  config.keyframe.known_observers = 8;
  config.keyframe.max_known_share = 0.55;
  return config;
}

const Outcome& early() {
  static const Outcome kEarly = go(4, settings());
  return kEarly;
}

constexpr std::uint32_t kWays = 10;

const Outcome& late() {
  static const Outcome kLate = go(kWays, settings());
  return kLate;
}

TEST(Growth, ViewsStayAsManyWhereNothingNewIsSeen) {
  EXPECT_LE(late().views, early().views + 12);
  SystemConfig all = settings();
  all.cloud.views.enough = 0;
  const Outcome with_all = go(kWays, all);
  EXPECT_GT(with_all.views, early().views + 60);
  // The map is about as good without the additional views, whose mean has a little less noise.
  EXPECT_GT(late().map.sa, with_all.map.sa - 0.002);
  EXPECT_LT(*late().map.accuracy_m, *with_all.map.accuracy_m + 0.001);
}

TEST(Growth, APlaceHasABoundedNumberOfViews) {
  SystemConfig bounded = settings();
  bounded.cloud.views.enough = 1000;  // so that none is ever known well
  bounded.cloud.views.most = 60;
  const Outcome outcome = go(kWays, bounded);
  EXPECT_LE(outcome.views, 80U) << "162 without a bound; some see less than half of others";
  EXPECT_GT(outcome.map.sa, early().map.sa - 0.002);
  EXPECT_LT(*outcome.map.accuracy_m, 1.1 * *early().map.accuracy_m);
}

TEST(Growth, ViewsTakeNoMoreMemoryThanTheyMay) {
  SystemConfig bounded = settings();
  bounded.cloud.views.most_mb = early().views_mb / 2;
  const Outcome outcome = go(4, bounded);
  EXPECT_LE(outcome.views_mb, early().views_mb / 2);
  EXPECT_GT(outcome.views_mb, early().views_mb / 3);
  EXPECT_GT(outcome.map.sa, early().map.sa - 0.01);
}

TEST(Growth, KeyFramesDoNotComeOnlyToGoAgain) {
  SystemConfig always = settings();
  always.keyframe.max_known_share = 1;
  const Outcome with_all = go(kWays, always);
  EXPECT_GT(with_all.inserted - early().inserted, 2 * (late().inserted - early().inserted));
  EXPECT_LT(late().ate_m, 1.1 * with_all.ate_m);
}

}  // namespace
}  // namespace stillmap
