// SPDX-License-Identifier: Apache-2.0
// Accuracy on a real sequence, where it is there: 12 s of TUM's freiburg1_xyz.
#include <gtest/gtest.h>

#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/sequence_stream.hpp"
#include "tests/support/shared_data.hpp"
#include "tooling/eval/ate.hpp"
#include "tooling/pipeline/run_sequence.hpp"

namespace stillmap {
namespace {

struct Accuracy {
  double ate_m;
  double tracked_ratio;
};

class Freiburg1Xyz : public testing::Test {
 protected:
  void SetUp() override {
    STILLMAP_NEED_SHARED_DATA("tum_fr1_xyz_360");
    folder_ = shared_data("tum_fr1_xyz_360");
  }

  [[nodiscard]] Accuracy measure(const SystemConfig& config, std::size_t stride) const {
    SequenceStream frames(Sequence::open(folder_, {.camera = builtin_camera("tum_fr1")}),
                          {.begin = 0, .end = {}, .stride = stride});
    const SequenceRun run = run_sequence(frames, config, {});
    const auto ate = absolute_trajectory_error(read_trajectory(folder_ / "groundtruth.txt"),
                                               run.result.trajectory);
    return {ate->translation_m.rmse,
            static_cast<double>(run.report.frames_tracked) /
                static_cast<double>(run.report.frames_total)};
  }

  std::filesystem::path folder_;
};

// ORB-SLAM2 has 0.0110 m on these files.
TEST_F(Freiburg1Xyz, ErrorBelowACentimetreAtFullAndHalfFrameRate) {
  for (const std::size_t stride : {1U, 2U}) {
    const Accuracy accuracy = measure({}, stride);
    EXPECT_LE(accuracy.ate_m, 0.010) << "every " << stride << ". frame";
    EXPECT_EQ(accuracy.tracked_ratio, 1.0);
  }
}

TEST_F(Freiburg1Xyz, ErrorGrowsByHalfWithoutTheRollingShutter) {
  SystemConfig without;
  without.tracking.shutter.calibrate = false;
  EXPECT_GT(measure(without, 1).ate_m, 1.5 * measure({}, 1).ate_m);
}

}  // namespace
}  // namespace stillmap
