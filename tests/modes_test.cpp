// SPDX-License-Identifier: Apache-2.0
// Whole modes on rendered frames, and the constants of mode `paper`.
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/session/system_config.hpp"
#include "tests/support/cli_fixture.hpp"
#include "tests/support/files.hpp"

namespace stillmap {
namespace {

using nlohmann::json;

// Fan 2020: tau1 = 5000 pixels, tau2 = 5000 units = 1 m, tau3 = 500 units = 0.1 m, tau4 = 1000
// pixels, tau5 = 0.5 pixels, 30000 units = 6 m; three scaled MADs; three frames each way.
TEST(PaperMode, HasTheConstantsOfTheArticle) {
  SystemConfig config;
  config.dynamics.mode = "paper";
  const DynamicObjectsConfig& objects = config.dynamics.objects;
  EXPECT_EQ(objects.extension.whole_box_px, 5000);
  EXPECT_EQ(objects.extension.mad_factor, 3.0);
  EXPECT_EQ(objects.jump.paper_jump_m, 1.0);
  EXPECT_EQ(config.dynamics.features.depth_stability.mad_factor, 3.0);
  EXPECT_EQ(config.dynamics.features.static_matches.epipolar_px, 0.5);
  EXPECT_EQ(config.dynamics.features.static_matches.min_parallax_px, 0.0);
  EXPECT_FALSE(config.dynamics.features.static_matches.motion_check);
  EXPECT_EQ(config.dynamics.object_tracking().search_frames, 3);
  EXPECT_EQ(config.dynamics.object_tracking().min_sightings, 1);
  EXPECT_EQ(config.cloud.depth.edge.step_m, 0.1);
  EXPECT_NEAR(config.cloud.depth.min_island_share * 640 * 480, 1000, 1e-9);
  EXPECT_EQ(config.cloud.depth.max_depth_m, 6.0);
  for (const bool stage : {objects.extension.enabled,
                           objects.interaction.enabled,
                           objects.jump.enabled,
                           config.dynamics.fill_boxes,
                           config.dynamics.features.depth_stability.enabled,
                           config.dynamics.features.static_matches.enabled}) {
    EXPECT_TRUE(stage);
  }
}

/// Two people walk through the office while a camera with a quarter of the pixels moves.
class Modes : public Cli {
 protected:
  [[nodiscard]] json report(const std::string& mode) const {
    const std::string office = this->office().string();
    const Outcome outcome = run("run " + office + " --out out --segmenter detections:" + office +
                                "/detections --dynamics " + mode);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return json::parse(content("out/report.json"));
  }
  [[nodiscard]] const json& report_of_off() const {
    static const json kReport = report("off");
    return kReport;
  }
  [[nodiscard]] static double ate_m(const json& report) { return report["ate"]["rmse"]; }

 private:
  // Rendered once for all tests.
  [[nodiscard]] std::filesystem::path office() const {
    static const TemporaryFolder kFolder;
    static const Outcome kRendered = run("synth " + (kFolder.path() / "office").string() +
                                         " --scene walking_xyz --frames 90 --size 320x240 "
                                         "--assets none --detections imperfect");
    EXPECT_EQ(kRendered.exit_code, 0) << kRendered.err;
    return kFolder.path() / "office";
  }
};

TEST_F(Modes, PaperKeepsPeopleOutOfPoseAndMap) {
  const json &off = report_of_off(), paper = report("paper");
  EXPECT_EQ(paper["frames"]["ratio"], 1.0);
  EXPECT_LT(ate_m(paper), 0.009);
  EXPECT_GT(ate_m(off), 1.4 * ate_m(paper));
  EXPECT_LT(off["map"]["da"], 0.1);
  EXPECT_GT(paper["map"]["da"], 0.95);
  EXPECT_GT(paper["map"]["sa"], 0.88);
  // There are people in all frames but the first, which has none before it.
  EXPECT_GE(paper["dynamics"]["matches_judged_by"]["fundamental matrix"], 85);
}

TEST_F(Modes, ThePeersKeepPeopleOutOfThePose) {
  const json& off = report_of_off();
  for (const char* mode : {"ds-slam", "dynaslam"}) {
    const json peer = report(mode);
    EXPECT_EQ(peer["frames"]["ratio"], 1.0) << mode;
    EXPECT_LT(ate_m(peer), 0.9 * ate_m(off)) << mode;
    EXPECT_GT(peer["map"]["da"], 0.15) << mode;
  }
}

}  // namespace
}  // namespace stillmap
