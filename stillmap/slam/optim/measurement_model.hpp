// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "stillmap/core/fields.hpp"
#include "stillmap/slam/features/features.hpp"
#include "stillmap/slam/optim/reprojection.hpp"

namespace stillmap {

struct MeasurementConfig {
  double pixel_sigma_px = 1.0;
  double inverse_depth_sigma = 0.04;
  double max_depth_m = 10.0;

  template <class Self, class Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("pixel_sigma_px",
          self.pixel_sigma_px,
          FieldInfo{"standard deviation of a feature's position at the finest pyramid level",
                    "px",
                    0.01,
                    100});
    visit("inverse_depth_sigma",
          self.inverse_depth_sigma,
          FieldInfo{"standard deviation of the inverse depth; that of the depth is this times "
                    "depth squared",
                    "1/m",
                    1e-5,
                    10});
    visit("max_depth_m",
          self.max_depth_m,
          common_setting(FieldInfo{"greatest depth used for poses", "m", 0.1, 1000}));
  }
};

/// The measurement of a feature with its standard deviations.
class MeasurementModel {
 public:
  MeasurementModel(const MeasurementConfig& config, std::vector<float> level_scales)
      : config_(config), level_scales_(std::move(level_scales)) {}

  [[nodiscard]] bool has_depth(const Features& features, std::size_t i) const {
    return features.depth_m[i] > 0 && features.depth_m[i] <= config_.max_depth_m;
  }

  /// The standard deviation of a pixel position is proportional to the pixel size of the level.
  [[nodiscard]] PointMeasurement operator()(const Features& features, std::size_t i) const {
    PointMeasurement m;
    m.px = features.px[i].cast<double>();
    const double scale = static_cast<double>(level_scales_[features.level[i]]);
    m.pixel_weight = 1.0 / (config_.pixel_sigma_px * scale);
    if (has_depth(features, i)) {
      m.inverse_depth = 1.0 / static_cast<double>(features.depth_m[i]);
      m.inverse_depth_weight = 1.0 / config_.inverse_depth_sigma;
    }
    return m;
  }

  [[nodiscard]] const std::vector<float>& level_scales() const { return level_scales_; }

 private:
  MeasurementConfig config_;
  std::vector<float> level_scales_;
};

}  // namespace stillmap
