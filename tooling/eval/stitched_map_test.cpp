// SPDX-License-Identifier: Apache-2.0
// The figures of a map with known truth: a rendered sequence stitched at its true poses.
#include <array>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "stillmap/dense/voxel_grid.hpp"
#include "stillmap/io/image_io.hpp"
#include "stillmap/io/ply.hpp"
#include "stillmap/io/trajectory_io.hpp"
#include "stillmap/sensor/sequence.hpp"
#include "tests/support/shared_data.hpp"
#include "tooling/eval/map_quality.hpp"
#include "tooling/eval/pose_at.hpp"

namespace stillmap {
namespace {

class StitchedMap : public testing::Test {
 protected:
  void SetUp() override {
    STILLMAP_NEED_SHARED_DATA("twin_walking_xyz");
    folder_ = shared_data("twin_walking_xyz");
  }

  // The ids of all objects that ever moved, dilated by 2 pixels.
  [[nodiscard]] cv::Mat1b moved_pixels(const std::string& stamp) const {
    const cv::Mat1b ids = read_mask(folder_ / "truth" / "masks" / (stamp + ".png"));
    const nlohmann::json truth =
        nlohmann::json::parse(std::ifstream(folder_ / "truth" / "objects.json"));
    cv::Mat1b moved(ids.size(), std::uint8_t{0});
    for (const nlohmann::json& object : truth["objects"]) {
      if (object["moved"].get<bool>()) moved.setTo(255, ids == object["id"].get<int>());
    }
    cv::dilate(moved, moved, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
    return moved;
  }

  // Every 10th frame, 1 cm voxels, depth up to 6 m.
  [[nodiscard]] PointCloud stitch(bool without_moved) const {
    const Sequence sequence = Sequence::open(folder_, {.camera = builtin_camera("tum_fr3")});
    const Trajectory truth = read_trajectory(folder_ / "groundtruth.txt");
    const cv::Mat2f rays = pixel_rays(sequence.camera());
    VoxelGrid grid(0.01);
    for (std::uint32_t i = 0; i < sequence.size(); i += 10) {
      const FramePtr frame = sequence.read(FrameId(i));
      cv::Mat1f depth = frame->depth.mat.clone();
      if (without_moved) depth.setTo(0, moved_pixels(frame->stamp.text));
      const Eigen::Isometry3d T_world_camera = *pose_at(truth, frame->stamp.seconds);
      for (int v = 0; v < depth.rows; ++v) {
        for (int u = 0; u < depth.cols; ++u) {
          const double z = static_cast<double>(depth(v, u));
          if (z <= 0 || z > 6) continue;
          const Eigen::Vector3d p_camera(rays(v, u)[0] * z, rays(v, u)[1] * z, z);
          grid.add((T_world_camera * p_camera).cast<float>(), {});
        }
      }
    }
    return grid.extract();
  }

  [[nodiscard]] MapQuality measure(const PointCloud& map) const {
    const std::filesystem::path truth = folder_ / "truth";
    return map_quality(map,
                       {read_ply(truth / "static_map.ply"), read_ply(truth / "dynamic_map.ply")});
  }

  std::filesystem::path folder_;
};

// Another program computed the expected figures, on its own map, which has slightly less at the far
// end: hence the tolerances.
TEST_F(StitchedMap, HasTheKnownGhostsWhenNothingIsRemoved) {
  const MapQuality quality = measure(stitch(false));
  EXPECT_NEAR(quality.sa, 0.969, 0.006);
  EXPECT_NEAR(*quality.da, 0.288, 0.004);
  EXPECT_NEAR(*quality.ghosts->ratio, 0.045, 0.0005);
  EXPECT_EQ(quality.ghosts->clusters, 14U);
}

TEST_F(StitchedMap, HasNoGhostsWhenAllThatMovedIsRemoved) {
  const MapQuality quality = measure(stitch(true));
  EXPECT_NEAR(quality.sa, 0.968, 0.006);
  EXPECT_NEAR(*quality.da, 0.998, 0.001);
  EXPECT_NEAR(*quality.ghosts->ratio, 0.0, 0.00005);
  EXPECT_EQ(quality.ghosts->clusters, 0U);
}

}  // namespace
}  // namespace stillmap
