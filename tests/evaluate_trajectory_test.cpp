// SPDX-License-Identifier: Apache-2.0
// `stillmap evaluate trajectory` and its options, on trajectories whose errors are known.
#include <cmath>

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/cli_fixture.hpp"

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class EvaluateTrajectory : public Cli {
 protected:
  // A circle of radius 1 m in 10 s, 20 poses a second, `late_s` late and `scale` times as large;
  // the camera never turns.
  [[nodiscard]] static std::string circle(double late_s, double scale, int every = 1) {
    std::string text;
    for (int i = 0; i < 200; i += every) {
      const double angle = 2 * 3.14159265358979 * i / 200;
      text += fmt::format("{:.3f} {:.9f} {:.9f} 0 0 0 0 1\n",
                          100 + 0.05 * i + late_s,
                          scale * std::cos(angle),
                          scale * std::sin(angle));
    }
    return text;
  }

  [[nodiscard]] nlohmann::json figures(const std::string& arguments) const {
    const Outcome outcome = run("evaluate trajectory --json " + arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
};

TEST_F(EvaluateTrajectory, TakesOffsetAndDifference) {
  write("gt.txt", circle(0, 1));
  write("late.txt", circle(3.5, 1));
  expect_refused("evaluate trajectory gt.txt late.txt --offset -3.475", "within 0.02 s");
  EXPECT_LT(figures("gt.txt late.txt --offset -3.5")["ate"]["rmse"], 1e-6);
  write("off.txt", circle(0.024, 1));
  expect_refused("evaluate trajectory gt.txt off.txt", "fewer than 3 poses");
  EXPECT_EQ(figures("gt.txt off.txt --max-diff 0.025")["ate"]["pairs"], 200);
  expect_refused("evaluate trajectory gt.txt off.txt --max-diff 0", "--max-diff");
}

TEST_F(EvaluateTrajectory, ScalesTheEstimate) {
  write("gt.txt", circle(0, 1));
  write("small.txt", circle(0, 0.8));
  // A circle of another radius keeps its center: every error is the difference of the radii.
  EXPECT_NEAR(figures("gt.txt small.txt")["ate"]["rmse"], 0.2, 1e-6);
  EXPECT_NEAR(figures("gt.txt small.txt --scale 1.1")["ate"]["rmse"], 0.12, 1e-6);
  const nlohmann::json fitted = figures("gt.txt small.txt --scale fit");
  EXPECT_LT(fitted["ate"]["rmse"], 1e-6);
  EXPECT_LT(fitted["rpe"]["trans"]["rmse"], 1e-6);
  EXPECT_NEAR(fitted["scale"], 1.25, 1e-6);
  expect_refused("evaluate trajectory gt.txt small.txt --scale -1", "positive number or 'fit'");
}

TEST_F(EvaluateTrajectory, WarnsOfEqualStamps) {
  write("gt.txt", circle(0, 1));
  write("twice.txt", circle(0, 1) + circle(0, 1).substr(0, 84));
  const Outcome outcome = run("evaluate trajectory gt.txt twice.txt");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("twice.txt: 2 poses have the stamp of a later line"));
  EXPECT_THAT(run("evaluate trajectory gt.txt gt.txt").err, IsEmpty());
}

TEST_F(EvaluateTrajectory, WarnsOfGroundTruthTooSparseForRpe) {
  write("gt.txt", circle(0, 1, 4));  // five a second
  write("est.txt", circle(0, 1));
  const Outcome outcome = run("evaluate trajectory gt.txt est.txt");
  EXPECT_THAT(outcome.err, HasSubstr("gt.txt: too few poses for RPE"));
  const Outcome asked = run("evaluate trajectory gt.txt est.txt --interpolate --json");
  EXPECT_THAT(asked.err, IsEmpty());
  const double without = figures("gt.txt est.txt")["rpe"]["trans"]["rmse"];
  const double with = nlohmann::json::parse(asked.out)["rpe"]["trans"]["rmse"];
  EXPECT_GT(without, 0.01);
  // Chords of 0.2 s are at most 1 - cos(0.02 pi) = 2 mm from the circle.
  EXPECT_LT(with, 0.004);
}

TEST_F(EvaluateTrajectory, ReadsEurocAndKitti) {
  std::string euroc = "#timestamp [ns],p_RS_R_x [m],...\n", kitti, tum;
  for (int i = 0; i < 50; ++i) {
    const double x = 0.1 * i, y = 0.01 * i * i;
    euroc += fmt::format("{},{},{},0,1,0,0,0,0,0,0\n", 100000000LL * i, x, y);
    kitti += fmt::format("1 0 0 {} 0 1 0 {} 0 0 1 0\n", x, y);
    tum += fmt::format("{} {} {} 0.5 0 0 0 1\n", 0.1 * i, x, y);
  }
  write("data.csv", euroc);
  write("00.txt", kitti);
  write("tum.txt", tum);
  for (const char* pair : {"data.csv tum.txt", "00.txt tum.txt", "data.csv 00.txt"}) {
    const nlohmann::json json = figures(pair);
    EXPECT_EQ(json["ate"]["pairs"], 50) << pair;
    EXPECT_LT(json["ate"]["rmse"], 1e-9) << pair;
    EXPECT_LT(json["rpe"]["trans"]["rmse"], 1e-9) << pair;
  }
}

}  // namespace
}  // namespace stillmap
