// SPDX-License-Identifier: Apache-2.0
#include "tooling/report/box_overlay.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "tooling/report/page_text.hpp"

namespace stillmap {
namespace {

constexpr double kTextHeight = 15;    // of a line, for an image 640 pixels wide
constexpr double kLetterWidth = 7.4;  // on average, so that labels stay inside the image

struct Label {
  std::string text;
  double x = 0, y = 0;  // its lower left corner
};

std::optional<Eigen::AlignedBox2d> part_in_image(const PixelBox& px, const cv::Mat& image) {
  const Eigen::AlignedBox2d box(Eigen::Vector2d(px.x0, px.y0), Eigen::Vector2d(px.x1, px.y1));
  if (!box.min().allFinite() || !box.max().allFinite()) return std::nullopt;
  const Eigen::AlignedBox2d all(Eigen::Vector2d::Zero(), Eigen::Vector2d(image.cols, image.rows));
  const Eigen::AlignedBox2d part = box.intersection(all);
  if (part.isEmpty() || part.volume() <= 0) return std::nullopt;
  return part;
}

/// Places the label above the box if there is room, else inside; never on another label.
Label place_label(std::string text,
                  const Eigen::AlignedBox2d& box,
                  double unit,
                  const std::vector<Label>& others,
                  const cv::Mat& image) {
  Label label{std::move(text), 0, 0};
  const double width = static_cast<double>(label.text.size()) * kLetterWidth * unit;
  const double line = kTextHeight * unit;
  label.x = std::max(0.0, std::min(box.min().x(), image.cols - width));
  label.y = box.min().y() >= line ? box.min().y() : box.min().y() + line;
  const auto covered = [&](const Label& other) {
    const double other_width = static_cast<double>(other.text.size()) * kLetterWidth * unit;
    return std::abs(other.y - label.y) < line && label.x < other.x + other_width &&
           other.x < label.x + width;
  };
  while (std::ranges::any_of(others, covered) && label.y + line < image.rows) label.y += line;
  return label;
}

}  // namespace

std::string box_overlay_svg(const ReportSample& sample) {
  const cv::Mat& image = sample.first.color.mat;
  const double unit = image.cols / 640.0;
  std::string boxes, texts;
  std::vector<Label> labels;
  for (const ObjectState& object : sample.second.objects) {
    const std::optional<Eigen::AlignedBox2d> box = part_in_image(object.box, image);
    if (!box) continue;
    const char* const kind = object.dynamic ? "dyn" : "sta";
    boxes += fmt::format(
        "<rect class=\"{}{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
        kind,
        object.filled ? " filled" : "",
        box->min().x(),
        box->min().y(),
        box->sizes().x(),
        box->sizes().y());
    std::string text = fmt::format(
        "{} #{}: {}", object.class_name, object.track.value, reason_name(object.reason));
    labels.push_back(place_label(std::move(text), *box, unit, labels, image));
    texts += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>",
                         kind,
                         labels.back().x + 2 * unit,
                         labels.back().y - 4 * unit,
                         html_escape(labels.back().text));
  }
  if (boxes.empty()) return {};
  return fmt::format(
      "<svg class=\"boxes\" viewBox=\"0 0 {} {}\" font-size=\"{:.1f}\" aria-hidden=\"true\">{}{}"
      "</svg>",
      image.cols,
      image.rows,
      12 * unit,
      boxes,
      texts);
}

}  // namespace stillmap
