// SPDX-License-Identifier: Apache-2.0
#include "stillmap/session/session_cloud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillmap/core/error.hpp"
#include "stillmap/geometry/se3.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

// Key frame 0 is in submap 0 at x = 10, key frame 1 in submap 4; a frame and a view of each, with
// one point a metre before the camera.
Session two_submaps(const std::string& config_yaml) {
  Session session{builtin_camera("tum_fr3"), config_yaml, Map({1.0F}), {}, {}, {}};
  for (const std::uint32_t k : {0U, 1U}) {
    Keyframe keyframe;
    keyframe.submap = SubmapId(4 * k);
    keyframe.T_world_camera = Eigen::Isometry3d(Eigen::Translation3d(10 - 3.0 * k, 0, 0));
    keyframe.features = std::make_shared<const Features>();
    session.map.add_keyframe(std::move(keyframe));
    session.frames.push_back(
        {{1.0 * k, ""}, KeyframeId(k), Eigen::Isometry3d(Eigen::Translation3d(0, 0.5, 0))});
    StaticView view;
    view.cloud.origin = {0, 0, 1};
    view.cloud.places = {{0, 0, 0}};
    view.cloud.colors = {{1, 2, 3}};
    session.views.push_back({k, std::make_shared<const StaticView>(view)});
  }
  return session;
}

TEST(SessionCloud, HasTheViewsOfOneSubmapWhereTheyStand) {
  const Session session = two_submaps("dynamics:\n  mode: off\n");
  const PointCloud of_0 = session_cloud(session, SubmapId(0), "x");
  ASSERT_EQ(of_0.size(), 1U);
  EXPECT_TRUE(of_0.positions[0].isApprox(Eigen::Vector3f(10, 0.5F, 1), 1e-5F));
  EXPECT_EQ(of_0.colors[0], (Rgb{1, 2, 3}));
  const PointCloud of_4 = session_cloud(session, SubmapId(4), "x");
  ASSERT_EQ(of_4.size(), 1U);
  EXPECT_TRUE(of_4.positions[0].isApprox(Eigen::Vector3f(7, 0.5F, 1), 1e-5F));
  EXPECT_TRUE(session_cloud(session, SubmapId(1), "x").empty());
}

// A map that an earlier version saved, with settings that are gone.
TEST(SessionCloud, SettingsOfAnotherVersionAreSkipped) {
  const Session session = two_submaps(
      "tracking:\n  shutter:\n    min_readout_s: 0.01\n    calibrate: false\n"
      "gone:\n  list: [1, {a: 2}]\n  deep:\n    deeper: x\ncloud:\n  free_space: 'off'\n  "
      "voxel_size_m: 0.25\n");
  const SystemConfig settings = settings_of(session, "x");
  EXPECT_EQ(settings.cloud.voxel_size_m, 0.25);
  EXPECT_FALSE(settings.tracking.shutter.calibrate);
  EXPECT_EQ(session_cloud(session, SubmapId(0), "x").size(), 1U);
}

TEST(SessionCloud, SettingsAreTheSessions) {
  EXPECT_EQ(settings_of(two_submaps("cloud:\n  voxel_size_m: 0.25\n"), "x").cloud.voxel_size_m,
            0.25);
  const auto problem = [](const std::string& yaml) -> std::string {
    try {
      (void)session_cloud(two_submaps(yaml), SubmapId(0), "a.stillmap");
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(problem("cloud:\n  voxel_size_m: thin\n"), HasSubstr("a.stillmap: settings:2: "));
  EXPECT_THAT(problem("cloud:\n  free_space: 'on'\n"),
              HasSubstr("a.stillmap: invalid view of frame 0"));
}

}  // namespace
}  // namespace stillmap
