// SPDX-License-Identifier: Apache-2.0
#include "simulation/synth/truth.hpp"

#include <fstream>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stillmap/core/error.hpp"
#include "stillmap/io/atomic_file.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/sensor/camera_io.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/files.hpp"
#include "tests/support/shared_data.hpp"

namespace stillmap {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

CameraModel small_camera() {
  CameraModel camera = centered_camera(8, 6, 7.25);
  camera.name = "tiny \"one\"";
  return camera;
}

TEST(FrameObjects, AreTightAroundTheirPixels) {
  ObjectMask mask(cv::Mat1b(6, 8, std::uint8_t{0}));
  mask.mat(1, 2) = mask.mat(1, 3) = mask.mat(4, 6) = 11;
  mask.mat(5, 7) = 2;
  const std::vector<ObjectSpeed> speeds = {{2, 0.5}, {10, 0.7}, {11, 0.02}};
  const std::vector<TruthFrameObject> objects = frame_objects(mask, speeds);
  ASSERT_EQ(objects.size(), 3U);
  EXPECT_EQ(objects[0].id, 2);
  EXPECT_EQ(objects[0].box, (PixelBox{7, 5, 8, 6}));
  EXPECT_EQ(objects[0].pixels, 1);
  EXPECT_TRUE(objects[0].moving);
  EXPECT_EQ(objects[1].pixels, 0);
  EXPECT_TRUE(objects[1].moving) << "also out of sight";
  EXPECT_EQ(objects[2].box, (PixelBox{2, 1, 7, 5}));
  EXPECT_EQ(objects[2].pixels, 3);
  EXPECT_FALSE(objects[2].moving) << "2 cm/s is still";
}

TEST(FrameObjects, KnowEveryIdOfTheMask) {
  ObjectMask mask(cv::Mat1b(6, 8, std::uint8_t{0}));
  mask.mat(0, 0) = 9;
  const std::vector<ObjectSpeed> speeds = {{2, 0.0}};
  EXPECT_THROW((void)frame_objects(mask, speeds), InternalError);
}

// Another program's boxes and counts of its own masks.
TEST(FrameObjects, AreThoseOfGivenSequences) {
  for (const char* name : {"twin_walking_xyz", "fr1_xyz_walkers"}) {
    STILLMAP_NEED_SHARED_DATA(name);
    const fs::path truth = shared_data(name) / "truth";
    const Json root = Json::parse(read_file(truth / "objects.json", 100000000));
    int checked = 0;
    for (const Json& frame : root.at("frames")) {
      std::vector<ObjectSpeed> speeds;
      std::map<int, Json> expected;
      for (const Json& object : frame.at("objects")) {
        const int id = object.at("id").get<int>();
        if (id >= 100) continue;
        speeds.push_back({id, object.at("speed").get<double>()});
        expected[id] = object;
      }
      const ObjectMask mask(
          read_mask(truth / "masks" / (frame.at("stamp").get<std::string>() + ".png")));
      for (const TruthFrameObject& object : frame_objects(mask, speeds)) {
        ASSERT_EQ(object.pixels, expected[object.id].at("pixels").get<int>());
        EXPECT_EQ(object.moving, expected[object.id].at("moving").get<bool>());
        if (object.pixels == 0) continue;
        ++checked;
        const PixelBox& box = object.box;
        EXPECT_EQ(Json({box.x0, box.y0, box.x1, box.y1}), expected[object.id].at("box"));
      }
    }
    EXPECT_GT(checked, 300);
  }
}

TEST(FormatObjectsJson, IsWhatTheInterfaceSays) {
  const std::vector<TruthObject> objects = {{1, "person", "person_1", true, true},
                                            {10, "chair", "chair_1", true, false}};
  std::vector<TruthFrame> frames(2);
  frames[0].stamp.text = "0.500000";
  frames[0].objects.push_back({1, {2, 3, 4, 6}, 5, true, 0.70049});
  frames[0].objects.push_back({10, {}, 0, false, 0});
  frames[1].stamp.text = "1.500000";
  const Json root = Json::parse(format_objects_json(small_camera(), objects, frames));
  EXPECT_EQ(root.at("objects"), Json::parse(R"([
    {"id":1,"class":"person","name":"person_1","movable":true,"moved":true},
    {"id":10,"class":"chair","name":"chair_1","movable":true,"moved":false}])"));
  EXPECT_EQ(root.at("frames"), Json::parse(R"([
    {"stamp":"0.500000","objects":[
      {"id":1,"box":[2,3,4,6],"pixels":5,"moving":true,"speed":0.7},
      {"id":10,"pixels":0,"moving":false,"speed":0.0}]},
    {"stamp":"1.500000","objects":[]}])"));
  EXPECT_EQ(root.size(), 3U);
}

TEST(FormatObjectsJson, GivesBackTheCamera) {
  const TemporaryFolder folder;
  CameraModel camera = small_camera();
  camera.k1 = 0.1;
  camera.p2 = -1.0 / 3.0;
  camera.readout_s = 0.02;
  camera.depth_factor = 1000;
  write_file_atomically(folder.path() / "objects.json", format_objects_json(camera, {}, {}));
  const CameraModel read = read_truth_camera(folder.path() / "objects.json");
  EXPECT_EQ(read.name, camera.name);
  EXPECT_EQ(read.width_px, 8);
  EXPECT_EQ(read.height_px, 6);
  EXPECT_EQ(read.fx, 7.25);
  EXPECT_EQ(read.cy, 2.5);
  EXPECT_EQ(read.k1, 0.1);
  EXPECT_EQ(read.p2, -1.0 / 3.0);
  EXPECT_EQ(read.readout_s, 0.02);
  EXPECT_EQ(read.depth_factor, 1000);
}

// The keys that another program wrote are there.
TEST(FormatObjectsJson, HasTheKeysOfAGivenSequence) {
  STILLMAP_NEED_SHARED_DATA("twin_walking_xyz");
  const Json given =
      Json::parse(read_file(shared_data("twin_walking_xyz/truth/objects.json"), 100000000));
  const std::vector<TruthObject> objects = {{1, "person", "person_1", true, true}};
  std::vector<TruthFrame> frames(1);
  frames[0].stamp.text = "0.5";
  frames[0].objects.push_back({1, {2, 3, 4, 6}, 5, true, 0.7});
  const Json ours = Json::parse(format_objects_json(small_camera(), objects, frames));
  const auto expect_keys = [](const Json& their, const Json& our) {
    for (const auto& [key, value] : their.items()) {
      ASSERT_TRUE(our.contains(key)) << key;
      EXPECT_EQ(our.at(key).is_number(), value.is_number()) << key;
      EXPECT_EQ(our.at(key).is_string(), value.is_string()) << key;
    }
  };
  expect_keys(given.at("camera"), ours.at("camera"));
  expect_keys(given.at("objects").at(0), ours.at("objects").at(0));
  expect_keys(given.at("frames").at(0).at("objects").at(0),
              ours.at("frames").at(0).at("objects").at(0));
  EXPECT_EQ(given.at("frames").at(0).size(), ours.at("frames").at(0).size());
}

TEST(ShareInView, CountsWhatProjectsIntoTheImage) {
  // An upright line one metre ahead: 7.25 pixels a metre, so that rows -0.5 to 5.5 are
  // y = -0.4138 to 0.4138; of 21 points from -1 to 1 those from -0.4 to 0.4 are inside.
  std::vector<Eigen::Vector3f> line;
  for (int i = -10; i <= 10; ++i) line.emplace_back(0.F, 0.1F * static_cast<float>(i), 1.F);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  EXPECT_DOUBLE_EQ(share_in_view(line, small_camera(), here), 9.0 / 21.0);
  Eigen::Isometry3d nearer = here;
  nearer.translation().z() = 2.0;  // the line is behind
  EXPECT_EQ(share_in_view(line, small_camera(), nearer), 0.0);
  nearer.translation().z() = -9.0;
  EXPECT_EQ(share_in_view(line, small_camera(), nearer), 1.0);
  EXPECT_EQ(share_in_view({}, small_camera(), here), 0.0);
}

}  // namespace
}  // namespace stillmap
