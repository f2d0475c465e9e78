// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "stillmap/concurrency/parallel.hpp"
#include "stillmap/geometry/camera.hpp"
#include "stillmap/geometry/lens.hpp"

namespace stillmap {

/// Consecutive points, which are mostly near each other.
struct PointBatch {
  static constexpr std::size_t kSize = 256;

  std::array<float, kSize> x{}, y{}, z{};
  Eigen::Vector3f center = Eigen::Vector3f::Zero();
  float radius = 0;  ///< of the ball around the centre that contains them all

  /// `points` are at most kSize.
  explicit PointBatch(std::span<const Eigen::Vector3f> points);
};

/// A batch of points as one camera sees them.
struct ProjectedBatch {
  /// Raw pixels plus a half, so that truncation rounds; far outside the image for points beyond the
  /// lens.
  std::array<float, PointBatch::kSize> u, v;
  std::array<float, PointBatch::kSize> z;  ///< depth, metres; at most kNearestDepth_m: behind
};

/// Nearer points have no pixel.
inline constexpr float kNearestDepth_m = 0.05F;

/// Projects batches into one camera.
class BatchProjector {
 public:
  BatchProjector(const CameraModel& camera, const Eigen::Isometry3d& T_camera_world);

  /// Whether certainly none of the points is in the image.
  [[nodiscard]] bool misses(const PointBatch& batch) const;

  void project(const PointBatch& batch, ProjectedBatch& out) const;

 private:
  using Lens = std::variant<BrownConradyLens<float>, FisheyeLens<float>>;

  template <class SomeLens>
  void project_with(SomeLens lens, const PointBatch& batch, ProjectedBatch& out) const;

  Eigen::Matrix<float, 3, 4> T_;
  float fx_, fy_, cx_, cy_;
  Lens lens_;
  float max_r2_;
};

/// Calls `check(view, projected batch, first point, number of points)` for each batch of points and
/// each of the views (which have a `projector`) that may see it, in the order of the views. Threads
/// take batches in turn.
template <class View, class Check>
void for_each_batch(std::span<const Eigen::Vector3f> points,
                    const std::vector<View>& views,
                    std::size_t threads,
                    const Check& check) {
  in_parallel(threads, [&](std::size_t thread) {
    ProjectedBatch projected{};
    for (std::size_t begin = thread * PointBatch::kSize; begin < points.size();
         begin += threads * PointBatch::kSize) {
      const std::size_t size = std::min(PointBatch::kSize, points.size() - begin);
      const PointBatch batch(points.subspan(begin, size));
      for (const View& view : views) {
        if (view.projector.misses(batch)) continue;
        view.projector.project(batch, projected);
        check(view, projected, begin, size);
      }
    }
  });
}

}  // namespace stillmap
