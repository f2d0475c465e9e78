// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/associate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// One stamp of either list, in the common order of both, linked to its unused neighbours.
struct Node {
  double seconds = 0.0;
  std::size_t index = 0;  // in its own list
  bool from_a = false;
  bool used = false;
  std::size_t previous = kNone;
  std::size_t next = kNone;
};

struct Candidate {
  double difference_s;
  std::size_t a, b;           // indices into the lists
  std::size_t first, second;  // nodes

  [[nodiscard]] bool operator>(const Candidate& other) const {
    return std::tie(difference_s, a, b) > std::tie(other.difference_s, other.a, other.b);
  }
};

bool strictly_increasing(std::span<const double> values) {
  return std::ranges::adjacent_find(values, std::not_fn(std::less<double>())) == values.end();
}

std::vector<Node> merge(std::span<const double> a, std::span<const double> b) {
  std::vector<Node> nodes;
  nodes.reserve(a.size() + b.size());
  std::size_t i = 0, j = 0;
  while (i < a.size() || j < b.size()) {
    const bool take_a = j == b.size() || (i < a.size() && a[i] <= b[j]);
    const std::size_t here = nodes.size();
    nodes.push_back({.seconds = take_a ? a[i] : b[j],
                     .index = take_a ? i : j,
                     .from_a = take_a,
                     .previous = here == 0 ? kNone : here - 1,
                     .next = here + 1 == a.size() + b.size() ? kNone : here + 1});
    ++(take_a ? i : j);
  }
  return nodes;
}

// Chooses greedily among neighbours only. That is enough: an unused stamp between the two stamps of
// the closest pair would make a closer pair.
class GreedyPairing {
 public:
  GreedyPairing(std::vector<Node> nodes, double max_difference_s)
      : nodes_(std::move(nodes)), max_difference_s_(max_difference_s) {
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) offer(i, i + 1);
  }

  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> run() {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    while (!candidates_.empty()) {
      const Candidate best = candidates_.top();
      candidates_.pop();
      if (nodes_[best.first].used || nodes_[best.second].used) continue;
      pairs.emplace_back(best.a, best.b);
      remove_neighbours(best.first, best.second);
    }
    std::ranges::sort(pairs);
    return pairs;
  }

 private:
  void offer(std::size_t first, std::size_t second) {
    const Node& m = nodes_[first];
    const Node& n = nodes_[second];
    if (m.from_a == n.from_a) return;
    const double difference_s = std::abs(m.seconds - n.seconds);
    if (!(difference_s < max_difference_s_)) return;
    const std::size_t a = m.from_a ? m.index : n.index;
    const std::size_t b = m.from_a ? n.index : m.index;
    candidates_.push({difference_s, a, b, first, second});
  }

  void remove_neighbours(std::size_t first, std::size_t second) {
    nodes_[first].used = true;
    nodes_[second].used = true;
    const std::size_t before = nodes_[first].previous;
    const std::size_t after = nodes_[second].next;
    if (before != kNone) nodes_[before].next = after;
    if (after != kNone) nodes_[after].previous = before;
    if (before != kNone && after != kNone) offer(before, after);
  }

  std::vector<Node> nodes_;
  double max_difference_s_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates_;
};

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> associate(std::span<const double> a,
                                                           std::span<const double> b,
                                                           double max_difference_s) {
  STILLMAP_CHECK(strictly_increasing(a) && strictly_increasing(b));
  return GreedyPairing(merge(a, b), max_difference_s).run();
}

}  // namespace stillmap
