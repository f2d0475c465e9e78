// SPDX-License-Identifier: Apache-2.0
#include "stillmap/geometry/rigid_alignment.hpp"

#include "stillmap/core/error.hpp"

namespace stillmap {

Eigen::Isometry3d align_rigid(std::span<const Eigen::Vector3d> source,
                              std::span<const Eigen::Vector3d> target) {
  STILLMAP_CHECK(!source.empty() && source.size() == target.size());
  using Columns = Eigen::Map<const Eigen::Matrix3Xd>;
  const auto size = static_cast<Eigen::Index>(source.size());
  return Eigen::Isometry3d(Eigen::umeyama(
      Columns(source[0].data(), 3, size), Columns(target[0].data(), 3, size), false));
}

}  // namespace stillmap
