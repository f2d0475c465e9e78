// SPDX-License-Identifier: Apache-2.0
#include "stillmap/perception/segmentation/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/core.h>

#include "stillmap/perception/detections/box_overlap.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMostCandidates = 1000;

bool usable(const Candidate& candidate) {
  const PixelBox& box = candidate.box;
  const bool finite = std::isfinite(box.x0) && std::isfinite(box.y0) && std::isfinite(box.x1) &&
                      std::isfinite(box.y1);
  return finite && std::isfinite(candidate.score) && box.width() > 0 && box.height() > 0;
}

bool better(const Candidate& a, const Candidate& b) {
  return std::tuple(-a.score, a.source, a.label) < std::tuple(-b.score, b.source, b.label);
}

}  // namespace

bool is_no_probability(float score) {
  constexpr float kTolerance = 0.01F;
  return score < -kTolerance || score > 1 + kTolerance;
}

std::string no_probability_text(float score) {
  return fmt::format("a score of {}, expected 0 to 1: the export has to end with probabilities",
                     score);
}

std::vector<Candidate> suppress_overlaps(std::vector<Candidate> candidates, double max_overlap) {
  std::erase_if(candidates, [](const Candidate& candidate) { return !usable(candidate); });
  std::ranges::sort(candidates, better);
  if (candidates.size() > kMostCandidates) candidates.resize(kMostCandidates);
  std::vector<Candidate> kept;
  for (const Candidate& candidate : candidates) {
    const bool repeats = std::ranges::any_of(kept, [&](const Candidate& other) {
      return other.label == candidate.label && box_iou(other.box, candidate.box) > max_overlap;
    });
    if (!repeats) kept.push_back(candidate);
  }
  return kept;
}

std::vector<Candidate> to_image(std::vector<Candidate> candidates,
                                const InputPlacement& placement) {
  for (Candidate& candidate : candidates) candidate.box = placement.to_image(candidate.box);
  return candidates;
}

std::optional<PixelBox> clip_box(const PixelBox& box, cv::Size image) {
  constexpr double kLeast = 0.5;
  const double width = image.width, height = image.height;
  const PixelBox clipped{std::clamp(box.x0, 0.0, width),
                         std::clamp(box.y0, 0.0, height),
                         std::clamp(box.x1, 0.0, width),
                         std::clamp(box.y1, 0.0, height)};
  if (clipped.width() < kLeast || clipped.height() < kLeast) return std::nullopt;
  return clipped;
}

cv::Rect pixels_in(const PixelBox& box, cv::Size image) {
  const auto first_middle_after = [](double edge, int size) {
    return static_cast<int>(std::ceil(std::clamp(edge, 0.0, static_cast<double>(size)) - 0.5));
  };
  const int x0 = first_middle_after(box.x0, image.width);
  const int y0 = first_middle_after(box.y0, image.height);
  const int x1 = first_middle_after(box.x1, image.width);
  const int y1 = first_middle_after(box.y1, image.height);
  return {x0, y0, std::max(x1 - x0, 0), std::max(y1 - y0, 0)};
}

}  // namespace stillmap
