// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/box_overlay.hpp"

#include <limits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

namespace stillmap {
namespace {

using testing::HasSubstr;
using testing::Not;

ObjectState object_at(double x0, double y0, double x1, double y1) {
  ObjectState object;
  object.track = TrackId(12);
  object.class_name = "chair";
  object.reason = StateReason::kTouching;
  object.dynamic = true;
  object.box = {x0, y0, x1, y1};
  return object;
}

ReportSample frame_with(std::vector<ObjectState> objects) {
  ReportSample sample;
  sample.first.color = ColorImage(cv::Mat3b(480, 640));
  sample.second.objects = std::move(objects);
  return sample;
}

TEST(BoxOverlay, HasBoxAndLabel) {
  const std::string svg = box_overlay_svg(frame_with({object_at(100, 50, 160.5, 90)}));
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 640 480\""));
  EXPECT_THAT(svg,
              HasSubstr("<rect class=\"dyn\" x=\"100.0\" y=\"50.0\" width=\"60.5\" "
                        "height=\"40.0\"/>"));
  EXPECT_THAT(svg,
              HasSubstr("<text class=\"dyn\" x=\"102.0\" y=\"46.0\">chair #12: somebody at it<"));
}

TEST(BoxOverlay, TellsStaticAndFilledApart) {
  ObjectState object = object_at(100, 50, 160, 90);
  object.dynamic = false;
  object.filled = true;
  EXPECT_THAT(box_overlay_svg(frame_with({object})), HasSubstr("<rect class=\"sta filled\""));
}

TEST(BoxOverlay, IsCutAtTheImagesEdge) {
  const std::string svg = box_overlay_svg(frame_with({object_at(600, -20, 700, 30)}));
  EXPECT_THAT(svg, HasSubstr("x=\"600.0\" y=\"0.0\" width=\"40.0\" height=\"30.0\""));
  // 25 letters do not fit right of column 600, and there is no line above the box.
  EXPECT_THAT(svg, HasSubstr("<text class=\"dyn\" x=\"457.0\" y=\"11.0\">"));
}

TEST(BoxOverlay, LabelsDoNotCoverEachOther) {
  const ObjectState object = object_at(100, 50, 160, 90);
  const std::string svg = box_overlay_svg(frame_with({object, object}));
  EXPECT_THAT(svg, HasSubstr("y=\"46.0\">chair"));
  EXPECT_THAT(svg, HasSubstr("y=\"61.0\">chair"));
}

TEST(BoxOverlay, LeavesOutWhatIsNotInTheImage) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(box_overlay_svg(frame_with({})), "");
  EXPECT_EQ(box_overlay_svg(frame_with({object_at(700, 0, 800, 10),
                                        object_at(kNan, 0, 10, 10),
                                        object_at(0, 0, kInfinity, 10),
                                        object_at(10, 10, 5, 5),
                                        object_at(10, 10, 10, 20)})),
            "");
}

TEST(BoxOverlay, EscapesNames) {
  ObjectState object = object_at(100, 50, 160, 90);
  object.class_name = "<b>";
  const std::string svg = box_overlay_svg(frame_with({object}));
  EXPECT_THAT(svg, HasSubstr("&lt;b&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("<b>")));
}

}  // namespace
}  // namespace stillmap
