// SPDX-License-Identifier: Apache-2.0
// A rendered scene as RGB-D and as stereo pairs.
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/cli_fixture.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;

class StereoRun : public Cli {
 protected:
  // The report of a run on the scene, of which every frame must be tracked.
  [[nodiscard]] nlohmann::json report_of_run(const std::string& options) const {
    const Outcome outcome = run("run office --out out " + options);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    nlohmann::json report = nlohmann::json::parse(content("out/report.json"));
    EXPECT_EQ(report["frames"]["tracked"], kFrames) << options;
    return report;
  }
  [[nodiscard]] double ate_of_run(const std::string& options) const {
    return report_of_run(options)["ate"]["rmse"];
  }

  // The true poses of the stereo sequence, ten times as far from the origin.
  [[nodiscard]] std::string ten_times_as_far() const {
    std::istringstream rows(content("office/mav0/state_groundtruth_estimate0/data.csv"));
    std::string result, row;
    std::getline(rows, result);
    result += "\n";
    while (std::getline(rows, row)) {
      std::istringstream columns(row);
      std::string column;
      for (int i = 0; std::getline(columns, column, ','); ++i) {
        const bool position = i >= 1 && i <= 3;
        result += (i > 0 ? "," : "") + (position ? std::to_string(10 * std::stod(column)) : column);
      }
      result += "\n";
    }
    return result;
  }

  static constexpr int kFrames = 40;
};

// People walk through the scene; their masks are the same for both.
TEST_F(StereoRun, IsNearlyAsGoodAsRgbd) {
  ASSERT_EQ(run("synth office --scene walking_xyz --frames 40 --size 320x240 --assets none "
                "--detections imperfect --stereo 0.1")
                .exit_code,
            0);
  const std::string objects = "--segmenter detections:office/detections ";
  const double rgbd_m = ate_of_run(objects), stereo_m = ate_of_run(objects + "--format euroc");
  EXPECT_LT(stereo_m, 2 * rgbd_m);
  EXPECT_LT(stereo_m, 0.02);
  // The noise of stereo is where the settings begin; others that are given come before it.
  EXPECT_THAT(content("out/config.yaml"), HasSubstr("inverse_depth_sigma: 0.037"));
  (void)ate_of_run(objects + "--format euroc --set measurement.inverse_depth_sigma=0.02");
  EXPECT_THAT(content("out/config.yaml"), HasSubstr("inverse_depth_sigma: 0.02 "));
}

// With ten times the baseline the same images show a scene ten times as large, which is tracked
// with ten times the error.
TEST_F(StereoRun, MayBeOfALargeScene) {
  ASSERT_EQ(run("synth office --scene empty --frames 40 --size 320x240 --assets none --stereo 0.1")
                .exit_code,
            0);
  const double near_m = ate_of_run("--format euroc");
  std::string right = content("office/mav0/cam1/sensor.yaml");
  right.replace(right.find("0, 0, 0.1, 0"), 12, "0, 0, 1.0, 0");
  write("office/mav0/cam1/sensor.yaml", right);
  write("office/mav0/state_groundtruth_estimate0/data.csv", ten_times_as_far());
  EXPECT_LT(ate_of_run("--format euroc"), 15 * near_m);
}

}  // namespace
}  // namespace stillmap
