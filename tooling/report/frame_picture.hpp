// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "stillmap/core/point_cloud.hpp"
#include "tooling/report/run_report.hpp"

namespace stillmap {

/// The style in which features of one kind are drawn, with the kind's name in a legend.
struct VerdictStyle {
  FeatureVerdict verdict = FeatureVerdict::kStable;
  bool tracked = false;  ///< matched to the map; used for stable features only
  std::string_view name;
  int radius_px = 0;  ///< of a ring
  Rgb color{};
};

/// The styles of all features; later ones are drawn over earlier ones.
[[nodiscard]] std::span<const VerdictStyle> verdict_styles();

/// The style of a feature: one of verdict_styles().
[[nodiscard]] const VerdictStyle& style_of(const FeatureMark& feature);

/// Colours of the masks: the network's are outlined, the others tinted.
struct MaskStyle {
  static constexpr Rgb kNetwork = {255, 255, 255};
  static constexpr Rgb kExtended = {235, 40, 30};
  static constexpr Rgb kJumps = {255, 200, 0};
};

/// A copy of the frame's image, reduced if wider than `max_width_px`, with its masks and features
/// drawn, without its objects' boxes. Features outside the image and masks of another size are left
/// out; an empty image stays empty.
[[nodiscard]] ColorImage draw_frame(const ReportSample& sample, int max_width_px);

}  // namespace stillmap
