// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/core.h>
#include <opencv2/core.hpp>

#include "tooling/report/box_overlay.hpp"
#include "tooling/report/display_text.hpp"
#include "tooling/report/frame_picture.hpp"
#include "tooling/report/page_sections.hpp"
#include "tooling/report/page_text.hpp"
#include "tooling/report/picture_html.hpp"

namespace stillmap {
namespace {

std::size_t count_of(const ReportSample& sample, const VerdictStyle* style) {
  const auto has_style = [style](const FeatureMark& feature) {
    return &style_of(feature) == style;
  };
  return static_cast<std::size_t>(std::ranges::count_if(sample.second.features, has_style));
}

/// In the order of legend and captions, the best first.
std::vector<const VerdictStyle*> shown_verdicts(const RunReport& report) {
  std::vector<const VerdictStyle*> shown;
  for (const VerdictStyle& style : verdict_styles()) {
    const auto has = [&](const ReportSample& sample) { return count_of(sample, &style) > 0; };
    if (std::ranges::any_of(report.samples, has)) shown.push_back(&style);
  }
  std::ranges::reverse(shown);
  return shown;
}

std::string css_color(Rgb color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
}

template <class Image>
bool any_pixel(const RunReport& report, Image FrameResult::*mask) {
  return std::ranges::any_of(report.samples, [mask](const ReportSample& sample) {
    const cv::Mat1b& pixels = (sample.second.*mask).mat;
    return !pixels.empty() && cv::countNonZero(pixels) > 0;
  });
}

std::string area_key(const char* kind, Rgb color, const char* name) {
  return fmt::format("<span class=\"item\"><span class=\"{}\" style=\"--key:{}\"></span>{}</span>",
                     kind,
                     css_color(color),
                     name);
}

std::string box_key(const char* kind, const char* name) {
  return fmt::format("<span class=\"item\"><span class=\"box {}\"></span>{}</span>", kind, name);
}

/// The marks that are drawn in any of the frames, and no others.
std::string legend_html(const RunReport& report) {
  std::string items;
  for (const VerdictStyle* const style : shown_verdicts(report)) {
    items += fmt::format(
        "<span class=\"item\"><span class=\"ring\" style=\"border-color:{}\"></span>{}</span>",
        css_color(style->color),
        style->name);
  }
  const auto any_object = [&](const auto& wanted) {
    return std::ranges::any_of(report.samples, [&](const ReportSample& sample) {
      return std::ranges::any_of(sample.second.objects, wanted);
    });
  };
  if (any_object([](const ObjectState& o) { return o.dynamic; }))
    items += box_key("dyn", "dynamic object");
  if (any_object([](const ObjectState& o) { return !o.dynamic; }))
    items += box_key("sta", "static object");
  if (any_object([](const ObjectState& o) { return o.filled; }))
    items += box_key("filled", "missed by the network, filled in");
  if (any_pixel(report, &FrameResult::network_mask))
    items += area_key("outline", MaskStyle::kNetwork, "the network's mask");
  if (any_pixel(report, &FrameResult::extended_mask))
    items += area_key("area", MaskStyle::kExtended, "extended mask");
  if (any_pixel(report, &FrameResult::depth_jumps))
    items += area_key("area", MaskStyle::kJumps, "sudden change of depth");
  return items.empty() ? "" : "<p class=\"note legend\">" + items + "</p>";
}

std::string caption(const ReportSample& sample,
                    const std::vector<const VerdictStyle*>& verdicts,
                    double start) {
  std::string text = fmt::format("{:.2f} s", sample.first.stamp.seconds - start);
  const char* separator = ": ";
  for (const VerdictStyle* const style : verdicts) {
    text += fmt::format("{}{} {}", separator, count_text(count_of(sample, style)), style->name);
    separator = ", ";
  }
  return text;
}

}  // namespace

std::string samples_html(const RunReport& report) {
  constexpr int kWidth_px = 640;
  const std::vector<const VerdictStyle*> verdicts = shown_verdicts(report);
  const double start = first_stamp_s(report);
  std::string figures;
  bool wide = false;
  for (const ReportSample& sample : report.samples) {
    const ColorImage picture = draw_frame(sample, kWidth_px);
    if (picture.mat.empty()) continue;
    const std::string boxes = box_overlay_svg(sample);
    wide = wide || !boxes.empty();
    figures += figure_html(
        picture, "Frame " + sample.first.stamp.text, caption(sample, verdicts, start), boxes);
  }
  if (figures.empty()) return "<p>No sample frames were kept.</p>";
  return fmt::format(
      "{}<div class=\"samples{}\">{}</div>", legend_html(report), wide ? " wide" : "", figures);
}

}  // namespace stillmap
