// SPDX-License-Identifier: Apache-2.0
#include "stillmap/formats/octree.hpp"

#include <algorithm>
#include <sstream>

#include <octomap/OcTree.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr int kOriginKey = 32768;  // OctoMap's key of the voxel that begins at 0

octomap::OcTreeKey key_of(const Eigen::Vector3i& index) {
  const Eigen::Vector3i key = index.array() + kOriginKey;
  STILLMAP_CHECK(key.minCoeff() >= 0 && key.maxCoeff() < 2 * kOriginKey);
  return {static_cast<octomap::key_type>(key.x()),
          static_cast<octomap::key_type>(key.y()),
          static_cast<octomap::key_type>(key.z())};
}

float log_odds(const octomap::OcTree& tree, const SpaceVoxel& voxel) {
  const float views = static_cast<float>(std::max<std::uint16_t>(voxel.views, 1));
  return voxel.occupied() ? std::min(views * tree.getProbHitLog(), tree.getClampingThresMaxLog())
                          : std::max(views * tree.getProbMissLog(), tree.getClampingThresMinLog());
}

}  // namespace

std::string encode_octree(const ObservedSpace& space, OctreeFormat format) {
  octomap::OcTree tree(space.resolution_m);
  for (const SpaceVoxel& voxel : space.voxels) {
    constexpr bool kLazy = true;  // inner nodes are worked out once, below
    tree.setNodeValue(key_of(voxel.index), log_odds(tree, voxel), kLazy);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  std::ostringstream stream;
  const bool written =
      format == OctreeFormat::kBinary ? tree.writeBinary(stream) : tree.write(stream);
  STILLMAP_CHECK(written && stream.good());
  return std::move(stream).str();
}

}  // namespace stillmap
