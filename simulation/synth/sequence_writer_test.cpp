// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/sequence_writer.hpp"

#include <filesystem>
#include <map>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "simulation/synth/scene_names.hpp"
#include "stillmap/geometry/se3.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/perception/detections/detections_io.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tests/support/files.hpp"

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

  const Sequence read = Sequence::open(folder.path() / "a" / "b");
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

SyntheticSequence walking_sequence(std::uint32_t seed = 9) {
  SyntheticOptions options;
  options.camera = synthetic_camera(160, 120);
  options.activity = Activity::kWalking;
  options.frames = 4;
  options.frames_per_second = 1.0;  // so that much happens in a few frames
  options.seed = seed;
  return SyntheticSequence(options);
}

TEST(WriteSequence, WritesWhoIsWhere) {
  const TemporaryFolder folder;
  const SyntheticSequence sequence = walking_sequence();
  write_sequence(sequence, folder.path());
  const fs::path truth = folder.path() / "truth";
  const nlohmann::json json = nlohmann::json::parse(read_file(truth / "objects.json", 1000000));
  ASSERT_EQ(json["frames"].size(), 4U);
  std::map<int, bool> moved;
  for (const nlohmann::json& object : json["objects"]) {
    moved[object["id"].get<int>()] = object["moved"].get<bool>();
    EXPECT_TRUE(object["movable"].get<bool>());
  }
  EXPECT_EQ(
      moved,
      (std::map<int, bool>{
          {1, true}, {2, true}, {3, true}, {10, false}, {11, false}, {12, true}, {13, true}}));
  for (std::uint32_t k = 0; k < 4; ++k) {
    const std::string stamp = sequence.stamp(FrameId(k)).text;
    EXPECT_EQ(json["frames"][k]["stamp"], stamp);
    const cv::Mat1b mask = read_mask(truth / "masks" / (stamp + ".png"));
    for (const nlohmann::json& object : json["frames"][k]["objects"]) {
      EXPECT_EQ(object["pixels"].get<int>(), cv::countNonZero(mask == object["id"].get<int>()));
    }
  }
  EXPECT_GT(read_ply(truth / "static_map.ply").size(), 5000U);
  EXPECT_GT(read_ply(truth / "dynamic_map.ply").size(), 1000U);
}

TEST(WriteSequence, WritesTheSameBytesWithAnyNumberOfThreads) {
  const TemporaryFolder one, three;
  const WriteOptions options{.threads = 1, .detections = DetectionKind::kImperfect};
  write_sequence(walking_sequence(), one.path(), options);
  write_sequence(walking_sequence(), three.path(), {3, DetectionKind::kImperfect});
  std::size_t files = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(one.path())) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const fs::path other = three.path() / fs::relative(entry.path(), one.path());
    EXPECT_EQ(read_file(entry.path(), 10000000), read_file(other, 10000000)) << other;
  }
  EXPECT_GE(files, 4U * 4U + 5U + 4U);
}

TEST(WriteSequence, MakesDetectionsOfTheTruth) {
  const TemporaryFolder perfect, imperfect;
  const SyntheticSequence sequence = walking_sequence();
  write_sequence(sequence, perfect.path(), {1, DetectionKind::kPerfect});
  write_sequence(sequence, imperfect.path(), {1, DetectionKind::kImperfect});
  const cv::Size image(160, 120);
  const auto whole = DetectionsFolder::open(perfect.path() / "detections", image);
  const auto faulty = DetectionsFolder::open(imperfect.path() / "detections", image);
  ASSERT_EQ(whole.size(), 4U);
  ASSERT_EQ(faulty.size(), 4U);
  int differ = 0;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const Stamp stamp = sequence.stamp(FrameId(k));
    const cv::Mat1b truth = read_mask(perfect.path() / "truth" / "masks" / (stamp.text + ".png"));
    const FrameDetections found = whole.at(stamp);
    for (const DetectedObject& object : found.objects) {
      EXPECT_EQ(cv::countNonZero((found.mask.mat == object.id) != (truth == object.id)), 0);
    }
    const FrameDetections network = faulty.at(stamp);
    const bool same = !network.mask.mat.empty() && !found.mask.mat.empty() &&
                      cv::countNonZero((network.mask.mat > 0) != (found.mask.mat > 0)) == 0;
    differ += same ? 0 : 1;
  }
  EXPECT_GE(differ, 3);
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
