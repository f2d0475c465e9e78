// SPDX-License-Identifier: Apache-2.0
#include "stillmap/synth/sequence_writer.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "stillmap/core/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/io_test_support.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/io/tum_sequence.hpp"
#include "stillmap/synth/scene_names.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;

SyntheticSequence short_sequence() {
  SyntheticOptions options;
  options.camera = synthetic_camera(160, 120);
  options.frames = 4;
  options.seed = 9;
  return SyntheticSequence(options);
}

TEST(WriteSequence, IsReadBackAsItWasRendered) {
  const TemporaryFolder folder;
  const SyntheticSequence sequence = short_sequence();
  std::vector<std::size_t> steps;
  write_sequence(sequence, folder.path() / "a" / "b", {}, [&](std::size_t done, std::size_t total) {
    steps.push_back(done);
    EXPECT_EQ(total, 4U);
  });
  EXPECT_EQ(steps, (std::vector<std::size_t>{1, 2, 3, 4}));

  const TumSequence read = TumSequence::open(folder.path() / "a" / "b");
  ASSERT_EQ(read.size(), sequence.size());
  EXPECT_EQ(read.camera().fx, sequence.camera().fx);
  EXPECT_EQ(read.camera().cy, sequence.camera().cy);
  EXPECT_EQ(read.camera().width_px, 160);
  for (std::uint32_t i = 0; i < read.size(); ++i) {
    const FramePtr expected = sequence.frame(FrameId(i)), found = read.read(FrameId(i));
    EXPECT_EQ(found->stamp.text, expected->stamp.text);
    EXPECT_EQ(found->depth_stamp_s, expected->depth_stamp_s);
    EXPECT_EQ(cv::norm(found->color.mat, expected->color.mat, cv::NORM_INF), 0);
    // Stored in fifths of a millimetre.
    EXPECT_LE(cv::norm(found->depth.mat, expected->depth.mat, cv::NORM_INF), 0.000101);
  }
}

TEST(WriteSequence, WritesTheTruth) {
  const TemporaryFolder folder;
  const SyntheticSequence sequence = short_sequence();
  write_sequence(sequence, folder.path());
  const Trajectory read = read_trajectory(folder.path() / "groundtruth.txt");
  ASSERT_EQ(read.size(), 4U);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(read[i].stamp.text, sequence.stamp(FrameId(i)).text);
    const Eigen::Isometry3d error = read[i].T_world_camera.inverse() * sequence.pose(FrameId(i));
    EXPECT_LT(error.translation().norm(), 1e-6);
    EXPECT_LT(rotation_angle(error.linear()), 1e-6);
  }
}

TEST(WriteSequence, HasTheListsOfTheLayout) {
  const TemporaryFolder folder;
  write_sequence(short_sequence(), folder.path());
  const std::string pairs = read_file(folder.path() / "associations.txt", 10000);
  EXPECT_EQ(pairs.substr(0, pairs.find('\n')),
            "1000.000000 rgb/1000.000000.png 1000.000000 depth/1000.000000.png");
  EXPECT_EQ(read_file(folder.path() / "depth.txt", 10000),
            "# depth maps\n# timestamp filename\n"
            "1000.000000 depth/1000.000000.png\n"
            "1000.033333 depth/1000.033333.png\n"
            "1000.066667 depth/1000.066667.png\n"
            "1000.100000 depth/1000.100000.png\n");
}

std::string error_of(const fs::path& folder) {
  try {
    write_sequence(short_sequence(), folder);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(WriteSequence, RefusesAFolderWithSomethingInIt) {
  const TemporaryFolder folder;
  write_file_atomically(folder.path() / "thesis.txt", "years of work");
  EXPECT_EQ(error_of(folder.path()),
            folder.path().string() +
                ": is not empty; name a new folder for the sequence or empty this one first");
  EXPECT_FALSE(fs::exists(folder.path() / "rgb"));
}

TEST(WriteSequence, RefusesAFileAndAPlaceBelowAFile) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "file";
  write_file_atomically(file, "x");
  EXPECT_EQ(error_of(file),
            file.string() + ": is a file, expected a folder for the sequence; name another");
  EXPECT_NE(error_of(file / "below").find((file / "below").string()), std::string::npos);
}

TEST(NamedScene, KnowsWhatEachNameSays) {
  EXPECT_EQ(named_scene("empty").activity, Activity::kNone);
  EXPECT_EQ(named_scene("walking_rpy").path, PathKind::kRpy);
  EXPECT_EQ(named_scene("walking_rpy").activity, Activity::kWalking);
  EXPECT_EQ(named_scene("sitting_static").activity, Activity::kSitting);
  EXPECT_EQ(named_scene("empty").path, named_scene("walking_xyz").path);
  EXPECT_EQ(named_scene("loop").path, PathKind::kLoop);
  EXPECT_GT(static_cast<double>(named_scene("loop").frames) / 30.0, loop_period_s());
  for (const std::string& name : scene_names()) EXPECT_GE(named_scene(name).frames, 300U);
}

TEST(NamedScene, NamesTheNearestToAnUnknownOne) {
  try {
    (void)named_scene("lop");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'loop'"), std::string::npos);
  }
}

}  // namespace
}  // namespace stillmap
