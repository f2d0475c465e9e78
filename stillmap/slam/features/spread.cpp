// SPDX-License-Identifier: Apache-2.0
#include "stillmap/slam/features/spread.hpp"

#include <algorithm>
#include <queue>

namespace stillmap {
namespace {

// A cell of the image with its corners, a range of the array that all nodes share.
struct Node {
  float x0, y0, x1, y1;
  std::size_t begin, end;
  std::size_t number;  // in order of creation, which decides ties

  [[nodiscard]] std::size_t size() const { return end - begin; }
  [[nodiscard]] bool operator<(const Node& other) const {
    return size() != other.size() ? size() < other.size() : number > other.number;
  }
};

Node bounding_node(const std::vector<cv::KeyPoint>& corners) {
  Node node{
      corners[0].pt.x, corners[0].pt.y, corners[0].pt.x, corners[0].pt.y, 0, corners.size(), 0};
  for (const cv::KeyPoint& corner : corners) {
    node.x0 = std::min(node.x0, corner.pt.x);
    node.y0 = std::min(node.y0, corner.pt.y);
    node.x1 = std::max(node.x1, corner.pt.x);
    node.y1 = std::max(node.y1, corner.pt.y);
  }
  return node;
}

bool on_one_spot(const Node& node, const std::vector<cv::KeyPoint>& corners) {
  for (std::size_t i = node.begin + 1; i < node.end; ++i) {
    if (corners[i].pt != corners[node.begin].pt) return false;
  }
  return true;
}

// Greater than a if b is, so that a cut there always separates the two.
float middle_of(float a, float b) {
  const float middle = 0.5F * (a + b);
  return middle > a ? middle : b;
}

}  // namespace

std::vector<cv::KeyPoint> spread_evenly(std::vector<cv::KeyPoint> corners, int count) {
  if (corners.size() <= static_cast<std::size_t>(std::max(count, 0))) return corners;
  if (count <= 0) return {};

  std::priority_queue<Node> nodes;  // the fullest on top
  std::vector<Node> spots;          // nodes whose corners share one position and cannot be split
  nodes.push(bounding_node(corners));
  std::size_t made = 1;
  const auto split = [&corners](std::size_t begin, std::size_t end, auto&& goes_first) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = corners.begin() + static_cast<std::ptrdiff_t>(end);
    return static_cast<std::size_t>(std::stable_partition(first, last, goes_first) -
                                    corners.begin());
  };
  while (nodes.size() + spots.size() < static_cast<std::size_t>(count) && !nodes.empty() &&
         nodes.top().size() > 1) {
    const Node node = nodes.top();
    nodes.pop();
    if (on_one_spot(node, corners)) {
      spots.push_back(node);
      continue;
    }
    const float xm = middle_of(node.x0, node.x1), ym = middle_of(node.y0, node.y1);
    const auto is_left = [xm](const cv::KeyPoint& c) { return c.pt.x < xm; };
    const auto is_upper = [ym](const cv::KeyPoint& c) { return c.pt.y < ym; };
    const std::size_t middle = split(node.begin, node.end, is_upper);
    const std::size_t upper = split(node.begin, middle, is_left);
    const std::size_t lower = split(middle, node.end, is_left);
    for (const Node& child : {Node{node.x0, node.y0, xm, ym, node.begin, upper, made},
                              Node{xm, node.y0, node.x1, ym, upper, middle, made + 1},
                              Node{node.x0, ym, xm, node.y1, middle, lower, made + 2},
                              Node{xm, ym, node.x1, node.y1, lower, node.end, made + 3}}) {
      if (child.size() > 0) nodes.push(child);
    }
    made += 4;
  }

  std::vector<cv::KeyPoint> kept;
  kept.reserve(nodes.size() + spots.size());
  const auto keep_strongest = [&](const Node& node) {
    const auto first = corners.begin() + static_cast<std::ptrdiff_t>(node.begin);
    const auto last = corners.begin() + static_cast<std::ptrdiff_t>(node.end);
    kept.push_back(*std::max_element(
        first, last, [](const auto& a, const auto& b) { return a.response < b.response; }));
  };
  for (; !nodes.empty(); nodes.pop()) keep_strongest(nodes.top());
  for (const Node& spot : spots) keep_strongest(spot);
  return kept;
}

}  // namespace stillmap
