// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/svg_plot.hpp"

#include <limits>

#include <fmt/core.h>
#include <gmock/gmock.h>

namespace stillmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(NiceTicks, HandWorked) {
  EXPECT_THAT(nice_ticks(0, 10, 5), ElementsAre(0, 2, 4, 6, 8, 10));
  EXPECT_THAT(nice_ticks(-0.9, 1.1, 4), ElementsAre(-0.5, 0, 0.5, 1));
  EXPECT_THAT(nice_ticks(1305, 1349, 4), ElementsAre(1310, 1320, 1330, 1340));
  EXPECT_EQ(nice_ticks(0, 0.3, 3).size(), 4U);  // 0.3 is the third step, whatever rounding says
}

TEST(NiceTicks, LabelsHaveTheDecimalsTheyNeed) {
  EXPECT_THAT(tick_labels({0, 0.5, 1}), ElementsAre("0.0", "0.5", "1.0"));
  EXPECT_THAT(tick_labels(nice_ticks(-0.1, 0.1, 4)),
              ElementsAre("-0.10", "-0.05", "0.00", "0.05", "0.10"));
  EXPECT_THAT(tick_labels({0, 50, 100}), ElementsAre("0", "50", "100"));
  EXPECT_THAT(tick_labels({0, 1e9}), ElementsAre("0", "1e+09"));
}

TEST(PlotScale, CornersOfTheDataAreCornersOfTheBox) {
  Plot plot;
  plot.width_px = 478;
  plot.height_px = 180;
  plot.x_label = "x";  // a box of 400 x 100 pixels at (62, 34)
  plot.y_from_zero = true;
  plot.series.push_back({.name = "a", .points = {{10, 5}, {30, 100}, {kNan, 1e6}}});
  const PlotScale scale = plot_scale(plot);
  EXPECT_NEAR(scale.to_px({10, 0}).x(), 62, 1e-9);
  EXPECT_NEAR(scale.to_px({10, 0}).y(), 134, 1e-9);
  EXPECT_NEAR(scale.to_px({30, 0}).x(), 462, 1e-9);
  EXPECT_NEAR(scale.to_px({20, 106}).x(), 262, 1e-9);
  EXPECT_NEAR(scale.to_px({20, 106}).y(), 34, 1e-9);  // 6 % of air above the largest
}

TEST(PlotScale, EqualAxesHaveEqualUnits) {
  Plot plot;
  plot.width_px = 478;
  plot.height_px = 180;
  plot.x_label = "x";
  plot.equal_axes = true;
  plot.series.push_back({.name = "a", .points = {{-1, 0}, {1, 2}}});
  const PlotScale scale = plot_scale(plot);
  const Eigen::Vector2d middle = scale.to_px({0, 1});
  EXPECT_NEAR(middle.x(), 262, 1e-9);
  EXPECT_NEAR(middle.y(), 84, 1e-9);
  const double px_per_unit = 100 / (2 * 1.12);  // the height decides
  EXPECT_NEAR(scale.to_px({1, 1}).x() - middle.x(), px_per_unit, 1e-9);
  EXPECT_NEAR(middle.y() - scale.to_px({0, 2}).y(), px_per_unit, 1e-9);
}

TEST(PlotScale, OnePointOrNoneStillHasAScale) {
  Plot plot;
  EXPECT_LT(plot_scale(plot).x.low, plot_scale(plot).x.high);
  plot.series.push_back({.name = "a", .points = {{3, -4}}});
  const PlotScale scale = plot_scale(plot);
  EXPECT_LT(scale.x.low, 3);
  EXPECT_GT(scale.x.high, 3);
  EXPECT_LT(scale.y.low, -4);
  EXPECT_GT(scale.y.high, -4);
}

TEST(PlotSvg, LinesGoThroughTheScaledPointsAndBreakWhereThereIsNone) {
  Plot plot;
  plot.width_px = 478;
  plot.height_px = 180;
  plot.x_label = "x";
  plot.y_from_zero = true;
  plot.series.push_back({.name = "a", .points = {{10, 0}, {20, 106 / 1.06}, {kNan, 0}, {30, 0}}});
  const std::string svg = plot_svg(plot);
  EXPECT_THAT(svg, HasSubstr("d=\"M62.0 134.0L262.0 39.7M462.0 134.0h0.1\""));
}

TEST(PlotSvg, DotsDashesAndTexts) {
  Plot plot;
  plot.title = "a < b";
  plot.x_label = "<x>";
  plot.series.push_back(
      {.name = "\"q\"", .points = {{0, 0}, {1, 1}}, .color = 3, .style = PlotStyle::kDots});
  plot.series.push_back({.name = "", .points = {{0, 1}, {1, 0}}, .style = PlotStyle::kDashed});
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(count(svg, "<circle class=\"dot c3\""), 3U);  // two points and the legend
  EXPECT_EQ(count(svg, "dashed"), 1U);
  EXPECT_THAT(svg, HasSubstr("a &lt; b"));
  EXPECT_THAT(svg, HasSubstr("&lt;x&gt;"));
  EXPECT_THAT(svg, HasSubstr("&quot;q&quot;"));
  EXPECT_THAT(svg, Not(HasSubstr("nothing to show")));
}

TEST(PlotSvg, WithoutPointsSaysSo) {
  Plot plot;
  plot.series.push_back({.name = "a", .points = {{kNan, 0}, {1e300, 0}}});
  EXPECT_THAT(plot_svg(plot), HasSubstr("nothing to show"));
  EXPECT_THAT(plot_svg(plot), Not(HasSubstr("nan")));
}

TEST(PlotSvg, ADenseLineIsThinnedButKeepsItsEnds) {
  Plot plot;
  plot.series.push_back({.name = "", .points = {}});
  for (int i = 0; i <= 100000; ++i) plot.series[0].points.emplace_back(i * 1e-3, 1.0);
  plot.series[0].points.emplace_back(50.0, 3.0);
  const std::string svg = plot_svg(plot);
  EXPECT_LT(svg.size(), 100000U);
  EXPECT_THAT(svg, HasSubstr(fmt::format("d=\"M{:.1f} ", plot_scale(plot).x.to_px(0))));
  EXPECT_THAT(svg,
              HasSubstr(fmt::format(
                  "L{:.1f} {:.1f}\"", plot_scale(plot).x.to_px(50), plot_scale(plot).y.to_px(3))));
}

}  // namespace
}  // namespace stillmap
