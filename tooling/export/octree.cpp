// SPDX-License-Identifier: Apache-2.0
#include "tooling/export/octree.hpp"

#include <algorithm>
#include <sstream>

#include <octomap/OcTree.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr int kOriginKey = 32768;  // key in OctoMap of the voxel that begins at 0

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

// The bytes of OcTree::writeBinary, which also prints to the terminal.
void write_binary(std::ostream& stream, octomap::OcTree& tree) {
  tree.toMaxLikelihood();
  tree.prune();
  stream << "# Octomap OcTree binary file\n"
            "# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
         << "id " << tree.getTreeType() << "\nsize " << tree.size() << "\nres "
         << tree.getResolution() << "\ndata\n";
  tree.writeBinaryData(stream);
}

void write_full(std::ostream& stream, const octomap::OcTree& tree) {
  STILLMAP_CHECK(tree.write(stream));
}

}  // namespace

std::string encode_octree(const ObservedSpace& space, OctreeFormat format) {
  octomap::OcTree tree(space.resolution_m);
  for (const SpaceVoxel& voxel : space.voxels) {
    constexpr bool kLazy = true;  // inner nodes are computed once, below
    tree.setNodeValue(key_of(voxel.index), log_odds(tree, voxel), kLazy);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  std::ostringstream stream;
  format == OctreeFormat::kBinary ? write_binary(stream, tree) : write_full(stream, tree);
  STILLMAP_CHECK(stream.good());
  return std::move(stream).str();
}

}  // namespace stillmap
